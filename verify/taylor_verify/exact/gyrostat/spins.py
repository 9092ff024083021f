"""Every steady spin of a gyrostat with a given size of its momentum, and what a disturbance of it does.

Legend: as in pencil; mu = w.G/n, so that w = mu G in a steady spin and (K - mu) G = g. A disturbance of G
in a spin goes as e^{s t} with s^2 = -G.adj(K - mu) G.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any, NamedTuple

from flint import ctx, fmpq, fmpq_poly
from mpmath import mp, mpf

from taylor_verify.exact.balls import midpoint
from taylor_verify.exact.gyrostat.pencil import FreeGyrostat
from taylor_verify.scenes import tensors
from taylor_verify.scenes.tensors import Matrix, Vector, cross, dot


class SteadySpin(NamedTuple):
    """The rate of the spin about G, signed, and s^2 of its disturbances."""

    rate: mpf
    square: mpf


def steady_spins(free: FreeGyrostat) -> list[SteadySpin]:
    """Return the steady spins with this |G|, by their rates; a circle of them counts as none.

    Their mu are roots of rational polynomials: how many there are is decided exactly.
    """
    n, determinant = free.n, _polynomial(*_determinant(free))
    images = [_polynomial(*row) for row in zip(*_adjugate(free), strict=True)]
    squares = sum((image * image for image in images), fmpq_poly())
    condition = determinant * determinant * fmpq(n.numerator, n.denominator) - squares
    # Where K - mu is singular, but has g among its images, G is free along the axis.
    axial = determinant
    for image in images:
        axial = axial.gcd(image)
    if free.has_equal_moments:
        double = 1 / free.double_moment
        while axial.degree() > 0 and not axial(fmpq(double.numerator, double.denominator)):
            axial //= _polynomial(-double, Fraction(1))
    tangent = axial.gcd(condition // (axial * axial))
    regular = condition
    while (common := regular.gcd(determinant)).degree() > 0:
        regular //= common
    N = mp.sqrt(mp.convert(n))
    spins = [_regular(free, mu, N) for mu in _real_roots(regular)]
    for mu in _real_roots(axial // tangent):
        spins += _axial(free, mu, N)
    spins += [SteadySpin(mu * N, mpf(0)) for mu in _real_roots(tangent)]
    return sorted(spins)


def _regular(free: FreeGyrostat, mu: mpf, N: mpf) -> SteadySpin:
    """The spin with G = (K - mu)^-1 g."""
    images = [
        _value([mp.convert(c) for c in row], mu) for row in zip(*_adjugate(free), strict=True)
    ]
    determinant = _value([mp.convert(c) for c in _determinant(free)], mu)
    return SteadySpin(mu * N, -_adjugate_form(free, mu, [G / determinant for G in images]))


def _axial(free: FreeGyrostat, mu: mpf, N: mpf) -> list[SteadySpin]:
    """The two spins with G along the axis of the moment 1/mu, if |G| is large enough for them."""
    g = [mp.convert(c) for c in free.g]
    moved = [
        [mp.convert(c) - mu * (i == j) for j, c in enumerate(row)] for i, row in enumerate(free.K)
    ]
    trace = sum(moved[i][i] for i in range(3))
    pairs = ((0, 1), (1, 2), (2, 0))
    minors = sum(moved[i][i] * moved[j][j] - moved[i][j] ** 2 for i, j in pairs)
    # M^2 - (tr M) M + minors = 0 across the axis, where M = K - mu is regular.
    across = [(trace * p - mp.fdot(row, g)) / minors for p, row in zip(g, moved, strict=True)]
    along = mp.convert(free.n) - mp.fdot(across, across)
    return [SteadySpin(mu * N, -minors * along)] * 2 if along > 0 else []


def _adjugate_form(free: FreeGyrostat, mu: mpf, G: list[mpf]) -> mpf:
    """G.adj(K - mu) G, with adj(K - mu) = K^2 - S K + c2 - mu (S - K) + mu^2."""

    def form(matrix: Matrix) -> mpf:
        rows = [[mp.convert(c) for c in row] for row in matrix]
        return mp.fdot(G, [mp.fdot(row, G) for row in rows])

    S, c2 = mp.convert(free.trace), mp.convert(free.minors)
    n, first = mp.fdot(G, G), form(free.K)
    return form(free.square) - S * first + c2 * n - mu * (S * n - first) + mu**2 * n


def _adjugate(free: FreeGyrostat) -> tuple[Vector, Vector, Vector]:
    """adj(K - mu) g by powers of mu, the constant first."""
    g, Kg = free.g, tensors.apply(free.K, free.g)
    S, c2 = free.trace, free.minors
    rest = tensors.minus(tensors.scaled(c2, g), tensors.scaled(S, Kg))
    constant = tensors.plus(tensors.apply(free.square, g), rest)
    return constant, tensors.minus(Kg, tensors.scaled(S, g)), g


def _determinant(free: FreeGyrostat) -> tuple[Fraction, ...]:
    """det(K - mu) by powers of mu, the constant first."""
    k1, k2, k3 = free.K
    return dot(k1, cross(k2, k3)), -free.minors, free.trace, Fraction(-1)


def _value(coefficients: list[mpf], mu: mpf) -> mpf:
    """The polynomial of these coefficients, the constant one first."""
    total = mpf(0)
    for coefficient in reversed(coefficients):
        total = total * mu + coefficient
    return total


def _polynomial(*coefficients: Fraction) -> fmpq_poly:
    """The polynomial of these coefficients, the constant one first."""
    return fmpq_poly([fmpq(c.numerator, c.denominator) for c in coefficients])


def _real_roots(polynomial: fmpq_poly) -> list[mpf]:
    """The distinct real roots, at mpmath's precision."""
    if polynomial.degree() < 1:
        return []
    with ctx.workprec(mp.prec):
        roots: Any = polynomial.numer().complex_roots()
        return [midpoint(root.real) for root, _ in roots if root.imag.is_zero()]
