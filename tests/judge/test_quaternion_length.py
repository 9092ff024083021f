"""The length of a quaternion acts through the loads that are made of its rotation matrix."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from builders import written_loads
from builders.integrators import step
from builders.written_loads import Evaluated, euler, kirchhoff, rotation, value
from mpmath import mp

from taylor_verify.exact.conditioning.condition import path_of_run
from taylor_verify.exact.conditioning.linearised import products
from taylor_verify.exact.registry import kind_of
from taylor_verify.judge.floor.loads import Along
from taylor_verify.judge.floor.quaternion_length import LENGTH, with_length
from taylor_verify.scenes.scene import Scene

TOP = euler(["r33/4 - r32/3", "r31/3 - r33/4", "(r32 - r31)/4"])
SOLID = kirchhoff(
    ["-0.1*c1*r11 - norm(u1, u2, u3)*u1/4", "0.3*c2*r31", "-0.2*r33"],
    ["-w1/5", "0.1*sin(t)*r21", "-w3/10"],
)
LONGER = 1e-5
STEPS = 30
# The errors of the path between its times, and of the second order.
NEAR = 0.02


def end(scene: Scene, length: float) -> np.ndarray[Any, Any]:
    """Momenta and centre at the end, from a quaternion of this length."""
    evaluated = Evaluated(scene)
    y, at = evaluated.start(), 3 if scene.model == "euler" else 6
    y[at : at + 4] = [length * e for e in y[at : at + 4]]
    begin, last = value(scene.clock.start), value(scene.clock.instants[-1])
    h = (last - begin) / STEPS
    for k in range(STEPS):
        y = list(step(evaluated.rates, begin + k * h, y, h))
    momentum = kind_of(scene.body).momentum_matrix(scene.body).astype(float)
    return np.array([*momentum @ np.array(y[:at], dtype=float), *map(float, y[at + 4 :])])


def unscaled(q: list[Any]) -> list[list[Any]]:
    """R(q) as solvers have it that do not normalise: with the square of the length."""
    size = sum(e * e for e in q)
    return [[size * entry for entry in row] for row in rotation(q)]


@pytest.mark.parametrize("scene", [TOP, SOLID])
def test_a_longer_quaternion_moves_the_motion_as_the_path_says(
    scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two motions by Runge and Kutta, from quaternions of two lengths, differ by the derivative."""
    monkeypatch.setattr(written_loads, "rotation", unscaled)
    path = with_length(path_of_run(scene))
    sizes, d = Along(path_of_run(scene)).sizes_of_state, len(path.flow.components)
    whole = products(path.carried.steps)[-1][:-1, -1] * sizes
    with mp.workdps(20):
        moved = (end(scene, 1 + LONGER) - end(scene, 1.0)) / LONGER
    derived = np.concatenate([whole[:d], whole[d + 3 : d + 6][: len(moved) - d]])
    for part in (slice(0, d), slice(d, None)):
        error = np.linalg.norm(derived[part] - moved[part])
        assert error <= NEAR * np.linalg.norm(moved[part])


def test_without_loads_that_read_the_frame_no_length_matters() -> None:
    """A path under loads of the rates alone has no such state."""
    scene = euler(["-0.1*w1", "0.2*sin(t)", "0"])
    assert LENGTH not in with_length(path_of_run(scene)).blocks
