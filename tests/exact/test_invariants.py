"""What a free motion conserves is conserved, and loads change it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from builders.numbers import largest
from builders.scenes import (
    CLEBSCH,
    COUPLE,
    FORCE,
    GENERAL,
    MOMENT,
    TENSOR,
    sample_scene,
    vector,
)
from mpmath import mp, mpf

from taylor_verify.exact.invariants import Invariant, invariants
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Impulse, Motion, Spin
from taylor_verify.scenes.scene import Scene


def named(scene: Scene) -> dict[str, Invariant]:
    return {invariant.name: invariant for invariant in invariants(scene)}


def sampled(scene: Scene, times: Sequence[Fraction], digits: int = 40) -> Motion:
    return TaylorSolution(scene).motion(times, digits)


@pytest.mark.parametrize(
    ("scene", "names"),
    [
        (sample_scene(RigidBody(TENSOR), "attitude"), "T H2 H_space"),
        (sample_scene(GENERAL, "attitude", "centre"), "T F2 FG x_space y_space"),
        (sample_scene(CLEBSCH, "attitude", "centre"), "T F2 FG y3 x_space y_space"),
    ],
)
def test_a_free_motion_conserves_them(scene: Scene, names: str) -> None:
    """Each quantity that the tracking allows is there, and constant to the digits of the truth."""
    invariants_of = named(scene)
    assert list(invariants_of) == names.split()
    motion = sampled(scene, [Fraction(0), Fraction(2), Fraction(-1)])
    with mp.workdps(60):
        for invariant in invariants_of.values():
            value = invariant.value(motion)
            # The rows hold 40 digits; twice that error for products, and a norm or two.
            assert largest(value - value[0]) <= 10 * mpf(10) ** -40 * invariant.scale(motion)


def test_they_tell_one_motion_from_another() -> None:
    """Under loads every one of them changes: none is constant by its form."""
    rigid, solid = (
        sample_scene(RigidBody(TENSOR, MOMENT), "attitude"),
        sample_scene(replace(CLEBSCH, force=FORCE, couple=COUPLE), "attitude", "centre"),
    )
    for loaded in (rigid, solid):
        motion = sampled(loaded, [Fraction(0), Fraction(1)])
        for invariant in invariants(loaded):
            value = invariant.value(motion)
            # The loads are some tenths: in one unit of time they change each by more than 10^-3.
            assert largest(value[1:] - value[:1]) >= invariant.scale(motion) / 1000


@pytest.mark.parametrize(
    "scene",
    [sample_scene(RigidBody(TENSOR), "attitude"), sample_scene(CLEBSCH, "attitude", "centre")],
    ids=["euler", "kirchhoff"],
)
def test_sensitivity_is_the_derivative_or_its_norm(scene: Scene) -> None:
    """Difference quotients of the value, block by block, are what sensitivity states of them."""
    with mp.workdps(50):
        motion = sampled(scene, [Fraction(0), Fraction(2)])
        for invariant in invariants(scene):
            stated = invariant.sensitivity(motion)
            for block in blocks(scene):
                columns = [
                    (invariant.value(nudged(scene, motion, block, j)) - invariant.value(motion))
                    / STEP
                    for j in range(3)
                ]
                jacobian = np.stack([c.reshape(2, -1) for c in columns], axis=2).astype(float)
                expected = np.array(stated.get(block, [0, 0])).astype(float)
                by_component = expected.ndim == 2
                measured = jacobian[:, 0] if by_component else np.linalg.norm(jacobian, 2, (1, 2))
                # The quotient is right to STEP, the norms are float64.
                assert np.abs(measured - expected).max() <= 1e-12 * max(1, np.abs(expected).max())


STEP = Fraction(1, 10**20)


def blocks(scene: Scene) -> tuple[str, ...]:
    if scene.model == "euler":
        return ("momentum", "attitude")
    return ("linear_impulse", "angular_impulse", "attitude", "centre")


def nudged(scene: Scene, motion: Motion, block: str, j: int) -> Motion:
    """The motion with one component of a block moved by STEP in every row."""
    moved = {name: rows.copy() for name, rows in motion.quantities.items()}
    step = mp.convert(STEP)
    if block == "attitude":
        axis = np.array([int(i == j) for i in range(3)])
        moved["attitude"] = moved["attitude"] + step * np.stack(
            [np.cross(axis, turn, axisb=0, axisc=0) for turn in moved["attitude"]]
        )
    elif block == "momentum":
        assert isinstance(scene.body, RigidBody)
        inverse = [mp.convert(row[j]) for row in scene.body.inverse_inertia]
        moved["omega"] = moved["omega"] + step * np.array(inverse)
    else:
        moved[block][:, j] += step
    return Motion(moved, motion.radius)


def test_scales_do_not_vanish() -> None:
    """x.y = 0 leaves FG a scale, y3 = 0 leaves y3 one, and a body at rest has scale 1 for all."""
    crossed = Impulse(vector(1, 0, 0), vector(0, 2, 0))
    motion = sampled(sample_scene(CLEBSCH, start=crossed), [Fraction(0)])
    invariants_of = named(sample_scene(CLEBSCH))
    for name in ("FG", "y3"):
        assert invariants_of[name].value(motion)[0] == 0
        assert invariants_of[name].scale(motion) == 2
    nowhere = Impulse(vector(0, 0, 0), vector(0, 0, 0))
    for resting in (
        sample_scene(CLEBSCH, "attitude", "centre", start=nowhere),
        sample_scene(RigidBody(TENSOR), "attitude", start=Spin(vector(0, 0, 0))),
    ):
        motion = sampled(resting, [Fraction(0), Fraction(1)])
        assert [invariant.scale(motion) for invariant in invariants(resting)] == [1] * len(
            invariants(resting)
        )
