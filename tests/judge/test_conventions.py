"""Conventions: each way of spoiling a sound file is found, named, and mended only when asked."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from builders.integrators import engine, explicit
from builders.scenes import scene_text
from builders.trajectories import (
    MATRIX,
    QUATERNION,
    VECTORS,
    Columns,
    Sound,
    columns_at,
    conjugate,
    exact_columns,
    file_judgement,
    in_space_axes,
    quaternion,
    replaced,
    rows_of,
    scalar_last,
    write_csv,
)
from builders.turns import by_turns
from mpmath import mp, mpf

from taylor_verify.judge.conventions.axis_orders import AXES, Frames
from taylor_verify.judge.conventions.convention_search import conventions
from taylor_verify.judge.conventions.fits import EXPLAINS, Conventions
from taylor_verify.judge.conventions.meanings import readings, rotations
from taylor_verify.judge.conventions.worlds import worlds
from taylor_verify.judge.files import judgement as judging
from taylor_verify.judge.files.coverage import Extent
from taylor_verify.judge.files.judgement import FileJudgement
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import rung
from taylor_verify.records.status import Status
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.files.file import read

OMEGA = VECTORS["omega"]


def judged(path: Path, scene: str, columns: Sound, accept: bool = False) -> FileJudgement:
    return file_judgement(write_csv(path / "mine.csv", columns), scene, accept_conventions=accept)


def searched(path: Path, scene: str, columns: Sound) -> Conventions:
    """The conventions of a file that is not judged."""
    return conventions(read(write_csv(path / "mine.csv", columns)), load(scene), rung("f64"))


def statuses(judgement: FileJudgement) -> set[Status]:
    return {verdict.verdict for verdict in judgement.verdicts}


# The ways to spoil a file. Each takes sound columns and returns spoiled ones.


def scalar_last_and_conjugate(sound: Sound) -> Columns:
    return scalar_last(conjugate(sound))


def transposed(sound: Sound) -> Columns:
    R = rows_of(sound, MATRIX).reshape(-1, 3, 3)
    return replaced(sound, MATRIX, R.transpose(0, 2, 1).reshape(-1, 9))


def in_degrees(sound: Sound) -> Columns:
    return replaced(sound, OMEGA, np.degrees(rows_of(sound, OMEGA)))


def in_milliseconds(sound: Sound) -> Columns:
    return {**{k: list(v) for k, v in sound.items()}, "t": [1000 * t for t in sound["t"]]}


def late(sound: Sound) -> Columns:
    return {**{k: list(v) for k, v in sound.items()}, "t": [t + 5e-4 for t in sound["t"]]}


def of_another_epoch(sound: Sound) -> Columns:
    return {**{k: list(v) for k, v in sound.items()}, "t": [t + 1024 for t in sound["t"]]}


def permuted(sound: Sound) -> Columns:
    """The body's axes in another order, for omega and the attitude alike."""
    R = rotations(rows_of(sound, QUATERNION))[:, :, [1, 2, 0]]
    turned = replaced(sound, OMEGA, rows_of(sound, OMEGA)[:, [1, 2, 0]])
    return replaced(turned, QUATERNION, [quaternion(r) for r in R])


@pytest.mark.parametrize(
    ("spoil", "subject", "words"),
    # Units, axes and other orders are told from the first rows of an engine, and mended together, below.
    by_turns(
        [
            (scalar_last, "quaternion", "the quaternion is scalar last"),
            (conjugate, "quaternion", "are the conjugate"),
            (scalar_last_and_conjugate, "quaternion", "scalar last; q0 q1 q2 q3 are the conjugate"),
            (transposed, "attitude", "are transposed"),
            (in_degrees, "omega", "in degrees"),
            (in_space_axes, "omega", "in space axes"),
            (in_milliseconds, "time", "thousandths"),
            (late, "time", "late by 0.0005"),
            (of_another_epoch, "time", "late by 1024"),
            (
                permuted,
                "axes",
                "the body has other axes: axis 1 is the file's 3, axis 2 is the file's 1",
            ),
        ],
        10,
        lambda spoil, subject, words: subject in ("attitude", "time") and subject,
    ),
)
@pytest.mark.usefixtures("without_causes")
def test_each_convention_is_found_and_mended(
    spoil: Callable[[Sound], Columns], subject: str, words: str, tmp_path: Path
) -> None:
    """A spoiled file has one finding that names the convention; accepted, it passes."""
    scene = "euler/with-attitude"
    spoiled = spoil(exact_columns(scene, matrix=spoil is transposed))
    judgement = judged(tmp_path, scene, spoiled, accept=True)
    (finding,) = judgement.conventions
    assert finding.subject == subject
    assert words in finding.words
    assert finding.is_certain
    assert finding.after <= EXPLAINS * finding.before
    assert statuses(judgement) == {Status.PASS}
    (entry,) = judgement.document()["conventions"]
    assert entry["corrected"] is True


