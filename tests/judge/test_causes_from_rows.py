"""Causes of attitudes alone, of parts of a run, of steps, under loads by the attitude."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from unittest.mock import Mock

import numpy as np
import pytest
from builders.caused_rows import (
    RIGID,
    TENSOR,
    TIMES,
    Array,
    Law,
    Q,
    causes,
    columns,
    rigid,
    rows,
    table,
    titles,
)
from builders.trajectories import (
    QUATERNION,
    VECTORS,
    Columns,
    columns_at,
    file_judgement,
    named,
    write_csv,
)
from builders.turns import by_turns
from builders.wrong_dynamics import turned
from scipy.spatial.transform import Rotation

from taylor_verify.judge.causes import starts
from taylor_verify.scenes.reading.reader import load, read

SPRING = 'moment = ["-0.4*q1 - 0.1*w1", "-0.4*q2 - 0.1*w2", "-0.4*q3 - 0.1*w3"]'


def window(begin: float, end: float, moment: Sequence[float]) -> Law:
    return lambda t, w, q: np.array(moment) if begin <= t < end else np.zeros(3)


HEAVIER = TENSOR + np.diag([0.0, 0.0, 0.15])
DAMPED: Law = lambda t, w, q: -0.07 * TENSOR @ w  # noqa: E731 (a law of one line)


@pytest.mark.parametrize(
    ("made", "words"),
    [
        (lambda: rigid(HEAVIER), "I_33 = 3.25 for 3.1"),
        (lambda: rigid(gyro=0.0), "no gyroscopic term"),
        (lambda: rigid(moment=DAMPED), "damping = 0.07"),
    ],
)
def test_attitudes_alone_name_the_cause(
    made: Callable[[], Columns], words: str, tmp_path: Path
) -> None:
    """Rows without omega have the cause of their motion, and leave parts of the attitude alone."""
    own = {name: column for name, column in made().items() if not name.startswith("w")}
    (cause,) = causes(tmp_path, RIGID.format(load=""), own)
    assert cause.sentence.startswith(words)
    assert cause.quantity == "attitude"
    assert "of omega" not in cause.sentence


def test_a_pose_alone_has_the_convention_of_its_path(tmp_path: Path) -> None:
    """Attitude and centre of a body in a fluid need no velocities to show that a height is a depth."""
    scene = load("kirchhoff/ellipsoid-prolate")
    scene = replace(scene, track=frozenset({"attitude", "centre"}))
    made = columns_at(scene, scene.clock.instants)
    pose = {name: made[name] for name in ("t", *QUATERNION, "c1", "c2", "c3")}
    path = write_csv(tmp_path / "pose.csv", pose | {"c3": [-float(c) for c in pose["c3"]]})
    (cause,) = file_judgement(str(path), scene).causes
    assert cause.sentence.startswith("the centre has the other sign on axis 3; leaves ")


@pytest.mark.parametrize(("early", "digits"), [(0.02, 5), (0.002, 6)])
def test_a_right_attitude_refutes_another_start(early: float, digits: int, tmp_path: Path) -> None:
    """An omega that is early is nearly that of another start; from there the attitude is another one."""
    free: Law = lambda t, w, q: np.linalg.solve(TENSOR, np.cross(TENSOR @ w, w))  # noqa: E731
    moved = rows(free, [0.8, -0.5, 1.1], Q, np.r_[0, TIMES + early], ())[1:, :3]
    made = rigid() | named(VECTORS["omega"], moved)
    printed = {name: [float(f"{x:.{digits}g}") for x in column] for name, column in made.items()}
    assert not [x for x in titles(tmp_path, RIGID.format(load=""), printed) if "start" in x]


def test_the_search_behind_a_jump_is_no_search_of_jumps(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Defects that die away, as those of times in microseconds do, are cut off once and not row by row."""
    asked = Mock(wraps=starts.piece)
    monkeypatch.setattr(starts, "piece", asked)
    monkeypatch.setattr(starts, "roundings", lambda answer: 1e3 ** -np.arange(answer.count - 1.0))
    law: Law = lambda t, w, q: -0.1 * w * np.linalg.norm(w) ** 0.3  # noqa: E731
    titles(tmp_path, RIGID.format(load=""), rigid(moment=law))
    assert asked.call_count < 5


