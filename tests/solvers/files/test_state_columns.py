"""Columns of velocities of a solid in a fluid, which stand for its impulses, and of states of a scene."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from builders.scenes import acted
from builders.trajectories import (
    Columns,
    columns_at,
    exact_columns,
    file_judgement,
    named,
    rows_of,
    write_csv,
)
from builders.turns import by_turns
from builders.verdicts import by_quantity
from mpmath import mp

from taylor_verify.cli import main
from taylor_verify.exact.route import solution
from taylor_verify.judge.conventions.meanings import rotations
from taylor_verify.judge.files.judgement import FileJudgement
from taylor_verify.judge.judgement import judgement
from taylor_verify.judge.velocities import momenta, velocities
from taylor_verify.models.problem import adopt
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import rung
from taylor_verify.records.faults import Refused
from taylor_verify.records.quantities import COMPLETE, INITIAL
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Clock, Impulse
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.file import Recorded, read
from taylor_verify.solvers.files.objects import trajectory

SCENE = "kirchhoff/whole-motion"
VELOCITY = ("u1", "u2", "u3")
F64 = rung("f64")


def velocity_columns(scene: Scene, instants: Sequence[Fraction]) -> Columns:
    """The exact motion in doubles, its velocities in place of its impulses."""
    columns = columns_at(scene, instants)
    given = adopt(scene, F64, tuple(map(Fraction, columns["t"]))).given
    with mp.workdps(40):
        motion = solution(given).evaluate(given.clock.elapsed, 40)
        U = velocities(given.body, motion)["linear_velocity"]
    others = {name: values for name, values in columns.items() if name[0] not in "xy"}
    return {**others, **named(VELOCITY, U)}


@cache
def sound(name: str = SCENE) -> Mapping[str, Sequence[float]]:
    scene = load(name)
    return velocity_columns(scene, [*scene.clock.instants[:-1:4], scene.clock.instants[-1]])


def judged(
    path: Path, columns: Mapping[str, Any], scene: str = SCENE, **options: Any
) -> FileJudgement:
    return file_judgement(write_csv(path / "mine.csv", columns, str), scene, **options)


def only(columns: Mapping[str, Sequence[float]], *names: str) -> Columns:
    return {name: list(columns[name]) for name in ("t", *names)}


@pytest.mark.slow
@pytest.mark.parametrize("scene", [SCENE, "kirchhoff/remus-100", "kirchhoff/swimmer-vehicle"])
def test_velocities_stand_for_the_impulses(scene: str, tmp_path: Path) -> None:
    """Everything that impulses determine has its row, nothing is missing, and all of it passes."""
    judgement = judged(tmp_path, sound(scene), scene)
    by_impulses = judged(tmp_path, exact_columns(scene), scene)
    assert set(by_quantity(judgement)) == set(by_quantity(by_impulses)) | {"velocity"}
    assert {v.verdict for v in judgement.verdicts} == {Status.PASS}
    assert judgement.conventions == ()
    assert "its place, because the file has velocities" in by_quantity(judgement)["impulse"].because


def test_impulses_are_made_exactly() -> None:
    """(x, y) = M (U, Omega) with the inverse of the scene's own matrix gives the impulses back."""
    scene = load("kirchhoff/swimmer-vehicle")
    body, start = scene.body, scene.initial
    with mp.workdps(60):
        state = {
            "linear_impulse": np.array([[mp.convert(v) for v in start.linear]], dtype=object),
            "angular_impulse": np.array([[mp.convert(v) for v in start.angular]], dtype=object),
        }
        back = momenta(body, velocities(body, state))
        for name, values in state.items():
            assert max(abs(e) for e in (back[name] - values).flat) < mp.mpf(10) ** -55


def test_either_velocity_alone_is_judged_as_itself(tmp_path: Path) -> None:
    """u1 u2 u3 alone have the row velocity, and the impulses are not judged."""
    judgement = judged(tmp_path, only(sound(), *VELOCITY))
    assert set(by_quantity(judgement)) == {INITIAL, "velocity", COMPLETE}
    assert by_quantity(judgement)["velocity"].verdict is Status.PASS
    assert "linear impulse" in by_quantity(judgement)[COMPLETE].because
    spoiled = only(sound(), *VELOCITY)
    spoiled["u2"][3] *= 1 + 1e-10
    velocity = by_quantity(judged(tmp_path, spoiled))["velocity"]
    assert (velocity.verdict, velocity.at) == (Status.FAIL, spoiled["t"][3])
    late = {**only(sound(), *VELOCITY), "t": [t + 2**-11 for t in sound()["t"]]}
    assert by_quantity(judged(tmp_path, late))["velocity"].time_shift == pytest.approx(
        2**-11, rel=1e-6
    )


