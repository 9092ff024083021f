"""The principal frame of a body with three different moments, in balls.

Legend: J1 > J2 > J3 the principal moments, p(x) = det(x - I), t = tr I/3 the mean moment, N = I - t
the part of the tensor without trace and y_i = J_i - t its eigenvalues, the roots of the depressed
cubic y^3 - s y - q with s = (tr^2 - 3 minors)/3 and q = det N. The roots are isolated from exact
integer coefficients; gaps are differences of the y_i, the smaller of the two inner ones a quotient
of disc^(1/2), which is exact: the mean moment never cancels, nor do two nearly equal moments.
"""

from __future__ import annotations

from fractions import Fraction
from math import lcm
from typing import Any, NamedTuple

from flint import acb, arb, ctx, fmpz_poly

from taylor_verify.exact.balls import Undecidable, ball, balls
from taylor_verify.exact.euler.regime import FreeSpin
from taylor_verify.scenes import tensors

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

    Raises Undecidable where the precision does not part two moments, or an eigenvector from zero.
    """
    if tensors.is_diagonal(spin.inertia):
        return _sorted_frame(tuple(spin.inertia[i][i] for i in range(3)))
    mean, square = spin.trace / 3, spin.spread / 3
    low, middle, high = _real_roots((-spin.skewness / 27, -square, Fraction(0), Fraction(1)))
    upper, lower, whole = high - middle, middle - low, high - low
    root = ball(spin.discriminant).sqrt()
    # Both are right; which one is narrower depends on which moments are nearly equal.
    if upper.mid() < lower.mid():
        upper = root / (lower * whole)
    else:
        lower = root / (upper * whole)
    J3, J2, J1 = _real_roots((-spin.determinant, spin.minors, -spin.trace, Fraction(1)))
    traceless = tuple(
        tuple(entry - (mean if i == j else 0) for j, entry in enumerate(row))
        for i, row in enumerate(spin.inertia)
    )
    squared = tensors.product(traceless, traceless)
    slopes = (high, upper * whole), (middle, -upper * lower), (low, lower * whole)
    axes = [_eigenvector(traceless, squared, y, slope, square) for y, slope in slopes]
    return PrincipalBalls([J1, J2, J3], axes, upper, lower, whole)


def _sorted_frame(diagonal: tensors.Vector) -> PrincipalBalls:
    """The axes of a diagonal tensor, which are exact."""
    order = sorted(range(3), key=lambda n: diagonal[n], reverse=True)
    J1, J2, J3 = (diagonal[n] for n in order)
    axes = [[arb(int(row == column)) for column in range(3)] for row in order]
    return PrincipalBalls(balls((J1, J2, J3)), axes, *balls((J1 - J2, J2 - J3, J1 - J3)))


def _real_roots(coefficients: tuple[Fraction, ...]) -> list[arb]:
    """The three real and different roots of a cubic, constant term first; smallest root first.

    Isolating balls of about the ambient relative precision, from exact integer coefficients.
    """
    scale = lcm(*(c.denominator for c in coefficients))
    cubic = fmpz_poly([int(c * scale) for c in coefficients])
    # With multiplicities, which flint's type stubs leave out.
    roots_and_counts: list[Any] = list(cubic.complex_roots())
    # The roots of a symmetric tensor are real, and the caller knows that they differ.
    roots = sorted((acb(root).real for root, _ in roots_and_counts), key=lambda root: root.mid())
    if not (len(roots) == 3 and roots[0] < roots[1] < roots[2]):
        raise Undecidable(f"three roots do not part at {ctx.prec} bits")
    return roots


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