def euler_after_a_jump(jump: float, noise: float) -> Columns:
    """Rows of explicit Euler with ten steps a row, before which omega has a factor, and noise after it."""
    w, made, draws = np.array([0.8, -0.5, 1.1]), [], np.random.default_rng(1)
    for k in range(len(TIMES)):
        made.append(w)
        w = w * (jump if not k else 1.0) + noise * draws.standard_normal(3)
        for _ in range(10):
            w = w + 0.01 * np.linalg.solve(TENSOR, np.cross(TENSOR @ w, w))
    return named(("t",), TIMES[:, None]) | named(VECTORS["omega"], np.array(made))


@pytest.mark.parametrize(("jump", "noise", "count"), [(0.9, 0.0, 2), (1.0, 0.0, 1), (0.9, 1e-3, 0)])
def test_a_jump_before_the_steps_of_a_method_is_said_with_them(
    jump: float, noise: float, count: int, tmp_path: Path
) -> None:
    """A jump of the first row is said with the cause of the rest, and not without it."""
    scene = RIGID.format(load="").replace(', "attitude"', "")
    sentences = titles(tmp_path, scene, euler_after_a_jump(jump, noise))
    expected = ["a jump between the first two rows, from t = 0 to 0.1", "explicit Euler, h = 0.01"]
    assert len(sentences) == count
    for sentence, words in zip(sentences, expected[-count or 2 :], strict=False):
        assert words in sentence


KNOTS = """moment = ["tab", "0", "0"]
[tables]
tab = { times = [0, 2, 4, 6], values = [0.1, -0.05, 0.08, 0.02] }"""


@pytest.mark.parametrize(
    ("load", "moment", "edges", "words"),
    by_turns(
        [
            (
                "",
                window(3, 6, [0.05, 0.02, -0.04]),
                (3, 6),
                ["from t = 3 to 6: moment in body axes"],
            ),
            ("", window(0, 4, [0.05, 0.02, -0.04]), (4,), ["up to t = 4: moment in body axes"]),
            (
                "",
                window(3.05, 6.05, [0.05, 0.02, -0.04]),
                (3.05, 6.05),
                ["from t = 3, or less than a row later, to 6.1, or less than a row before: moment"],
            ),
            ("", window(3.05, 9, [0.05, 0, 0.04]), (3.05,), ["right up to t = 3, then: moment in"]),
            (
                "moment = [0.1, -0.05, 0.08]",
                window(0, 5, [0.1, -0.05, 0.08]),
                (5,),
                ["right up to t = 5, then: moment left out"],
            ),
            (
                "",
                lambda t, w, q: (
                    DAMPED(t, w, q) * (3 <= t < 6) + np.array([0.04, 0, 0.03]) * (t >= 6)
                ),
                (3, 6),
                ["from t = 3 to 6: damping = 0.07", "from t = 6 on: moment in body axes"],
            ),
            (
                KNOTS,
                lambda t, w, q: np.array([[0.1, -0.05, 0.08, 0.02][min(int(t / 2), 3)], 0, 0]),
                (2, 4, 6),
                ["table tab is hold, where the scene has linear"],
            ),
        ],
        6,
    ),
)
def test_a_part_of_the_run_has_its_cause(
    load: str, moment: Law, edges: Sequence[float], words: Sequence[str], tmp_path: Path
) -> None:
    """A fault that begins or ends within the run has its times, unless it is one of the whole run."""
    named_ones = titles(tmp_path, RIGID.format(load=load), rigid(moment=moment, edges=edges))
    assert len(named_ones) == len(words)
    assert all(title.startswith(own) for title, own in zip(named_ones, words, strict=True))


def held(made: Columns) -> Columns:
    """The attitude of row 40 in all rows that follow."""
    each = table(made)
    each[41:, 3:] = each[40, 3:]
    return columns(TIMES, each, ("w1", "w2", "w3"))