@pytest.mark.usefixtures("without_causes")
def test_conventions_are_found_together(tmp_path: Path) -> None:
    """A late file with degrees and a scalar at the end has three findings, all mended when asked."""
    scene = "euler/with-attitude"
    spoiled = late(in_degrees(scalar_last(exact_columns(scene))))
    judgement = judged(tmp_path, scene, spoiled, accept=True)
    assert [finding.subject for finding in judgement.conventions] == ["time", "omega", "quaternion"]
    assert statuses(judgement) == {Status.PASS}


@pytest.mark.usefixtures("without_causes")
def test_impulses_have_conventions_too(tmp_path: Path) -> None:
    """The axes of the body and the unit of Omega are found in a file of a solid in a fluid."""
    scene = "kirchhoff/whole-motion"
    sound = exact_columns(scene)
    spoiled = permuted(in_degrees(sound))
    for names in (VECTORS["linear_impulse"], VECTORS["angular_impulse"]):
        spoiled = replaced(spoiled, names, rows_of(sound, names)[:, [1, 2, 0]])
    judgement = judged(tmp_path, scene, spoiled, accept=True)
    assert [finding.subject for finding in judgement.conventions] == ["axes", "omega"]
    assert statuses(judgement) == {Status.PASS}


@pytest.mark.usefixtures("without_causes")
def test_products_of_inertia_with_the_other_sign_are_seen(tmp_path: Path) -> None:
    """A body with +int xy dm for its products is named, and judged as that body when accepted."""
    scene = load("euler/full-tensor")
    K = scene.body.inertia
    turned = tuple(tuple(K[i][k] * (1 if i == k else -1) for k in range(3)) for i in range(3))
    other = replace(scene, body=RigidBody(turned))
    spoiled = columns_at(other, [*scene.clock.instants[:-1:4], scene.clock.instants[-1]])
    judgement = judged(tmp_path, scene.name, spoiled, accept=True)
    (finding,) = judgement.conventions
    assert (finding.subject, finding.is_certain) == ("body", True)
    assert "products of inertia" in finding.words
    assert statuses(judgement) == {Status.PASS}


@pytest.mark.slow
def test_transposed_coupling_is_seen(tmp_path: Path) -> None:
    """A coupling whose rows go with y is named."""
    scene = load("kirchhoff/general-body")
    body = replace(scene.body, coupling=tensors.transpose(scene.body.coupling))
    spoiled = columns_at(replace(scene, body=body), scene.clock.instants[:20])
    del spoiled["w1"], spoiled["w2"], spoiled["w3"]
    (finding,) = searched(tmp_path, scene.name, spoiled).findings
    assert finding.subject == "body"
    assert "coupling B transposed" in finding.words


