"""The derivative of a motion under written loads: that of its enclosure agrees with differences."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from builders.turns import by_turns
from builders.written_loads import euler, kirchhoff
from mpmath import mp

from taylor_verify.exact.conditioning.condition import path, transition
from taylor_verify.exact.registry import kind_of
from taylor_verify.exact.route import solution
from taylor_verify.scenes.scene import Scene

SMALL = Fraction(1, 10**12)
TIMES = [Fraction(0), Fraction(1, 4), Fraction(1, 2)]
SCENES: Mapping[str, Scene] = {
    "clock": euler(["sin(2*t)", "-w2/20", "(w1 - w3)/30"]),
    "attitude": euler(["r31*w2 + q1", "-r32*tanh(t)", "r11 - exp(-t)*q2"]),
    "switch": euler(["1 if t < 0.55 else -2", "0", "r12*t"]),
    "centre": kirchhoff(
        ["-c1*r11 - norm(u1, u2, u3)*u1/4", "c2", "-r33"], ["-w1/5", "x1*r21", "sin(t)*c3"]
    ),
    "untouched": kirchhoff(["-u1/4", "cos(t)", "0"], ["-w1/5", "x1", "sin(t)"]),
}


def moved(scene: Scene, column: int) -> Scene:
    """The scene with one component of momentum, turn or centre greater at the start."""
    kind, initial = kind_of(scene.body), scene.initial
    d = 3 * len(kind.momenta)
    if column < d:
        momentum = list(kind.momentum(scene.body, kind.state(initial)))
        momentum[column] += SMALL
        state = kind.of_momentum(scene.body, tuple(momentum))
        return replace(scene, initial=kind.with_state(initial, state))
    if column < d + 3:
        a, b, c, e = initial.attitude
        half = [SMALL / 2 * (column - d == i) for i in range(3)]
        x, y, z = half
        turned = (
            a - x * b - y * c - z * e,
            b + x * a + y * e - z * c,
            c + y * a + z * b - x * e,
            e + z * a + x * c - y * b,
        )
        return replace(scene, initial=replace(initial, attitude=turned))
    centre = tuple(v + SMALL * (column - d - 3 == i) for i, v in enumerate(initial.centre))
    return replace(scene, initial=replace(initial, centre=centre))


def end(scene: Scene, motion: Any) -> Any:
    momentum = kind_of(scene.body).momentum_rows(scene.body, motion.quantities)
    centre = motion["centre"][-1] if "centre" in scene.track else []
    return momentum[-1], motion["attitude"][-1], centre


@pytest.mark.parametrize("name", by_turns(SCENES))
def test_the_derivative_is_that_of_differences(name: str) -> None:
    """Momentum, turn and centre move as motions from starts beside this one, to six digits."""
    scene = SCENES[name]
    along = transition(scene, TIMES)
    d = along.momentum.shape[1]
    size = d + 3 + 3 * ("centre" in scene.track)
    centre_unit = float(along.units["centre"])
    units = np.array([*map(float, along.flow.components), *[1.0] * 3, *[centre_unit] * 3])[:size]
    since = along.carried.since_first[-1][:size, :size] * units[:, None] / units
    with mp.workdps(40):
        momentum, R, centre = end(scene, solution(scene).motion(TIMES, 30))
        for column in range(size):
            other, turned, shifted = end(scene, solution(moved(scene, column)).motion(TIMES, 30))
            turn = turned @ R.T
            change = [*(other - momentum), turn[2, 1], turn[0, 2], turn[1, 0]]
            change += [b - a for a, b in zip(centre, shifted, strict=True)]
            slopes = np.array([float(v / mp.convert(SMALL)) for v in change])
            assert np.allclose(since[:, column], slopes, rtol=1e-6, atol=1e-6)


def test_an_orbit_carries_the_attitude_that_a_load_reads_though_nobody_tracks_it() -> None:
    """The blocks of the condition are those that move the state, tracked or not."""
    scene = replace(SCENES["attitude"], track=frozenset())
    assert path(scene).blocks == ("momentum", "attitude")
    assert path(replace(SCENES["clock"], track=frozenset())).blocks == ("momentum",)