def test_impulses_of_the_file_come_before_its_velocities(tmp_path: Path) -> None:
    """Wrong velocities beside sound impulses fail their own row alone."""
    columns = {**exact_columns(SCENE), **{n: [2 * v for v in sound()[n]] for n in VELOCITY}}
    judgements = {
        quantity: verdict.verdict
        for quantity, verdict in by_quantity(judged(tmp_path, columns)).items()
    }
    assert judgements.pop("velocity") is Status.FAIL
    assert judgements.pop(INITIAL) is Status.FAIL
    assert set(judgements.values()) == {Status.PASS}


def swapped(columns: Mapping[str, Sequence[float]]) -> dict[str, Any]:
    return {**columns, "u1": columns["u2"], "u2": columns["u1"]}


def of_the_sign(columns: Mapping[str, Sequence[float]]) -> dict[str, Any]:
    return {**columns, "u3": [-v for v in columns["u3"]]}


def in_millimetres(columns: Mapping[str, Sequence[float]]) -> dict[str, Any]:
    return {(f"{n} [mm/s]" if n in VELOCITY else n): v for n, v in columns.items()}


@pytest.mark.parametrize("spoil", by_turns([swapped, of_the_sign, in_millimetres]))
def test_wrong_velocities_are_caught(spoil: Any, tmp_path: Path) -> None:
    """Two components exchanged, a sign, a unit that is not theirs: impulse and velocity fail."""
    verdicts = by_quantity(judged(tmp_path, spoil(sound())))
    for quantity in ("impulse", "velocity"):
        assert verdicts[quantity].verdict is Status.FAIL
    assert verdicts["omega"].verdict is Status.PASS


def test_velocities_in_space_axes_are_a_convention(tmp_path: Path) -> None:
    """U in space axes is found out, and with its correction the impulses pass."""
    R = rotations(rows_of(sound(), ("q0", "q1", "q2", "q3")))
    turned = (R @ rows_of(sound(), VELOCITY)[:, :, None])[:, :, 0]
    columns = {**sound(), **named(VELOCITY, turned)}
    judgement = judged(tmp_path, columns)
    assert ["u1 u2 u3 are in space axes"] == [finding.words for finding in judgement.conventions]
    assert by_quantity(judgement)["impulse"].verdict is Status.FAIL
    mended = judged(tmp_path, columns, accept_conventions=True)
    assert by_quantity(mended)["velocity"].max < 1e-14  # type: ignore[operator]
    assert by_quantity(mended)["impulse"].max < 1e-14  # type: ignore[operator]


def test_a_rigid_body_has_no_velocity_of_its_origin(tmp_path: Path) -> None:
    """u1 u2 u3 beside w1 w2 w3 of Euler's equations are left out and named; alone they are refused."""
    columns = exact_columns("euler/generic")
    rest = {name: [1.0] * len(columns["t"]) for name in VELOCITY}
    judgement = judged(tmp_path, {**columns, **rest}, "euler/generic")
    assert {v.verdict for v in judgement.verdicts} == {Status.PASS}
    note = "u1 u2 u3 not compared: euler/generic is of model euler, whose motion has no linear velocity"
    assert note in judgement.notes
    file = write_csv(tmp_path / "mine.csv", {"t": columns["t"], **rest})
    assert main(["check", file, "--scene", "euler/generic"]) == 2


# A rounding of velocities.


def far_from_its_origin(offset: int) -> Scene:
    """A body whose mass lies far from the origin: U is the difference of large terms, and so is x."""
    r = (Fraction(0), Fraction(offset), Fraction(0))
    cross = ((Fraction(0), -r[2], r[1]), (r[2], Fraction(0), -r[0]), (-r[1], r[0], Fraction(0)))
    turned = tensors.transpose(cross)
    inertia = tensors.diagonal((Fraction(2), Fraction(3), Fraction(4)))
    masses = tensors.diagonal((Fraction(1), Fraction(2), Fraction(3)))
    coupled = tensors.product(masses, turned)
    whole = tensors.product(cross, coupled)
    about = tuple(
        tuple(a + b for a, b in zip(row, other, strict=True))
        for row, other in zip(inertia, whole, strict=True)
    )
    body = ImmersedBody.of_mass_matrix(tensors.blocks(masses, coupled, about))
    plain = load("kirchhoff/steady-screw")
    linear = (Fraction(1), Fraction(1, 2), Fraction(1, 4))
    start = Impulse(linear, (Fraction(1, 3), Fraction(1), Fraction(2)))
    clock = Clock(Fraction(0), tuple(Fraction(k, 20) for k in range(5)))
    return replace(plain, body=body, initial=start, clock=clock, track=frozenset())


