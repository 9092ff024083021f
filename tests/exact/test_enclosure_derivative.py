"""The derivative that an enclosure carries is that of exact.conditioning, by ways that share nothing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

import pytest
from builders.turns import by_turns
from flint import arb, arb_mat, ctx

from taylor_verify.exact.conditioning.by_differences import derivatives
from taylor_verify.exact.conditioning.momentum import block_units
from taylor_verify.exact.enclosure.box import Box, carried, identity
from taylor_verify.exact.enclosure.course import Course
from taylor_verify.exact.enclosure.loaded import posed
from taylor_verify.numbers.irrational import ball
from taylor_verify.numbers.precision import exact_value
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

BITS = 140
# The start is a box of this half width, so that there is something to carry.
SMALL = Fraction(1, 10**38)
# Differences of 10^-30 units err by less than this part of the largest derivative.
OF_DIFFERENCES = Fraction(1, 10**20)
# Norms are wanted to a digit or two.
OF_NORMS = arb("0.01")

# One scene of every kind, and a time of its own.
BY_DIFFERENCES = {
    "euler/generic": 10,
    "euler/tennis-racket": 12,
    "euler/axisymmetric": 10,
    "euler/full-tensor": 10,
    "euler/moment-oblique": 3,
    "kirchhoff/whole-motion": 5,
    "kirchhoff/weber": 1,
    "kirchhoff/chaplygin": 2,
    "kirchhoff/general-body": 1,
    "extremes/kirchhoff-nearly-clebsch": 3,
}


def enclosed(scene: Scene, times: Sequence[Fraction]) -> list[arb_mat]:
    """The derivatives at the times of the state by its start: products of those of the steps."""
    system, derivatives, pending = posed(scene), [], list(times[::-1])
    with ctx.workprec(BITS):
        start = [ball(value) + arb(0, ball(SMALL).upper()) for value in system.start]
        run = Course.of(system, start, BITS, 10_000)
        box, now, length, total = Box.about(start), Fraction(0), times[-1], identity(system.size)
        while pending:
            step = run.stepper.step(box, now, length, times[-1] - now)
            assert step.flow is not None
            while pending and abs(pending[-1] - now) <= abs(step.length):
                derivatives.append(
                    step.flow.whole(ball((pending.pop() - now) / step.length)) * total
                )
            total = step.flow.whole(arb(1)) * total
            box = carried(box, step.state, step.tube, step.flow, system.spans)
            now, length = now + step.length, 2 * step.length
        return [in_momenta(scene, matrix) for matrix in derivatives]


def in_momenta(scene: Scene, matrix: arb_mat) -> arb_mat:
    """The derivative of H by H for a rigid body, and of the impulses without any clock."""
    size = 3 if scene.model == "euler" else 6
    block = arb_mat([[matrix[i, j] for j in range(size)] for i in range(size)])
    if not isinstance(scene.body, RigidBody):
        return block
    inertia, inverse = in_balls(scene.body.inertia), in_balls(scene.body.inverse_inertia)
    return inertia * block * inverse


def in_balls(matrix: Matrix) -> arb_mat:
    return arb_mat([[ball(entry) for entry in row] for row in matrix])


def in_units(units: Vector, matrix: arb_mat) -> arb_mat:
    """The derivatives between momenta that are counted in these powers of two."""
    n = len(units)
    factors = [[ball(units[j] / units[i]) for j in range(n)] for i in range(n)]
    return arb_mat([[matrix[i, j] * factors[i][j] for j in range(n)] for i in range(n)])


@pytest.mark.parametrize("name", by_turns(BY_DIFFERENCES))
def test_differences_of_the_motion_lie_in_the_enclosed_derivative(name: str) -> None:
    """Each derivative, a difference of exact motions, is in its ball, whose width no norm would notice."""
    scene = replace(load(name), track=frozenset())
    times = [Fraction(BY_DIFFERENCES[name], 3), Fraction(BY_DIFFERENCES[name])]
    differences = derivatives(scene, times, 30, 110)
    for by_steps, sharp in zip(enclosed(scene, times), differences.momentum, strict=True):
        with ctx.workprec(BITS):
            counted = in_units(block_units(scene), by_steps)
            size = max(abs(exact_value(entry)) for entry in sharp.flat)
            slack = ball(size * OF_DIFFERENCES).upper()
            for i, row in enumerate(sharp):
                for j, entry in enumerate(row):
                    assert counted[i, j].overlaps(ball(exact_value(entry)) + arb(0, slack))
                    assert counted[i, j].rad() <= ball(size) * OF_NORMS
