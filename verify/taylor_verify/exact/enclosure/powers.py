"""Quotients, roots and powers, the exponential and the logarithm."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TYPE_CHECKING, Self

from flint import arb

from taylor_verify.exact.enclosure.operations import (
    ONE,
    ZERO,
    Differential,
    Domain,
    OfOne,
    Operation,
    Part,
    Slope,
)
from taylor_verify.numbers.irrational import ball

if TYPE_CHECKING:
    from taylor_verify.exact.enclosure.node_bounds import Bounds
    from taylor_verify.exact.enclosure.series import Series


@dataclass(frozen=True)
class Quotient(Operation):
    """b/a, or 1/a where ``b`` is None."""

    b: int | None
    a: int

    @property
    def operands(self) -> tuple[int, ...]:
        return (self.a,) if self.b is None else (self.b, self.a)

    def moved(self, places: Sequence[int]) -> Self:
        return replace(self, b=None if self.b is None else places[self.b], a=places[self.a])

    def first(self, i: int, s: Series) -> arb:
        divisor = s.forward[self.a][0]
        if not divisor != 0:
            raise Domain("a divisor may be zero")
        return (ONE if self.b is None else s.forward[self.b][0]) / divisor

    def following(self, i: int, s: Series, k: int) -> arb:
        above = ZERO if self.b is None else s.forward[self.b][k]
        return (above - s.rest(self.a, i, k)) / s.forward[self.a][0]

    def left_out(self, i: int, b: Bounds) -> arb:
        return b.tail(self.a, i) + (ZERO if self.b is None else b.last(self.b))

    def apart(self, i: int, b: Bounds) -> arb:
        above = ZERO if self.b is None else b.beside[self.b]
        return (b.missed[i] + above + b.length[i] * b.beside[self.a]) / b.least(self.a)

    def slopes(self, i: int, b: Bounds) -> Iterator[Slope]:
        least = b.least(self.a)
        yield b.reach(i) / least, self.a
        if self.b is not None:
            yield 1 / least, self.b

    def differential(self, i: int, b: Bounds) -> Differential:
        parts = [Part(-ONE, i, self.a)]
        if self.b is not None:
            parts.append(Part(ONE, None, self.b))
        return Differential(parts, self.a, b.least(self.a))


@dataclass(frozen=True)
class Root(OfOne):
    """The square root of a."""

    def first(self, i: int, s: Series) -> arb:
        return s.positive(self.a, "a square root").sqrt()

    def following(self, i: int, s: Series, k: int) -> arb:
        return (s.forward[self.a][k] - s.square(i, 0, k)) / (2 * s.forward[i][0])

    def left_out(self, i: int, b: Bounds) -> arb:
        return b.tail(i, i) + b.last(self.a)

    def apart(self, i: int, b: Bounds) -> arb:
        least, squared = b.least_of_polynomial(i), b.missed[i] + b.beside[self.a]
        b.require(least * least - squared)
        return squared / least

    def slopes(self, i: int, b: Bounds) -> Iterator[Slope]:
        yield 1 / (2 * b.least(i)), self.a

    def differential(self, i: int, b: Bounds) -> Differential:
        return Differential([Part(ONE / 2, None, self.a)], i, b.least(i))


@dataclass(frozen=True)
class Power(OfOne):
    """a to a rational power, for positive a."""

    exponent: Fraction

    def first(self, i: int, s: Series) -> arb:
        return s.positive(self.a, "the base of a power") ** ball(self.exponent)

    def following(self, i: int, s: Series, k: int) -> arb:
        driven = ball(self.exponent) * s.driven(self.a, i, k) - s.weighted(i, self.a, k)
        return driven / (k * s.forward[self.a][0])

    def left_out(self, i: int, b: Bounds) -> arb:
        return b.weighted_tail(i, self.a) + abs(ball(self.exponent)) * b.weighted_tail(self.a, i)

    def apart(self, i: int, b: Bounds) -> arb:
        share = b.missed[i] / (b.least_of_polynomial(self.a) * b.least_of_polynomial(i))
        return b.length[i] * share.expm1() + self._steepest(b) * b.beside[self.a]

    def slopes(self, i: int, b: Bounds) -> Iterator[Slope]:
        yield self._steepest(b), self.a

    def _steepest(self, b: Bounds) -> arb:
        """A bound of |p a^(p - 1)|, which is monotone."""
        power = ball(self.exponent - 1)
        ends = [(end**power).abs_upper() for end in (b.least(self.a), b.reach(self.a))]
        return abs(ball(self.exponent)) * max(ends)

    def differential(self, i: int, b: Bounds) -> Differential:
        return Differential([Part(ball(self.exponent), i, self.a)], self.a, b.least(self.a))


@dataclass(frozen=True)
class Exponential(OfOne):
    """The exponential of a."""

    def first(self, i: int, s: Series) -> arb:
        return s.forward[self.a][0].exp()

    def following(self, i: int, s: Series, k: int) -> arb:
        return s.driven(self.a, i, k) / k

    def left_out(self, i: int, b: Bounds) -> arb:
        return b.weighted_tail(self.a, i)

    def apart(self, i: int, b: Bounds) -> arb:
        polynomial = b.missed[i] * (2 * b.change[self.a]).exp()
        return polynomial + (b.length[i] + polynomial) * b.beside[self.a].expm1()

    def slopes(self, i: int, b: Bounds) -> Iterator[Slope]:
        yield b.reach(i), self.a

    def differential(self, i: int, b: Bounds) -> Differential:
        return Differential([Part(ONE, i, self.a)])


@dataclass(frozen=True)
class Logarithm(OfOne):
    """The natural logarithm of a."""

    def first(self, i: int, s: Series) -> arb:
        return s.positive(self.a, "a logarithm").log()

    def following(self, i: int, s: Series, k: int) -> arb:
        a = s.forward[self.a]
        return (k * a[k] - s.weighted(i, self.a, k)) / (k * a[0])

    def left_out(self, i: int, b: Bounds) -> arb:
        return b.weighted_tail(i, self.a) + b.last(self.a)

    def apart(self, i: int, b: Bounds) -> arb:
        return (b.missed[i] + b.beside[self.a]) / b.least(self.a)

    def slopes(self, i: int, b: Bounds) -> Iterator[Slope]:
        yield 1 / b.least(self.a), self.a

    def differential(self, i: int, b: Bounds) -> Differential:
        return Differential([Part(ONE, None, self.a)], self.a, b.least(self.a))
