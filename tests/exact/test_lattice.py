"""Weierstrass's p in balls, with its periods, inverse and sigma; and real roots of polynomials."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from fractions import Fraction

import pytest
from flint import acb, arb, ctx, fmpq, fmpq_poly
from hypothesis import given
from hypothesis import strategies as st

from taylor_verify.exact.balls import Undecidable
from taylor_verify.exact.lattice import Lattice, lattice
from taylor_verify.exact.real_roots import real_roots
from taylor_verify.numbers.irrational import ball

BITS = 400
# Balls that overlap say nothing unless they are narrow: a quarter of the bits may be lost, half of
# them where the roots are 1e-60 apart or an argument is within rounding of a half period.
NARROW = arb(2) ** -100
TINY = Fraction(1, 10**60)

Invariants = tuple[Fraction, Fraction]


def from_roots(e1: Fraction, e2: Fraction) -> Invariants:
    """4 (X - e1)(X - e2)(X + e1 + e2)."""
    e3 = -e1 - e2
    return -4 * (e1 * e2 + e1 * e3 + e2 * e3), 4 * e1 * e2 * e3


def from_pair(middle: Fraction, square: Fraction) -> Invariants:
    """4 (X + 2c)((X - c)^2 + n^2), from c and n^2."""
    return 12 * middle**2 - 4 * square, -8 * middle * (middle**2 + square)


ONE, FAR = Fraction(1), Fraction(10) ** 12
CASES: dict[str, Invariants] = {
    "three real roots": from_roots(Fraction(3), Fraction(-1, 2)),
    "one real root, positive": from_pair(-ONE, Fraction(2)),
    "one real root, negative": from_pair(ONE, Fraction(1, 3)),
    "square": (Fraction(4), Fraction(0)),
    "diamond": (Fraction(-4), Fraction(0)),
    "hexagon": (Fraction(0), Fraction(4)),
    "hexagon, turned": (Fraction(0), Fraction(-4)),
    "large roots close": from_roots(ONE + TINY, ONE),
    "small roots close": from_roots(-ONE, -ONE - TINY),
    "pair near the real line, right": from_pair(ONE, TINY),
    "pair near the real line, left": from_pair(-ONE, TINY),
    "nearly g3 = 0": (Fraction(4), TINY),
    "nearly g2 = 0": (TINY, ONE),
    "all roots large": from_roots(3 * FAR, -FAR / 2),
    "all roots small": from_pair(1 / FAR, 1 / FAR**2),
    "double root, negative": from_roots(-ONE, -ONE),
    "double root, positive": from_roots(ONE / 7, ONE / 7),
    "triple root": (Fraction(0), Fraction(0)),
}
by_case = pytest.mark.parametrize("invariants", list(CASES.values()), ids=list(CASES))
ELLIPTIC = [name for name, (g2, g3) in CASES.items() if g2**3 != 27 * g3**2]


@contextmanager
def at_work(invariants: Invariants) -> Iterator[tuple[Lattice, arb]]:
    """The lattice, and a length of its size."""
    with ctx.workprec(BITS):
        cell = lattice(*invariants)
        yield cell, scale(invariants)


def scale(invariants: Invariants) -> arb:
    """About a tenth of a period: u^4 g2 and u^6 g3 are dimensionless."""
    g2, g3 = (abs(ball(g)) for g in invariants)
    size = g2.root(4) + g3.root(6)
    return arb(1) / (5 * size) if not size.is_zero() else arb(1)


def points(length: arb) -> list[acb]:
    """Here and there in the plane, real and not."""
    places = [(1, 0), (3, 0), (-2, 0), (0, 2), (1, 1), (2, -1), (-3, 2), (7, 1), (-5, -3)]
    return [acb(length * a, length * b / 2) for a, b in places]


def close(a: acb | arb, b: acb | arb) -> bool:
    """Whether the balls overlap and are narrow beside their size."""
    size = abs(a) + 1
    return bool(acb(a).overlaps(acb(b)) and abs(a).rad() + abs(b).rad() <= NARROW * size)


def same(point: tuple[acb, acb], expected: tuple[acb, acb]) -> bool:
    return all(close(a / b, acb(1)) for a, b in zip(point, expected, strict=True))


# p


@pytest.mark.parametrize("name", ["large roots close", "small roots close"])
def test_a_period_loses_no_bits_to_roots_that_are_close(name: str) -> None:
    """Also where the roots share half of the bits and more."""
    with ctx.workprec(BITS):
        period = lattice(*CASES[name]).period
        assert period is not None
        assert period.rel_accuracy_bits() >= BITS - 16


# The argument


@by_case
def test_the_argument_leads_back_to_its_point(invariants: Invariants) -> None:
    """p and p' at argument(p(u), p'(u)) are those at u, which only periods leave alike."""
    with at_work(invariants) as (cell, length):
        for u in points(length):
            there = cell.p(u)
            point = cell.p(cell.argument(*there))
            assert same(point, there)
            assert not point[1].overlaps(-there[1])


@pytest.mark.parametrize("root", [1, 0, -1])
def test_a_root_is_a_half_period_exactly(root: int) -> None:
    """Y = 0 exactly is met by a half period without the loss of half the digits."""
    with at_work((Fraction(4), Fraction(0))) as (cell, length):
        w = cell.argument(acb(root), acb(0))
        p, slope = cell.p(w)
        assert close(p, acb(root))
        assert close(slope, acb(0))
        value = cell.jet(2 * w, 0)[0]
        assert value.contains(0)
        assert abs(value) <= NARROW * length
        assert not cell.jet(w, 0)[0].contains(0)


@pytest.mark.parametrize("name", ELLIPTIC)
def test_a_half_period_is_told_from_the_others(name: str) -> None:
    """Each half period comes back from (p, 0), also where two of the roots are 1e-60 apart."""
    with at_work(CASES[name]) as (cell, _):
        period = cell.period
        assert period is not None
        X = cell.p(acb(period / 2))[0]
        w = cell.argument(X, acb(0))
        assert any(close(w / period, acb(half) / 2) for half in (-1, 1))


@pytest.mark.parametrize("name", ELLIPTIC)
def test_beside_a_half_period_both_signs_are_covered(name: str) -> None:
    """From a ball of Y that holds zero comes a ball of u that holds both u and -u, up to a period."""
    with at_work(CASES[name]) as (cell, length):
        period = cell.period
        assert period is not None
        u = acb(period / 2 + length * arb(2) ** -300)
        X, Y = cell.p(u)
        blurred = acb(Y.real + arb(0, 2 * abs(Y).upper()), Y.imag)
        argument = cell.argument(X, blurred)
        shifts = [argument - period * k for k in (-1, 0, 1)]
        assert any(shift.contains(u.mid()) for shift in shifts)
        assert any((-shift).contains(u.mid()) for shift in shifts)


# The turn


# The turn


def off_the_line(cell: Lattice, length: arb) -> list[acb]:
    """Arguments that are not real, nearer to the real line than to the next row of periods."""
    places = [acb(length, length / 5), acb(-3 * length, -length / 3), acb(0, length / 2)]
    return [w for w in places if _has_turn(cell, w)]


def _has_turn(cell: Lattice, w: acb) -> bool:
    try:
        cell.turn(arb(0), w, acb(1))
    except Undecidable:
        return False
    return True


def turned(cell: Lattice, u: arb, w: acb) -> arb:
    return cell.turn(u, w, cell.jet(u - w, 0)[0] / cell.jet(-w, 0)[0])


@by_case
def test_the_turn_begins_at_zero_and_is_continuous(invariants: Invariants) -> None:
    """Along a fine line it never jumps, and it is an argument of the quotient all the way."""
    with at_work(invariants) as (cell, length):
        offsets = off_the_line(cell, length)
        assert offsets
        for w in offsets:
            # A step of a fifth of the distance from the zeros turns by less than a fifth radian
            # around each of them, and by as little around the rest together.
            step = abs(w.imag) / 5
            previous = turned(cell, arb(0), w)
            assert close(previous, arb(0))
            for k in range(1, 60):
                u = step * k
                now = turned(cell, u, w)
                assert abs(now - previous) <= 1
                quotient = cell.jet(u - w, 0)[0] / cell.jet(-w, 0)[0]
                assert close((acb(0, 1) * now).exp(), quotient / abs(quotient))
                previous = now


# Real roots

MANY_BITS = 200
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
            value.contains(number)
            and value.rad() <= abs(number) * arb(2) ** (LOST_BITS - MANY_BITS)
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
    with ctx.workprec(MANY_BITS):
        for product in (polynomial(roots), polynomial(roots) * pair * -3):
            enclosed = real_roots(product)
            assert len(enclosed) == len(roots)
            assert all(holds(*both) for both in zip(enclosed, roots, strict=True))


@given(st.sets(numbers, max_size=6))
def test_any_rational_roots_are_enclosed(roots: set[Fraction]) -> None:
    """None is lost and none is added."""
    with ctx.workprec(MANY_BITS):
        enclosed = real_roots(polynomial([*roots]))
        assert len(enclosed) == len(roots)
        assert all(holds(*both) for both in zip(enclosed, sorted(roots), strict=True))
