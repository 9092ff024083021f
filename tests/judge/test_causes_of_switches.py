"""Likely causes of answers whose loads begin or end at another time, and near misses that have none."""

from __future__ import annotations

import numpy as np
import pytest
from builders.turns import by_turns
from builders.wrong_dynamics import failure

from taylor_verify.judge.causes.float_answer import Motion
from taylor_verify.judge.causes.likely import explained
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.material import ExactMotion, material
from taylor_verify.models.problem import adopt
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.reading.reader import read

PULSE = """
title = "A thruster"
model = "euler"
[body]
inertia = [3.1, 2.2, 1.4]
moment = [
  "0.25*(step(t-1)-step(t-3))", "-0.1*(step(t-1)-step(t-3))", "0.15*(step(t-1)-step(t-3))"
]
[initial]
omega = [0.2, 0.3, -0.4]
[time]
end = 6
samples = 61
"""


def sentences(changed: str) -> list[str]:
    """The causes of the exact motion of a changed scene, printed in ten digits."""
    scene = read(PULSE, "pulse")
    given = adopt(scene, rung("f64"), list(scene.clock.instants)).given
    moved = ExactMotion(read(changed, "pulse"), has_centre=False).at([*given.clock.elapsed], False)
    assert moved.q is not None
    file = Motion(np.round(moved.v, 10), np.round(moved.q, 10))
    verdicts = [failure(scene, name) for name in ("omega", "attitude")]
    answer = material(given, file, False, (np.full(3, 0.5e-10), 0.5e-10, 0.0), verdicts)
    assert answer is not None
    with np.errstate(all="ignore"):
        return [cause.sentence for cause in explained(answer).causes]


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("t-3", "t-2.25", "switch at t = 3 comes at t = 2.25"),
        ("t-3", "t-3.73", "switch at t = 3 comes at t = 3.73"),
        ("t-1", "t-0.5", "switch at t = 1 comes at t = 0.5"),
        ("step(t-", "step(t-0.3-", "loads late = 0.3"),
    ],
)
def test_a_load_that_begins_or_ends_at_another_time_is_named(
    old: str, new: str, words: str
) -> None:
    """A switch at another time has its name, however far it is; so have all that are late together."""
    (sentence,) = sentences(PULSE.replace(old, new))
    assert sentence.startswith(words)


@pytest.mark.parametrize(
    "changes",
    by_turns(
        [
            [("t-3", "t-2.25"), ("0.15*", "0.2*")],
            [("t-1", "t-1.4"), ("t-3", "t-3.3")],
            [("-0.1*(step(t-1)-step(t-3))", "-0.1*(step(t-1)-step(t-2))"), ("0.25", "0.3")],
        ]
    ),
)
def test_two_times_or_a_time_and_a_gain_have_no_one_time(changes: list[tuple[str, str]]) -> None:
    """A pulse with two other numbers is not one whose switch comes at another time."""
    text = PULSE
    for old, new in changes:
        text = text.replace(old, new)
    assert not any("comes at" in each or "late" in each for each in sentences(text))


def stepped(steps: int) -> list[list[float]]:
    """Omega at the rows by RK4, whose last stage before a switch has the load behind it already."""
    inertia, h = np.array([3.1, 2.2, 1.4]), 0.1 / steps

    def rates(t: float, w: Floats) -> Floats:
        moment = np.array([0.25, -0.1, 0.15]) if 1 - 1e-9 <= t < 3 - 1e-9 else np.zeros(3)
        rate: Floats = (np.cross(inertia * w, w) + moment) / inertia
        return rate

    w, made = np.array([0.2, 0.3, -0.4]), [[0.2, 0.3, -0.4]]
    for k in range(60 * steps):
        t = k * h
        a = rates(t, w)
        b = rates(t + h / 2, w + h / 2 * a)
        c = rates(t + h / 2, w + h / 2 * b)
        w = w + h / 6 * (a + 2 * b + 2 * c + rates(t + h, w + h * c))
        if (k + 1) % steps == 0:
            made.append(w.tolist())
    return made


def test_the_stages_of_a_method_at_a_switch_are_no_loads_of_another_time() -> None:
    """RK4 with a switch at the end of a step is off by a sixth of the step's load: nothing is early."""
    scene = read(PULSE, "pulse")
    given = adopt(scene, rung("f64"), list(scene.clock.instants)).given
    noise = (np.full(3, 0.5e-12), 0.0, 0.0)
    file = Motion(np.round(np.array(stepped(3)), 12))
    answer = material(given, file, False, noise, [failure(scene, "omega")])
    assert answer is not None
    with np.errstate(all="ignore"):
        causes = [cause.sentence for cause in explained(answer).causes]
    assert not any("late" in sentence for sentence in causes)