def test_a_right_file_is_searched_for_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Conventions and causes are searched for where a row fails, and nowhere else."""
    scene = "euler/with-attitude"
    for search in ("conventions", "causes_of_file"):
        monkeypatch.setattr(judging, search, lambda *_: pytest.fail("it was searched"))
    assert statuses(judged(tmp_path, scene, exact_columns(scene))) == {Status.PASS}
    with pytest.raises(pytest.fail.Exception, match="it was searched"):
        judged(tmp_path, scene, scalar_last(exact_columns(scene)))


@pytest.mark.parametrize("accept", [False, True])
def test_what_the_motion_cannot_tell_is_ambiguous_and_never_guessed(
    accept: bool, tmp_path: Path
) -> None:
    """Columns of one size have other signs: nobody can say which of them is which axis."""
    scene = tmp_path / "equal.toml"
    equal = ("inertia = [2, 2, 2]", "omega = [0.5, 0.5, 0.5]")
    scene.write_text(scene_text(*equal, time="end = 10\nsamples = 11"))
    spoiled = {
        "t": list(range(11)),
        **{n: [v] * 11 for n, v in zip(OMEGA, (-0.5, -0.5, 0.5), strict=True)},
    }
    judgement = judged(tmp_path, str(scene), spoiled, accept)
    (finding,) = judgement.conventions
    assert not finding.is_certain
    assert "ambiguous" in finding.sentence
    assert Status.FAIL in statuses(judgement)


def test_sound_file_has_no_conventions(tmp_path: Path) -> None:
    """A file that is right has no conventions, however symmetric its motion."""
    for scene in ("euler/spherical", "euler/axisymmetric", "euler/with-attitude"):
        assert judged(tmp_path, scene, exact_columns(scene)).conventions == ()


def test_an_error_of_ones_own_is_no_convention(tmp_path: Path) -> None:
    """A file that is wrong by a slow growth and a noise of 1e-6 is not explained away."""
    scene = "euler/with-attitude"
    sound = exact_columns(scene)
    noise = 1 + 1e-6 * np.random.default_rng(7).standard_normal((len(sound["t"]), 3))
    spoiled = replaced(sound, OMEGA, rows_of(sound, OMEGA) * noise)
    judgement = judged(tmp_path, scene, spoiled)
    assert judgement.conventions == ()
    assert Status.FAIL in statuses(judgement)


def test_poor_answers_show_their_conventions(tmp_path: Path) -> None:
    """Conventions are found in an answer that is good to three digits only."""
    scene = "euler/with-attitude"
    sound = exact_columns(scene)
    poor = replaced(
        sound, QUATERNION, rows_of(sound, QUATERNION) + 1e-3 * np.sin(sound["t"])[:, None]
    )
    (finding,) = searched(tmp_path, scene, scalar_last(poor)).findings
    assert "scalar last" in finding.words


# What is no convention.


@pytest.mark.usefixtures("without_causes")
def test_one_reflected_component_is_an_error(tmp_path: Path) -> None:
    """A sign of one component of omega is no change of axes: the attitude in the file is right."""
    sound = exact_columns("euler/with-attitude")
    spoiled = replaced(sound, OMEGA, rows_of(sound, OMEGA) * [1, -1, 1])
    judgement = judged(tmp_path, "euler/with-attitude", spoiled, accept=True)
    assert judgement.conventions == ()
    assert Status.FAIL in statuses(judgement)
    # Nor is it one where omega is all that the file has.
    alone = {name: spoiled[name] for name in ("t", *OMEGA)}
    assert searched(tmp_path, "euler/with-attitude", alone).findings == ()


def test_axes_of_omega_alone_are_no_convention_beside_an_attitude(tmp_path: Path) -> None:
    """A permutation of omega must be one of the attitude's body axes too; alone in a file it may stand."""
    sound = exact_columns("euler/with-attitude")
    spoiled = replaced(sound, OMEGA, rows_of(sound, OMEGA)[:, [1, 2, 0]])
    assert searched(tmp_path, "euler/with-attitude", spoiled).findings == ()
    alone = {name: spoiled[name] for name in ("t", *OMEGA)}
    (finding,) = searched(tmp_path, "euler/with-attitude", alone).findings
    assert finding.subject == "axes"
    assert finding.words.endswith("other axes: axis 1 is w3, axis 2 is w1, axis 3 is w2")


SYMMETRIC = scene_text(
    *("inertia = [1.3, 1.3, 0.7]", "omega = [0.5, 0.2, 1.5]\nattitude = [1, 2, -1, 3]"),
    time="end = 20\nsamples = 21",
    top='track = ["attitude"]',
)


