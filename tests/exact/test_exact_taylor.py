"""Arcs of the Taylor route are motions of their own; the referee and the closed forms have its digits."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest
from builders.numbers import largest
from builders.scenes import (
    MOMENT,
    QUATERNION,
    TENSOR,
    sample_scene,
    vector,
)
from mpmath import mp, mpf

from taylor_verify.exact.taylor import TaylorSolution, arcs
from taylor_verify.scenes.bodies import Clebsch, RigidBody
from taylor_verify.scenes.motion import Impulse, Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene


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


def test_a_couple_that_vanishes_for_the_body_leaves_y_exactly() -> None:
    """With p = p' and no coupling x x U = 0 whatever x is: y = 0 stays zero, and no rounding tells."""
    ninth = Fraction(1, 9)
    sphere = Clebsch(ninth, ninth, Fraction(0), Fraction(0), ninth, ninth).body()
    still = Impulse(vector(0, "25/16", "-4/7"), vector(0, 0, 0), QUATERNION, vector(1, 2, 3))
    moving = replace(sample_scene(sphere, "attitude", "centre"), initial=still)
    motion = TaylorSolution(moving).motion([Fraction(14000, 1107)], 30)
    assert not any(motion["angular_impulse"].flat)
