"""The Taylor route solves the equations of both texts, loads and all, to any digits."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from builders.numbers import largest, matrix
from builders.scenes import (
    GENERAL,
    LOADED,
    MOMENT,
    OMEGA,
    QUATERNION,
    TENSOR,
    sample_scene,
    vector,
)
from mpmath import mp, mpf

from taylor_verify.exact.taylor import TaylorSolution, arcs
from taylor_verify.numbers.precision import exact_value
from taylor_verify.numbers.tensors import diagonal, scaled
from taylor_verify.scenes.bodies import Clebsch, ImmersedBody, RigidBody
from taylor_verify.scenes.motion import Impulse, Motion, Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

Array = np.ndarray[Any, Any]


EVERYTHING = [
    sample_scene(RigidBody(TENSOR), "attitude"),
    sample_scene(RigidBody(TENSOR, MOMENT), "attitude"),
    sample_scene(GENERAL, "attitude", "centre"),
    sample_scene(LOADED, "attitude", "centre"),
]
each_scene = pytest.mark.parametrize(
    "scene", EVERYTHING, ids=["euler", "euler loaded", "kirchhoff", "kirchhoff loaded"]
)


def rates(scene: Scene, motion: Motion, row: int) -> dict[str, Array]:
    """The right-hand sides of the texts, written with cross products of whole vectors."""
    rate_of: dict[str, Array] = {}
    if isinstance(scene.body, RigidBody):
        inertia, moment = matrix(scene.body.inertia), matrix((scene.body.moment,))[0]
        omega = motion["omega"][row]
        torque = np.cross(inertia @ omega, omega) + moment
        rate_of["omega"] = np.array(list(mp.lu_solve(mp.matrix(inertia.tolist()), list(torque))))
    else:
        body = scene.body
        x, y = motion["linear_impulse"][row], motion["angular_impulse"][row]
        velocity = matrix(body.linear) @ x + matrix(body.coupling) @ y
        omega = matrix(body.coupling).T @ x + matrix(body.angular) @ y
        rate_of["linear_impulse"] = np.cross(x, omega) + matrix((body.force,))[0]
        rate_of["angular_impulse"] = (
            np.cross(y, omega) + np.cross(x, velocity) + matrix((body.couple,))[0]
        )
        rate_of["centre"] = motion["attitude"][row] @ velocity
    rate_of["attitude"] = motion["attitude"][row] @ np.cross(omega, np.eye(3, dtype=int)).T
    return rate_of


@each_scene
def test_motion_obeys_the_equations(scene: Scene) -> None:
    """Central differences of the solution equal the equations' right-hand sides."""
    step, digits = Fraction(1, 10**20), 70
    times = [1 - step, Fraction(1), 1 + step]
    motion = TaylorSolution(scene).motion(times, digits)
    with mp.workdps(digits):
        for name, rate in rates(scene, motion, 1).items():
            slope = (motion[name][2] - motion[name][0]) / (2 * mp.convert(step))
            # The difference's own error is step^2/6 times a third derivative of some tens.
            assert largest(slope - rate) <= mpf(10) ** -37


@pytest.mark.parametrize("span", [Fraction(3, 2), Fraction(-3, 2)], ids=["later", "earlier"])
def test_a_restarted_motion_continues(span: Fraction) -> None:
    """The flow is a group: from the state at t, the time s leads to the state at t + s."""
    scene = sample_scene(LOADED)
    whole = TaylorSolution(scene).motion([Fraction(1), 1 + span], 50)
    middle = Impulse(
        tuple(exact_value(entry) for entry in whole["linear_impulse"][0]),
        tuple(exact_value(entry) for entry in whole["angular_impulse"][0]),
    )
    rest = arcs(scene, [middle], [span], 45)
    with mp.workdps(60):
        for name in rest.quantities:
            # 50 digits at the restart, and an orbit that makes less than 10^5 of them.
            assert largest(rest[name][0] - whole[name][1]) <= mpf(10) ** -45