def set_anew(made: Columns) -> Columns:
    """The attitude turned by a fixed rotation from row 40 on."""
    each, turn = table(made), Rotation.from_rotvec([0.3, -0.2, 0.5])
    turned_on = turn * Rotation.from_quat(np.roll(each[40:, 3:], -1, axis=1))
    each[40:, 3:] = np.roll(turned_on.as_quat(), 1, axis=1)
    return columns(TIMES, each, ("w1", "w2", "w3"))


def saved_twice(made: Columns) -> Columns:
    return columns(TIMES[:80], np.repeat(table(made)[:40], 2, axis=0), ("w1", "w2", "w3"))


def in_steps(moment: Law = DAMPED) -> Columns:
    """Explicit Euler in five steps a row, with a moment."""
    h, z, made = 0.02, np.array([0.8, -0.5, 1.1, *Q]), [np.array([0.8, -0.5, 1.1, *Q])]
    for _ in TIMES[1:]:
        for _ in range(5):
            w, q = z[:3], z[3:]
            rate = np.linalg.solve(TENSOR, np.cross(TENSOR @ w, w) + moment(0.0, w, q))
            z = z + h * np.concatenate([rate, turned(q, w)])
            z[3:] /= np.linalg.norm(z[3:])
        made.append(z)
    return columns(TIMES, np.array(made), ("w1", "w2", "w3"))


@pytest.mark.parametrize(
    ("made", "words"),
    [
        (lambda: held(rigid()), "attitude stands still from t = 4 on, and follows the motion"),
        (lambda: set_anew(rigid()), "attitude set anew at t = 4: each piece follows the motion"),
        (lambda: saved_twice(rigid()), "each row is saved twice; of every second row: clock = 0.5"),
        (in_steps, "damping = 0.07, beside steps of explicit Euler, h = 0.02"),
    ],
)
def test_rows_that_are_held_or_stepped_have_their_cause(
    made: Callable[[], Columns], words: str, tmp_path: Path
) -> None:
    """An attitude held or set anew, rows saved twice, a fault beside coarse steps: each has its name."""
    assert titles(tmp_path, RIGID.format(load=""), made())[0].startswith(words)


WHEELS = np.array([0.4, -0.3, 0.5])


@pytest.mark.parametrize(
    ("moment", "words"),
    by_turns(
        [
            (lambda t, w, q: 0 * w, "wheels left out, beside steps of explicit Euler, h = 0.02"),
            (
                lambda t, w, q: np.cross(WHEELS * [1, 0, 1], w),
                "wheel 2 left out, beside steps of explicit Euler, h = 0.02",
            ),
            (lambda t, w, q: -0.05 * w**3, None),
            (lambda t, w, q: 0.5 * np.cross(WHEELS, w) - 0.05 * w**3, None),
        ],
        4,
        lambda moment, words: words is None,
    ),
)
def test_wheels_that_are_missing_beside_steps_are_named(
    moment: Law, words: str | None, tmp_path: Path
) -> None:
    """Wheels left out by a coarse method have their name beside its own; two faults beside it have none."""
    scene = RIGID.format(load=f"rotor = {WHEELS.tolist()}")
    assert [*titles(tmp_path, scene, in_steps(moment))] == ([] if words is None else [words])


@pytest.mark.parametrize(
    ("moment", "words"),
    by_turns(
        [
            (lambda t, w, q: (-0.4 * q[1:] - 0.1 * w) * [1, -1, 1], "moment 2 with the other sign"),
            (lambda t, w, q: -0.4 * q[1:], "all linear drag left out"),
        ]
    ),
)
def test_a_text_reads_the_quaternion_with_its_sign(moment: Law, words: str, tmp_path: Path) -> None:
    """A load of q1 q2 q3 has the sign of the scene's start, of which the scalar is negative here."""
    assert titles(tmp_path, RIGID.format(load=SPRING), rigid(moment=moment))[0].startswith(words)


TEXTS = 'moment = ["0.1*sin(2*t)", "-0.05*w2", "k*(w1 - w3)"]\n[define]\nk = "1/30"'


