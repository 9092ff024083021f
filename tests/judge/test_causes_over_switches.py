"""Methods whose steps go over the switches of a table, as those of a simulator that does not know them."""

from __future__ import annotations

from itertools import pairwise
from math import sin
from typing import Any

import numpy as np
import pytest
from builders.turns import by_turns
from builders.wrong_dynamics import turned

from taylor_verify import check
from taylor_verify.models.acting import Acting
from taylor_verify.scenes.reading.reader import read
from taylor_verify.scenes.scene import Scene

TENSOR = np.array([[2.0, 0, 0.1], [0, 1.5, 0], [0.1, 0, 1]])
KNOTS = [round(0.37 * k, 2) for k in range(24)]
VALUES = [round(0.4 * sin(7.0 * k * k), 3) for k in range(24)]
START = np.array([0.3, 0.2, 0.5, 1, 0, 0, 0])
SATELLITE = f"""
title = "A satellite with logged moments"
model = "euler"
track = ["attitude"]
[body]
inertia = {TENSOR.tolist()}
moment = ["log", "-0.1*w2", "0.2*w1"]
[tables]
log = {{ times = {KNOTS}, values = {VALUES}, kind = "KIND" }}
[initial]
omega = [0.3, 0.2, 0.5]
[time]
end = 8
samples = 81
"""


def scene_of(kind: str) -> Scene:
    return read(SATELLITE.replace("KIND", kind), "satellite")


def moment_of(kind: str, t: float) -> float:
    if kind == "linear":
        return float(np.interp(t, KNOTS, VALUES))
    # A time that is a knot but for rounding is in the later piece.
    return VALUES[int(np.searchsorted(KNOTS, t + 1e-12, side="right")) - 1]


def rates(kind: str, t: float, z: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    w = z[:3]
    moment = np.array([moment_of(kind, t), -0.1 * w[1], 0.2 * w[0]])
    spin = np.linalg.solve(TENSOR, np.cross(TENSOR @ w, w) + moment)
    return np.concatenate([spin, turned(z[3:], w)])


def rk4(kind: str, t: float, z: np.ndarray[Any, Any], h: float) -> np.ndarray[Any, Any]:
    a = rates(kind, t, z)
    b = rates(kind, t + h / 2, z + h / 2 * a)
    c = rates(kind, t + h / 2, z + h / 2 * b)
    d = rates(kind, t + h, z + h * c)
    return z + h / 6 * (a + 2 * b + 2 * c + d)


def euler(kind: str, t: float, z: np.ndarray[Any, Any], h: float) -> np.ndarray[Any, Any]:
    return z + h * rates(kind, t, z)


@pytest.mark.parametrize(
    ("kind", "step", "every", "words"),
    by_turns(
        [
            ("hold", rk4, 1, ["truncation of order 4: RK4, h = 0.1"]),
            ("linear", rk4, 1, ["truncation of order 4: RK4, h = 0.1"]),
            ("hold", rk4, 4, ["truncation of order 4: RK4, h = 0.025"]),
            (
                "hold",
                euler,
                2,
                [
                    "explicit gyroscopic step: explicit Euler, h = 0.05",
                    "attitude q + h q omega / 2",
                ],
            ),
        ],
    ),
)
def test_steps_over_the_knots_of_a_table_are_named(
    kind: str, step: Any, every: int, words: list[str]
) -> None:
    """The arcs without a knot tell the number of steps; those with one leave more."""
    scene = scene_of(kind)
    times, z, made = [float(t) for t in scene.clock.instants], START, [START]
    for begin, end in pairwise(times):
        h = (end - begin) / every
        for k in range(every):
            z = step(kind, begin + k * h, z, h)
            z[3:] /= np.linalg.norm(z[3:])
        made.append(z)
    rows = np.array(made)
    judged = check(
        scene, {"t": times, "omega": rows[:, :3], "quaternion": rows[:, 3:]}, tolerance=1e-9
    )
    for cause, own in zip(judged.causes, words, strict=True):
        assert cause.sentence.startswith(own)
        assert cause.leaves < 1e-9


def test_many_times_are_read_as_each_alone() -> None:
    """Pieces of a table share code with numbers of their own; a piece of other steps has its own code."""
    for kind in ("hold", "linear", "cubic"):
        scene = scene_of(kind)
        acting = Acting(scene, scene.body.loads)
        times = np.linspace(0, 9.5, 200).reshape(2, 100)
        states = np.stack([np.cos(times), np.sin(times), 0.1 * times], axis=-1)
        at_once = acting.loads(times, states)
        pairs = zip(times.ravel(), states.reshape(-1, 3), strict=True)
        alone = np.array([acting.loads(t, z) for t, z in pairs]).reshape(states.shape)
        assert np.allclose(at_once, alone, rtol=0, atol=1e-15)
        assert np.array_equal(at_once, acting.loads(times, states))
