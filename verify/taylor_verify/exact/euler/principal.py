"""The principal frame of a body with three different moments, in balls.

Legend: J1 > J2 > J3 the principal moments, N = I - t the part of the tensor without trace, with t = tr I/3
the mean moment, and y_i = J_i - t its eigenvalues, the roots of p(y) = y^3 - s y - det N with s = (tr^2 - 3
minors)/3. They are those of exact.spectrum: neither a small moment nor the gap of two nearly equal ones
loses bits.
"""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

from flint import arb, ctx

from taylor_verify.exact.balls import Undecidable, balls
from taylor_verify.exact.euler.regime import FreeSpin
from taylor_verify.numbers import tensors
from taylor_verify.numbers.irrational import ball

Axis = list[arb]  # three components in body axes


class PrincipalBalls(NamedTuple):
    """Balls about J1 > J2 > J3, their unit axes (of either sign), and J1 - J2, J2 - J3, J1 - J3."""

    moments: list[arb]
    axes: list[Axis]
    upper_gap: arb
    lower_gap: arb
    whole_gap: arb


def principal_balls(spin: FreeSpin) -> PrincipalBalls:
    """The frame of a body with three different moments, at the ambient precision of flint.

    Raises Undecidable where the precision does not part an eigenvector from zero.
    """
    if tensors.is_diagonal(spin.inertia):
        return _sorted_frame(tuple(spin.inertia[i][i] for i in range(3)))
    mean, square = spin.trace / 3, spin.cubic.spread / 3
    moments, (high, middle, low), (upper, lower, whole) = spin.cubic.spectrum()
    traceless = tuple(
        tuple(entry - (mean if i == j else 0) for j, entry in enumerate(row))
        for i, row in enumerate(spin.inertia)
    )
    squared = tensors.product(traceless, traceless)
    slopes = (high, upper * whole), (middle, -upper * lower), (low, lower * whole)
    axes = [_eigenvector(traceless, squared, y, slope, square) for y, slope in slopes]
    return PrincipalBalls(moments, axes, upper, lower, whole)


def _sorted_frame(diagonal: tensors.Vector) -> PrincipalBalls:
    """The axes of a diagonal tensor, which are exact."""
    order = sorted(range(3), key=lambda n: diagonal[n], reverse=True)
    J1, J2, J3 = (diagonal[n] for n in order)
    axes = [[arb(int(row == column)) for column in range(3)] for row in order]
    return PrincipalBalls(balls((J1, J2, J3)), axes, *balls((J1 - J2, J2 - J3, J1 - J3)))


def _eigenvector(
    matrix: tensors.Matrix, squared: tensors.Matrix, y: arb, slope: arb, square: Fraction
) -> Axis:
    """A unit eigenvector: the surest column of adj(y - N) = p'(y) e e^T.

    For a matrix N without trace, adj(y - N) = N^2 + y N + (y^2 - s), and ``slope`` is p'(y), the
    product of the gaps. A column whose diagonal entry is not zero is not zero.
    """
    rest = y * y - ball(square)
    adjugate = [
        [ball(squared[i][j]) + y * ball(matrix[i][j]) + (rest if i == j else 0) for j in range(3)]
        for i in range(3)
    ]
    surest = max(range(3), key=lambda i: abs(adjugate[i][i]).lower())
    if 0 in adjugate[surest][surest]:
        raise Undecidable(f"no eigenvector at {ctx.prec} bits")
    length = (adjugate[surest][surest] * slope).sqrt()
    return [row[surest] / length for row in adjugate]
