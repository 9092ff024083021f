"""A homogeneous ellipsoid without a fluid: rational but for its mass, which only sets the pace.

Legend: semi-axes a, b, c; with k = 1/m and the mass m = density 4 pi a b c/3, which is irrational,

    A = k 1,   B = 0,   C = k C',   C' = diag(5/(b^2 + c^2), 5/(c^2 + a^2), 5/(a^2 + b^2)).

From the same start the body of 1, 0 and C' is at the time k t where this one is at t, centre and all.
So what is exact of C', such as a separatrix, is exact of the ellipsoid, whose coefficients are rounded.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import prod
from typing import Any, Final

from flint import arb
from mpmath import mp

from taylor_verify.exact.balls import ball
from taylor_verify.exact.kirchhoff.reduced import Reduced
from taylor_verify.exact.kirchhoff.solid import solid
from taylor_verify.exact.solution import Number
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import ImmersedBody

_WORDS: Final = "in the time k t, k = 1/mass, less which every coefficient is rational"


def at_own_pace(reduced: Reduced) -> Reduced:
    """Return the motion of an ellipsoid in a vacuum without its mass; every other motion as it is.

    An ellipsoid with two equal semi-axes is of revolution however it is rounded, and stays as well.
    """
    body, _ = solid(reduced.scene)
    shape = body.ellipsoid
    if shape is None or shape.fluid_density or body.axis_of_symmetry is not None:
        return reduced
    a, b, c = (axis * axis for axis in shape.semi_axes)
    rates = tensors.diagonal((5 / (b + c), 5 / (c + a), 5 / (a + b)))
    identity = tensors.diagonal((Fraction(1),) * 3)
    mass = shape.density * Fraction(4, 3) * prod(shape.semi_axes)

    def pace(number: Number) -> Any:
        pi = arb.pi() if number is ball else +mp.pi
        return 1 / (number(mass) * pi)

    light = ImmersedBody(identity, tensors.ZERO_MATRIX, rates)
    return Reduced(replace(reduced.scene, body=light), words=(_WORDS,), pace=pace)