def waving(size: float = 0.1, pace: float = 2.0, k: float = 1 / 30) -> Law:
    return lambda t, w, q: np.array([size * np.sin(pace * t), -0.05 * w[1], k * (w[0] - w[2])])


@pytest.mark.parametrize(
    ("moment", "words"),
    by_turns(
        [
            (waving(size=0.12), ["`0.1` in moment 1, 0.1*sin(2*t), = 0.12 for 0.1 (+20 %)"]),
            (waving(pace=2.1), ["`2` in moment 1, 0.1*sin(2*t), = 2.1 for 2 (+5 %)"]),
            (waving(k=0.04), ["k = 0.04 for 0.03333333 (+20 %)"]),
            (
                waving(pace=2 * np.pi / 180),
                ["`2` in moment 1, 0.1*sin(2*t), degrees and radians exchanged"],
            ),
            (waving(pace=2.1, k=0.04), []),
            (lambda t, w, q: waving(pace=2.1)(t, w, q) - 1e-3 * w**3, []),
        ],
        6,
    ),
)
def test_one_number_of_a_text_is_named(moment: Law, words: list[str], tmp_path: Path) -> None:
    """A number of a load's text is named by its place; two at once, or one and a cubic drag, are not."""
    assert titles(tmp_path, RIGID.format(load=TEXTS), rigid(moment=moment)) == words


@pytest.mark.slow
def test_steps_under_a_load_that_reads_the_attitude_are_replayed(tmp_path: Path) -> None:
    """Explicit Euler of a moment by the attitude has its name and step, and explains the attitude."""
    own = in_steps(lambda t, w, q: -0.4 * q[1:] - 0.1 * w)
    (title,) = titles(tmp_path, RIGID.format(load=SPRING), own)
    assert title == "explicit gyroscopic step: explicit Euler, h = 0.02"


@pytest.mark.slow
def test_the_load_between_rows_is_in_the_document(tmp_path: Path) -> None:
    """A moment that no family has is listed row by row, as what it was in the middle of each row."""
    wave: Law = lambda t, w, q: np.array([0.05, 0.02, -0.04]) * np.sin(t)  # noqa: E731 (as above)
    path = write_csv(tmp_path / "mine.csv", rigid(moment=wave))
    document = file_judgement(path, read(RIGID.format(load=""), "scene")).document()
    assert not document["causes"]
    for each in document["missing_load"]:
        middle = (each["t"] + each["until"]) / 2
        assert each["load"] == pytest.approx(wave(middle, Q, Q), abs=1e-4)
    assert len(document["missing_load"]) == len(TIMES) - 1


def with_nothing_in(made: Columns, rows_: slice, value: float) -> Columns:
    spoilt = {name: np.array(values, dtype=float) for name, values in made.items()}
    for name in spoilt.keys() - {"t"}:
        spoilt[name][rows_] = value
    return {name: values.tolist() for name, values in spoilt.items()}


@pytest.mark.parametrize(
    ("tensor", "nothing", "value", "title", "note"),
    by_turns(
        [
            (TENSOR, np.s_[30:31], 0.0, [], "one row is zero (t = 3); all others are right"),
            (
                TENSOR,
                np.s_[30:31],
                np.nan,
                [],
                "one row is not finite (t = 3); all others are right",
            ),
            (
                TENSOR,
                np.s_[50:],
                np.nan,
                [],
                "all rows from t = 5 on are not finite; those before are right",
            ),
            (HEAVIER, np.s_[30:31], np.nan, ["I_33"], "one row is not finite (t = 3)"),
        ],
        3,
    ),
)
def test_rows_that_are_lost_are_a_fact_of_their_own(
    tensor: Array, nothing: slice, value: float, title: list[str], note: str, tmp_path: Path
) -> None:
    """No load is missing beside them; the other rows are right, or have the cause that they have."""
    path = write_csv(tmp_path / "mine.csv", with_nothing_in(rigid(tensor), nothing, value))
    judged = file_judgement(path, read(RIGID.format(load=""), "scene"))
    assert [cause.name.split(" ")[0] for cause in judged.causes] == title
    assert note in judged.notes
    assert not any("no cause is proven" in each for each in judged.notes)