@pytest.mark.parametrize(
    "scene",
    [sample_scene(RigidBody(TENSOR, MOMENT), "attitude"), load("loads/heavy-top")],
    ids=["loads apart from the attitude", "a weight"],
)
def test_arcs_are_motions_of_their_own(scene: Scene) -> None:
    """Row k of arcs is the motion from the k-th state alone, after the k-th span, in its own attitude."""
    starts = [Spin(vector(1, 0, "0.5"), QUATERNION), Spin(vector("0.2", -1, 0))]
    spans = [Fraction(3, 2), Fraction(-1, 3)]
    together = arcs(scene, starts, spans, 30, [Fraction(0)] * 2)
    for k, (start, span) in enumerate(zip(starts, spans, strict=True)):
        alone = TaylorSolution(replace(scene, initial=start)).motion([span], 30)
        with mp.workdps(50):
            for name in together.quantities:
                assert largest(together[name][k] - alone[name][0]) <= mpf(10) ** -30


@pytest.mark.parametrize("size", [Fraction(1, 2**40), Fraction(2**20)], ids=["small", "large"])
def test_arcs_begin_at_any_size(size: Fraction) -> None:
    """An arc has its digits also where its state is far smaller or larger than the scene's own."""
    scene = sample_scene(RigidBody(TENSOR))
    start = Spin(vector(size, -size, size / 2))
    (arc,) = arcs(scene, [start], [1 / size], 30)["omega"]
    (alone,) = TaylorSolution(replace(scene, initial=start)).motion([1 / size], 30)["omega"]
    with mp.workdps(50):
        assert largest(arc - alone) <= mpf(10) ** -30 * largest(alone)


def test_spherical_body_under_a_moment() -> None:
    """With equal moments of inertia omega = omega0 + M t / J, and no step is too long for it."""
    body = RigidBody(diagonal(vector(3, 3, 3)), MOMENT)
    time = Fraction(10**6, 7)
    omega = TaylorSolution(sample_scene(body)).motion([time], 40)["omega"][0]
    with mp.workdps(60):
        expected = [mp.convert(w + m * time / 3) for w, m in zip(OMEGA, MOMENT, strict=True)]
        assert largest(omega - np.array(expected)) <= mpf(10) ** -40 * max(map(abs, expected))


def test_units_change_nothing() -> None:
    """With impulses 2^40 times as large and energy coefficients as much smaller, nothing changes.

    U and Omega are then the same, and every number of the motion is one exactly shifted.
    """
    factor = Fraction(2**40)
    blocks = (GENERAL.linear, GENERAL.coupling, GENERAL.angular)
    heavy = ImmersedBody(*(tuple(scaled(1 / factor, row) for row in block) for block in blocks))
    light = sample_scene(GENERAL, "attitude", "centre")
    start = light.initial
    assert isinstance(start, Impulse)
    massive = Impulse(
        scaled(factor, start.linear), scaled(factor, start.angular), QUATERNION, start.centre
    )
    times = [Fraction(-1, 2), Fraction(1)]
    one = TaylorSolution(light).evaluate(times, 30)
    other = TaylorSolution(replace(light, body=heavy, initial=massive)).evaluate(times, 30)
    # Enough digits that a shift of what was computed rounds nothing.
    with mp.workdps(200):
        for name, shift in (("linear_impulse", 2**40), ("attitude", 1), ("centre", 1)):
            assert (one[name] * shift == other[name]).all()


def test_a_couple_that_vanishes_for_the_body_leaves_y_exactly() -> None:
    """With p = p' and no coupling x x U = 0 whatever x is: y = 0 stays zero, and no rounding tells."""
    ninth = Fraction(1, 9)
    sphere = Clebsch(ninth, ninth, Fraction(0), Fraction(0), ninth, ninth).body()
    still = Impulse(vector(0, "25/16", "-4/7"), vector(0, 0, 0), QUATERNION, vector(1, 2, 3))
    moving = replace(sample_scene(sphere, "attitude", "centre"), initial=still)
    motion = TaylorSolution(moving).motion([Fraction(14000, 1107)], 30)
    assert not any(motion["angular_impulse"].flat)