@pytest.mark.slow
def test_rounding_of_velocities_is_carried_through_the_inertia_matrix() -> None:
    """Doubles of V pass by the floor of velocities, and not by that of x, y, if terms of M V cancel."""
    scene = far_from_its_origin(1000)
    problem = adopt(scene, F64, scene.clock.instants)
    body = scene.body
    with mp.workdps(60):
        motion = solution(problem.given).evaluate(problem.given.clock.elapsed, 40)
        exact = velocities(body, motion)
        # Each velocity as a double: what a file holds.
        stored = {
            name: np.array([[mp.mpf(float(v)) for v in row] for row in values], dtype=object)
            for name, values in exact.items()
        }
        made = momenta(body, stored)

    def verdicts_on(impulses: Mapping[str, Any], carries: bool) -> dict[str, Verdict]:
        answer = Recorded(impulses, carries_velocities=carries)
        return by_quantity(judgement(problem, answer, answer.solve(problem)))

    verdicts = {carries: verdicts_on(made, carries) for carries in (False, True)}
    assert verdicts[True]["impulse"].verdict is Status.PASS
    assert verdicts[False]["impulse"].verdict is Status.FAIL
    # Not wider than it has to be: one component off by a millionth of its size is seen.
    stored["linear_velocity"][2, 0] *= 1 + mp.mpf(10) ** -6
    with mp.workdps(60):
        made = momenta(body, stored)
    assert verdicts_on(made, True)["impulse"].verdict is Status.FAIL


# Columns of states of the scene's own, in files and objects: by their names, or by those asked for.


NAMES = ("t", "w1", "w2", "w3", "q0", "q1", "q2", "q3", "m1", "m2", "h")
NUMBERS = np.arange(1.0, 23.0).reshape(2, 11)


def csv(folder: Path, names: tuple[str, ...] = NAMES) -> Path:
    path = folder / "answer.csv"
    rows = [",".join(map(repr, row.tolist())) for row in NUMBERS[:, : len(names)]]
    path.write_text("\n".join([",".join(names), *rows]), encoding="utf-8")
    return path


def as_json(folder: Path) -> Path:
    path = folder / "answer.json"
    columns = dict(zip(NAMES, NUMBERS.T.tolist(), strict=True))
    path.write_text(json.dumps(columns), encoding="utf-8")
    return path


def as_npz(folder: Path) -> Path:
    path = folder / "answer.npz"
    np.savez(path, **dict(zip(NAMES, NUMBERS.T, strict=True)))
    return path


@pytest.mark.parametrize("written", [csv, as_json, as_npz])
def test_every_format_has_them_by_one_list(written: Any, tmp_path: Path) -> None:
    """The reader of a format names columns; which are the scene's own is asked in one place."""
    groups = read(written(tmp_path), (), acted()).groups
    np.testing.assert_array_equal(groups["m"].doubles(), NUMBERS[:, 8:10])
    # A column h is a step of an integrator in another scene.
    np.testing.assert_array_equal(groups["h"].doubles(), NUMBERS[:, 10:])
    assert {"omega", "quaternion"} <= groups.keys()


@pytest.mark.parametrize("theirs", [("u", "v"), ("9", "10")])
def test_they_may_have_other_names(theirs: tuple[str, str], tmp_path: Path) -> None:
    """Columns are given by a name or by a number; one that is not there is a fault."""
    file = csv(tmp_path, (*NAMES[:8], "u", "v", "h"))
    wanted = tuple(zip(("m1", "m2"), theirs, strict=True))
    np.testing.assert_array_equal(
        read(file, wanted, acted()).groups["m"].doubles(), NUMBERS[:, 8:10]
    )
    with pytest.raises(Refused, match="expected a column of the file for m1, got `missing`"):
        read(file, (("m1", "missing"), ("m2", "v")), acted())


@pytest.mark.parametrize("place", [0, 9])
def test_a_column_that_is_asked_for_comes_before_one_of_our_name(
    place: int, tmp_path: Path
) -> None:
    """Wherever the other one stands, it is ignored, as among the columns of a body."""
    names = [*NAMES[:8], "u", "m2"]
    names.insert(place, "m1")
    groups = read(csv(tmp_path, tuple(names)), (("m1", "u"),), acted()).groups
    expected = NUMBERS[:, [names.index("u"), names.index("m2")]]
    np.testing.assert_array_equal(groups["m"].doubles(), expected)


def test_a_part_of_a_vector_is_a_fault(tmp_path: Path) -> None:
    with pytest.raises(Refused, match="expected the columns m1 m2, got no m2"):
        read(csv(tmp_path, NAMES[:9]), (), acted())


def test_objects_have_them_as_arrays_and_in_the_order_of_a_state() -> None:
    parts = {"t": NUMBERS[:, 0], "omega": NUMBERS[:, 1:4], "m": NUMBERS[:, 8:10]}
    np.testing.assert_array_equal(trajectory(parts, acted()).groups["m"].doubles(), parts["m"])
    # The scene has h before m.
    result = SimpleNamespace(t=NUMBERS[:, 0], y=NUMBERS[:, 1:].T)
    groups = trajectory(result, acted()).groups
    np.testing.assert_array_equal(groups["h"].doubles(), NUMBERS[:, 8:9])
    np.testing.assert_array_equal(groups["m"].doubles(), NUMBERS[:, 9:])