@pytest.mark.parametrize(
    ("with_attitude", "angle"), by_turns([(False, 0.3), (False, -0.3), (True, 0.3), (True, -0.3)])
)
def test_a_turned_start_is_no_late_clock(with_attitude: bool, angle: float, tmp_path: Path) -> None:
    """A symmetric body that starts turned about its axis looks late; its initial state fails."""
    name = tmp_path / "symmetric.toml"
    name.write_text(SYMMETRIC)
    scene = load(str(name))
    c, s = np.cos(angle), np.sin(angle)
    w1, w2, w3 = map(float, scene.initial.omega)
    turned = tuple(Fraction(v) for v in (float(c * w1 - s * w2), float(s * w1 + c * w2), w3))
    initial = replace(scene.initial, omega=turned)
    columns = columns_at(replace(scene, initial=initial), scene.clock.instants)
    if not with_attitude:
        columns = {n: columns[n] for n in ("t", *OMEGA)}
    judgement = judged(tmp_path, str(name), columns, accept=True)
    assert judgement.conventions == ()
    first = judgement.verdicts[0]
    assert (first.quantity, first.verdict) == ("initial state", Status.FAIL)


def test_a_body_that_stands_still_has_no_unit_of_time(tmp_path: Path) -> None:
    """A constant omega is not counted in nanoseconds, in which the truth does not move either."""
    sound = exact_columns("euler/with-attitude")
    still = replaced(sound, OMEGA, [rows_of(sound, OMEGA)[0]] * len(sound["t"]))
    for columns in (still, {n: still[n] for n in ("t", *OMEGA)}):
        assert searched(tmp_path, "euler/with-attitude", columns).findings == ()


# Honest files of first-order engines, whose later rows are off by far more than a hundredth.


def identical(columns: Columns) -> Columns:
    return columns


def all_at_once(columns: Columns) -> Columns:
    return scalar_last(in_degrees(in_space_axes(columns)))


SPOILT: list[tuple[Callable[[Sound], Columns], list[str]]] = [
    (identical, []),
    (scalar_last, ["quaternion"]),
    (conjugate, ["quaternion"]),
    (in_space_axes, ["omega"]),
    (in_degrees, ["omega"]),
    (permuted, ["axes"]),
    (all_at_once, ["omega", "quaternion"]),
]


# A start in line with the axes of space shows space axes only after a while.
@pytest.mark.parametrize(
    ("scene", "rows", "spoil", "subjects"),
    [
        *[("euler/with-attitude", 5, *spoilt) for spoilt in SPOILT],
        *by_turns([("euler/nesc-brick", 1001, *spoilt) for spoilt in SPOILT[::-1]], len(SPOILT)),
    ],
)
def test_the_first_rows_of_an_engine_decide(
    scene: str, rows: int, spoil: Callable[[Sound], Columns], subjects: list[str], tmp_path: Path
) -> None:
    """Five rows of semi-implicit Euler at h = 0.01 suffice, and a long file hides nothing."""
    findings = searched(tmp_path, scene, spoil(first_order(scene, rows))).findings
    assert [finding.subject for finding in findings] == subjects
    assert all(finding.is_certain for finding in findings)


@cache
def first_order(scene: str, rows: int) -> Columns:
    return engine(scene, explicit, 0.01, rows)


# Readings.


def test_renamed_quaternions_are_those_of_the_renamed_matrices() -> None:
    """A quaternion under other axes is that of Q R P^T, and keeps its length."""
    q = 0.5 * np.array([[0.3, -0.5, 0.7, 0.2]])
    for frames in (f for a in AXES for f in (Frames(body=a), Frames(space=a), Frames(a, a))):
        turned = frames.quaternions(q)
        assert np.allclose(rotations(turned), frames.attitudes(rotations(q)), atol=1e-15)
        assert np.linalg.norm(turned) == pytest.approx(np.linalg.norm(q), rel=1e-15)


