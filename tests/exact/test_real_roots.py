"""Roots in balls, exact and nearly equal ones: of polynomials, of symmetric matrices and of lattices."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

import pytest
from flint import arb, ctx, fmpq, fmpq_poly
from hypothesis import given
from hypothesis import strategies as st

from taylor_verify.exact.lattice import Periods, lattice
from taylor_verify.exact.real_roots import real_roots
from taylor_verify.numbers.irrational import ball

BITS = 200
# Some twenty operations, each of half a last place, on numbers that lose two bits at most.
LOST_BITS = 10
# With so many bits the rounding of the exact numbers below has no part in a comparison.
FINE_BITS = 6000
TINY = Fraction(1, 10**300)
# Roots of polynomials take seconds where they agree to hundreds of digits.
CLOSE = Fraction(1, 10**50)
HUGE = Fraction(10**200)

numbers = st.fractions(-(10**6), 10**6, max_denominator=10**6)


def polynomial(roots: Sequence[Fraction]) -> fmpq_poly:
    product = fmpq_poly([1])
    for root in roots:
        product *= fmpq_poly([fmpq(-root.numerator, root.denominator), 1])
    return product


def holds(value: arb, exact: Fraction) -> bool:
    """Return True if a ball contains a number and is narrow beside it; only an exact zero is narrow."""
    with ctx.workprec(FINE_BITS):
        number = ball(exact)
        return bool(
            value.contains(number) and value.rad() <= abs(number) * arb(2) ** (LOST_BITS - BITS)
        )


@pytest.mark.parametrize(
    "roots",
    [
        [],
        [Fraction(0)],
        [-CLOSE, Fraction(0), CLOSE],
        [1 - CLOSE, Fraction(1), 1 + CLOSE, 2 - CLOSE**2, Fraction(2), 3 + CLOSE],
        [-HUGE, Fraction(-1, 3), CLOSE, Fraction(2, 7), HUGE],
        [Fraction(k) for k in range(-3, 4)],
    ],
)
def test_roots_that_nearly_agree_come_apart(roots: list[Fraction]) -> None:
    """Each is in its own narrow ball, in ascending order, and a pair of complex roots is none."""
    pair = fmpq_poly([fmpq(1, 10**60), 0, 1])
    with ctx.workprec(BITS):
        for product in (polynomial(roots), polynomial(roots) * pair * -3):
            enclosed = real_roots(product)
            assert len(enclosed) == len(roots)
            assert all(holds(*both) for both in zip(enclosed, roots, strict=True))


@given(st.sets(numbers, max_size=6))
def test_any_rational_roots_are_enclosed(roots: set[Fraction]) -> None:
    """None is lost and none is added."""
    with ctx.workprec(BITS):
        enclosed = real_roots(polynomial([*roots]))
        assert len(enclosed) == len(roots)
        assert all(holds(*both) for both in zip(enclosed, sorted(roots), strict=True))


SPECTRA = [
    (3, 2, 1),
    (1, Fraction(1, 2), 0),
    (1, 0, -1),
    (0, -1, -2),
    (1 + TINY, 1, 1 - TINY),
    (2, 1 + TINY, 1),
    (2, 2 - TINY, TINY),
    (1, 2 * TINY, TINY),
    (TINY, -TINY, -1),
    (1, TINY, -1 + TINY),
    (HUGE, 1, TINY),
]


@pytest.mark.parametrize("values", SPECTRA)
def test_three_real_roots_of_a_lattice_are_narrow(values: tuple[Fraction, ...]) -> None:
    """4 (X - e1)(X - e2)(X - e3), however nearly two of them agree or one vanishes."""
    mean = sum(map(Fraction, values), Fraction(0)) / 3
    e1, e2, e3 = (value - mean for value in values)
    with ctx.workprec(BITS):
        cell = lattice(-4 * (e1 * e2 + e2 * e3 + e3 * e1), 4 * e1 * e2 * e3)
        assert isinstance(cell, Periods)
        roots = [root.real for root in cell._roots]
        assert all(holds(*both) for both in zip(roots, (e1, e2, e3), strict=True))


@pytest.mark.parametrize("e", [Fraction(1), Fraction(-1), TINY, -HUGE, Fraction(0)])
@pytest.mark.parametrize("b", [Fraction(1), TINY, HUGE])
def test_one_real_root_and_a_pair_of_a_lattice_are_narrow(e: Fraction, b: Fraction) -> None:
    """4 (X - e)((X + e/2)^2 + b^2), whichever of e and b is the larger."""
    with ctx.workprec(BITS):
        cell = lattice(3 * e**2 - 4 * b**2, 4 * e * (e**2 / 4 + b**2))
        assert isinstance(cell, Periods)
        real, above, below = cell._roots
        assert holds(real.real, e)
        for root, side in ((above, 1), (below, -1)):
            assert holds(root.real, -e / 2)
            assert holds(root.imag, side * b)
