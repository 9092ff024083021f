"""Real roots of polynomials in balls, exact and nearly equal ones."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

import pytest
from flint import arb, ctx, fmpq, fmpq_poly
from hypothesis import given
from hypothesis import strategies as st

from taylor_verify.exact.real_roots import real_roots
from taylor_verify.numbers.irrational import ball

BITS = 200
# Some twenty operations, each of half a last place, on numbers that lose two bits at most.
LOST_BITS = 10
# With so many bits the rounding of the exact numbers below has no part in a comparison.
FINE_BITS = 6000
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