@pytest.mark.parametrize("group", ["omega", "quaternion", "attitude", "centre", "linear_impulse"])
def test_readings_agree_in_floats_and_in_mpf(group: str) -> None:
    """A reading that is tried in float64 is the one that is corrected in exact numbers."""
    width = {"quaternion": 4, "attitude": 9}.get(group, 3)
    rows = np.random.default_rng(1).standard_normal((2, width))
    R = rotations(np.random.default_rng(2).standard_normal((2, 4)))
    with mp.workdps(30):
        exact_rows, frames = (np.vectorize(mpf, otypes=[object])(a) for a in (rows, R))
        renamed = Frames(AXES[5], AXES[17])
        for reading in (*readings(group), *readings(group, renamed)):
            exact = reading.read(exact_rows, frames).astype(float)
            assert np.allclose(reading.read(rows, R), exact, rtol=1e-13, atol=1e-13)


@pytest.mark.usefixtures("without_causes")
def test_shift_is_the_shortest_decimal_that_explains(tmp_path: Path) -> None:
    """A shift of 1/8192 is found to the last digit, so that the corrected file passes."""
    scene = load("euler/with-attitude")
    instants = [t + Fraction(1, 8192) for t in scene.clock.instants[::4]]
    sound = exact_columns(scene.name)
    spoiled = {**sound, "t": [float(t) for t in instants]}
    judgement = judged(tmp_path, scene.name, spoiled, accept=True)
    (finding,) = judgement.conventions
    assert finding.words == "t is late by 0.0001220703125"
    assert statuses(judgement) == {Status.PASS}


# Shifts and units, part by part.


@pytest.mark.parametrize("order", [1, -1])
@pytest.mark.parametrize(("instants", "rows"), [((5, 6, 7), (7, 8, 9)), ((5, 3, 1), (7, 6, 4))])
def test_a_file_is_late_against_the_start_of_its_scene(
    instants: tuple[int, ...], rows: tuple[int, ...], order: int
) -> None:
    """A row at 7 is late by 2 where the scene starts at 5, forwards or back, first or last in the file."""
    plain = load("euler/generic")
    scene = replace(plain, clock=Clock(Fraction(5), tuple(map(Fraction, instants))))
    words = [world.words for world in worlds(scene, tuple(map(Fraction, rows[::order])))]
    assert "t is late by 2" in words


def test_the_slack_of_a_clock_grows_with_its_start() -> None:
    """A late clock is rounded as its own size is."""
    slacks = []
    for start in map(Fraction, (0, 990)):
        times = tuple(start + k for k in range(11))
        scene = replace(load("euler/generic"), clock=Clock(start, times))
        slacks.append(Extent.of(scene, times, rung("f64")).slack)
    assert slacks[1] == 100 * slacks[0] > 0


@pytest.mark.parametrize("number", [float, mpf])
def test_units_of_angular_velocity(number: Any) -> None:
    """A turn is 2 pi, a degree its 360th part; a turn in a minute is a 60th of it in a second."""
    parts = {
        "": 1 / (2 * np.pi),
        "in degrees per unit of time": 1 / 360,
        "in turns per unit of time": 1,
        "in turns per minute, the unit of time being the second": 1 / 60,
    }
    rows, R = np.array([[number(0), number(3), number(0)]]), np.eye(3)[None]
    other = ("space", "rates")
    plain = [r for r in readings("omega") if not any(word in "".join(r.words) for word in other)]
    assert len(plain) == len(parts)
    for reading, (unit, part) in zip(plain, parts.items(), strict=True):
        assert "".join(reading.words) == f"w1 w2 w3 are {unit}" * bool(unit)
        assert float(reading.read(rows, R)[0, 1]) == pytest.approx(3 * 2 * np.pi * part)


def test_units_of_time_are_as_long_as_their_names() -> None:
    """A file may count time in any of these units, for a scene in seconds."""
    scene = load("euler/generic")
    lengths = {
        world.time_words[0].partition("(")[2].partition(" for")[0]: world.scale
        for world in worlds(scene, scene.clock.instants)
        if world.scale != 1 and not world.shift
    }
    names = ("milli", "micro", "nano")
    parts = {f"{name}seconds": Fraction(1, 1000**k) for k, name in enumerate(names, 1)}
    assert lengths == parts | {"minutes": 60, "hours": 3600, "days": 86400}
