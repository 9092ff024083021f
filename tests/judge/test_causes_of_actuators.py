"""Likely causes in what a simulator does with a moment: limits, held values, parts of a row, flight."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from builders.caused_rows import RIGID, TENSOR, TIMES, Array, Law, Q, columns, rows, titles
from builders.scenes import text_of
from builders.turns import by_turns
from builders.wrong_dynamics import explained_motion

from taylor_verify import exact
from taylor_verify.judge.causes.float_answer import Motion
from taylor_verify.judge.causes.quaternion_rows import steady_signs
from taylor_verify.judge.conventions.axis_orders import quaternion_columns
from taylor_verify.scenes.reading.reader import read
from taylor_verify.scenes.scene import Scene

OWN_Q = np.array([0.3, 0.6, -0.5, 0.55]) / np.linalg.norm([0.3, 0.6, -0.5, 0.55])
TEXTS = [f"-2.4*q{i} - 3*w{i}" for i in (1, 2, 3)]
BODY = text_of(
    {"moment": TEXTS, "inertia": [[1.9, 0.1, 0.05], [0.1, 2.4, -0.2], [0.05, -0.2, 1.5]]},
    {"omega": [0.8, -0.5, 0.6], "attitude": [0.3, 0.6, -0.5, 0.55]},
    *(4, 41, "omega", "attitude"),
)
LINE = next(line for line in BODY.splitlines() if line.startswith("moment"))


@cache
def scene(text: str) -> Scene:
    return read(text, "actuators")


def sentences(changed: str) -> list[str]:
    """The causes of the exact motion of a changed scene, printed in ten digits."""
    own = scene(BODY)
    moved = exact(scene(changed), times=list(own.clock.instants), digits=15)
    v = np.array([[float(x) for x in row] for row in moved["omega"]])
    turns = [[[float(x) for x in row] for row in R] for R in moved["attitude"]]
    unit = steady_signs(quaternion_columns(np.array(turns)))
    q = unit * np.sign(unit[0] @ OWN_Q)
    explained = explained_motion(own, Motion(np.round(v, 10), np.round(q, 10)))
    return [cause.sentence for cause in explained.causes]


def with_moment(texts: Sequence[str], more: str = "") -> str:
    listed = ", ".join(f'"{text}"' for text in texts)
    return BODY.replace(LINE, f"moment = [{listed}]") + more


def limited(*limits: float) -> str:
    texts = zip(TEXTS, limits, strict=True)
    return with_moment([f"clip({text}, -{limit}, {limit})" for text, limit in texts])


def within_a_length(limit: float) -> str:
    length = f"max(norm({', '.join(TEXTS)}), {limit})"
    return with_moment([f"({text})*{limit}/{length}" for text in TEXTS])


def late(start: Sequence[float], every: str = "1/20", steps: int = 1) -> str:
    """The moment of so many steps before."""
    listed = ", ".join(f'"{text}"' for text in TEXTS)
    held = [f'm0 = {{ every = "{every}", start = {[*start]}, value = [{listed}] }}']
    for k in range(1, steps + 1):
        before = ", ".join(f'"m{k - 1}{i}"' for i in (1, 2, 3))
        held.append(f'm{k} = {{ every = "{every}", start = {[*start]}, value = [{before}] }}')
    return with_moment([f"m{steps}{i}" for i in (1, 2, 3)], "\n".join(["[states]", *held]))


# The moment at the start.
OWN = (-2.4 * OWN_Q[1:] - 3 * np.array([0.8, -0.5, 0.6])).tolist()


@pytest.mark.parametrize(
    ("changed", "words"),
    by_turns(
        [
            (limited(1, 1, 1), "a limit of the moment on each axis = 1"),
            (within_a_length(1.5), "a limit of the length of the moment = 1.5"),
            (limited(1, 0.7, 1.2), None),
            (late([0, 0, 0]), "loads taken every 0.05, used one step late and held in between"),
            (
                late(OWN),
                "loads taken every 0.05, used one step late but for the first step and held in between",
            ),
            (late([0, 0, 0], steps=2), None),
            (late([1, 1, 1]), None),
        ],
        7,
        lambda changed, words: words is None,
    ),
)
def test_what_an_actuator_does_is_named(changed: str, words: str | None) -> None:
    """A limit, or values of the step before, have their names; three limits or two steps have none."""
    named = [each.partition("; leaves")[0] for each in sentences(changed)]
    assert named == ([] if words is None else [words])


def test_a_cause_of_a_late_moment_is_a_scene_that_moves_so() -> None:
    """The states that the sentence prints, in the place of the moment, are those of the motion."""
    (sentence,) = sentences(late(OWN))
    printed = sentence.partition("as a scene: ")[2]
    start = printed.partition("states.moment_now.start = ")[2].partition(";")[0]
    assert [float(x) for x in start.strip("[]").split(",")] == pytest.approx(OWN, rel=1e-9)
    assert 'states.moment_held.value = ["moment_now1", "moment_now2", "moment_now3"]' in printed
    assert "states.moment_now.every = 0.05" in printed


CONSTANT = np.array([0.3, 0.45, -0.25])


def cleared(steps: int, less: float) -> Array:
    """The states under a moment of the first of so many steps of each row, and a part of it in the rest."""
    z, made = np.array([0.8, -0.5, 1.1, *Q]), [np.array([0.8, -0.5, 1.1, *Q])]
    for part, of in [(1 / steps, 1.0), (1 - 1 / steps, less)] * (len(TIMES) - 1):
        law: Law = lambda t, w, q, of=of: spin(w, of)  # noqa: E731 (a law of one line)
        z = rows(law, z[:3].tolist(), z[3:], np.array([0, 0.1 * part]), ())[-1]
        made.append(z)
    return np.array(made[::2])


def spin(w: Array, of: float) -> Array:
    return np.linalg.solve(TENSOR, np.cross(TENSOR @ w, w) + of * CONSTANT)


@pytest.mark.parametrize(
    ("less", "words"),
    [
        (0.0, ["the loads act in the first of 4 steps from row to row, and not in the others"]),
        (0.3, []),
    ],
)
def test_loads_that_are_cleared_within_a_row_are_named(
    less: float, words: list[str], tmp_path: Path
) -> None:
    """A moment of the first of four steps has its name; one that goes on with less has none."""
    text = RIGID.format(load=f"moment = {CONSTANT.tolist()}")
    made = columns(TIMES, cleared(4, less), ("w1", "w2", "w3"))
    assert titles(tmp_path, text, made) == words


def test_a_motion_that_runs_away_has_the_cause_of_its_first_rows() -> None:
    """A controller with one sign wrong grows a thousandfold; the rows before that tell which one."""
    own = scene(BODY)
    tensor = np.array(own.body.inertia, dtype=float)
    times = np.array([float(t) for t in own.clock.instants])

    def law(t: float, w: Array, q: Array) -> Array:
        moment = -2.4 * q[1:] - 3 * w
        return np.linalg.solve(tensor, np.cross(tensor @ w, w) + moment * [1, 1, -1])

    made = rows(law, [0.8, -0.5, 0.6], OWN_Q, times, ())
    (cause,) = explained_motion(own, Motion(made[:, :3], made[:, 3:])).causes
    assert np.max(np.abs(made[:, :3])) > 1e3
    assert cause.sentence.startswith("up to t = ")
    assert "before the motion runs away: moment 3 with the other sign; leaves" in cause.sentence
