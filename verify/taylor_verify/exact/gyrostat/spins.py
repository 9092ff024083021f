"""The steady spins of a gyrostat with a given size of its momentum, and their stability.

Legend: as in pencil; mu = w.G/n, so that w = mu G in a steady spin and (K - mu) G = g. A disturbance of G
in a spin goes as e^{s t} with s^2 = -G.adj(K - mu) G.
"""

from __future__ import annotations

from contextlib import suppress
from fractions import Fraction
from typing import Final, NamedTuple

from flint import arb, ctx, fmpq_poly
from mpmath import mp, mpf

from taylor_verify.exact.balls import Undecidable, balls, midpoint, sign
from taylor_verify.exact.gyrostat.pencil import FreeGyrostat
from taylor_verify.exact.real_roots import polynomial, real_roots, value_of
from taylor_verify.exact.solution import Unsettled
from taylor_verify.numbers import tensors
from taylor_verify.numbers.irrational import ball, rational
from taylor_verify.numbers.rotation import scalar_product
from taylor_verify.numbers.tensors import Matrix, Vector

_GUARD_BITS: Final = 40
_ATTEMPTS: Final = 8


class SteadySpin(NamedTuple):
    """The rate of the spin about G, signed, and s^2 of its disturbances."""

    rate: mpf
    square: mpf


def steady_spins(free: FreeGyrostat) -> list[SteadySpin]:
    """Return the steady spins with this |G|, by their rates; a circle of them counts as none.

    Each number is right to mpmath's precision, and so is each sign: the working precision rises until balls
    are narrow enough. Raises Unsettled where some thousand digits are not enough.
    """
    bits = mp.prec + _GUARD_BITS
    for _ in range(_ATTEMPTS):
        with ctx.workprec(bits), suppress(Undecidable, ZeroDivisionError):
            return sorted(SteadySpin(*map(midpoint, spin)) for spin in _spins(free, mp.prec))
        bits *= 2
    raise Unsettled(f"the steady spins of the gyrostat do not come apart with {bits // 2} bits")


def _spins(free: FreeGyrostat, precision: int) -> list[tuple[arb, arb]]:
    """The spins in balls; raises Undecidable where one of them is too wide.

    Their mu are roots of rational polynomials: how many there are is decided exactly, and which of them are
    at the border of stability, since d|G|^2/d mu = -2 s^2/det(K - mu).
    """
    n, determinant = free.n, polynomial(*_determinant(free))
    images = [polynomial(*row) for row in zip(*_adjugate(free), strict=True)]
    squares = sum((image * image for image in images), fmpq_poly())
    condition = determinant * determinant * rational(n) - squares
    # Where K - mu is singular, but has g among its images, G is free along the axis.
    axial = determinant
    for image in images:
        axial = axial.gcd(image)
    if not free.spin.discriminant:
        double = 1 / free.spin.double_moment
        while axial.degree() > 0 and not axial(rational(double)):
            axial //= polynomial(-double, Fraction(1))
    tangent = axial.gcd(condition // (axial * axial))
    regular = condition
    while (common := regular.gcd(determinant)).degree() > 0:
        regular //= common
    multiple = regular.gcd(regular.derivative())
    simple = regular
    while (common := simple.gcd(multiple)).degree() > 0:
        simple //= common
    spins = [(mu, _regular(free, mu)) for mu in real_roots(simple)]
    for mu in real_roots(axial // tangent):
        spins += _axial(free, mu)
    spins += [(mu, arb(0)) for border in (multiple, tangent) for mu in real_roots(border)]
    N, pace = ball(n).sqrt(), ball(free.cubic.trace)
    if not all(
        _is_narrow(mu, pace, precision) and _is_narrow(square, abs(square), precision)
        for mu, square in spins
    ):
        raise Undecidable
    return [(mu * N, square) for mu, square in spins]


def _is_narrow(value: arb, size: arb, bits: int) -> bool:
    """True if the ball has so many bits of a number of this size; exact zeros have."""
    return bool(value.is_exact() or value.rad() < size.lower() * arb(2) ** -bits)


def _regular(free: FreeGyrostat, mu: arb) -> arb:
    """s^2 of the spin with G = (K - mu)^-1 g."""
    images = [value_of(balls(row), mu) for row in zip(*_adjugate(free), strict=True)]
    determinant = value_of(balls(_determinant(free)), mu)
    return -_adjugate_form(free, mu, [G / determinant for G in images])


def _axial(free: FreeGyrostat, mu: arb) -> list[tuple[arb, arb]]:
    """The two spins with G along the axis of the moment 1/mu, if |G| is large enough for them."""
    g = balls(free.g)
    moved = [
        [entry - mu * (i == j) for j, entry in enumerate(balls(row))]
        for i, row in enumerate(free.K)
    ]
    trace = sum((moved[i][i] for i in range(3)), arb(0))
    pairs = ((0, 1), (1, 2), (2, 0))
    minors = sum((moved[i][i] * moved[j][j] - moved[i][j] ** 2 for i, j in pairs), arb(0))
    # M^2 - (tr M) M + minors = 0 across the axis, where M = K - mu is regular.
    across = [
        (trace * p - scalar_product(row, g)) / minors for p, row in zip(g, moved, strict=True)
    ]
    along = ball(free.n) - scalar_product(across, across)
    return [(mu, -minors * along)] * 2 if sign(along) > 0 else []


def _adjugate_form(free: FreeGyrostat, mu: arb, G: list[arb]) -> arb:
    """G.adj(K - mu) G, with adj(K - mu) = K^2 - S K + c2 - mu (S - K) + mu^2."""

    def form(matrix: Matrix) -> arb:
        return scalar_product(G, [scalar_product(balls(row), G) for row in matrix])

    S, c2 = ball(free.cubic.trace), ball(free.cubic.minors)
    n, first = scalar_product(G, G), form(free.K)
    return form(free.square) - S * first + c2 * n - mu * (S * n - first) + mu**2 * n


def _adjugate(free: FreeGyrostat) -> tuple[Vector, Vector, Vector]:
    """adj(K - mu) g by powers of mu, the constant first."""
    g, Kg = free.g, tensors.apply(free.K, free.g)
    S, c2, _ = free.cubic
    rest = tensors.minus(tensors.scaled(c2, g), tensors.scaled(S, Kg))
    constant = tensors.plus(tensors.apply(free.square, g), rest)
    return constant, tensors.minus(Kg, tensors.scaled(S, g)), g


def _determinant(free: FreeGyrostat) -> tuple[Fraction, ...]:
    """det(K - mu) by powers of mu, the constant first."""
    S, c2, determinant = free.cubic
    return determinant, -c2, S, Fraction(-1)
