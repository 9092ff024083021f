"""The operations that a right-hand side is made of: the series of each, and bounds of what it leaves out.

A node v of a tape is an operation on nodes before it. Within one step, s in [0, 1], its polynomial v_p has
the coefficients v_k. Five questions are asked of each operation:

    first, following    the coefficients v_0 and v_k, k >= 1, from those of the operands
    left_out            tau, a bound of what the products of the series leave out of v_p
    apart               delta >= |v(z) - v_p(s)| for all states z of the tube, from tau and other deltas
    slopes              bounds of |dv/da| for each operand a in the tube
    differential        D1 dv = sum D2 da, which makes the derivatives as polynomials

Proofs. First v_p against f(a_p): the residual r of D1 v' = D2 a' on the polynomials has the orders from
N - 1 on alone, and the linear equation of the error is integrated. For exp it is
(v_p e^-a_p)' = r e^-a_p; for sine and cosine a rotation, so that nothing grows; for powers
(log v_p/f(a_p))' = r/(a_p v_p). Then f(a_p) against f(a): the mean value theorem with |f'| on the tube.
|a| and the norm are Lipschitz, without any division.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple, Self

from flint import arb, ctx

from taylor_verify.numbers.irrational import ball
from taylor_verify.numbers.precision import floor_log2

if TYPE_CHECKING:
    from taylor_verify.exact.enclosure.node_bounds import Bounds
    from taylor_verify.exact.enclosure.series import Series

ZERO, ONE = arb(0), arb(1)
Slope = tuple[arb, int]


class Domain(ArithmeticError):
    """A function that has no value, or no derivative, at the point from which a step begins.

    ``node`` is its place on the tape, if that is known.
    """

    node: int | None = None


class Part(NamedTuple):
    """A term factor D2 da of a differential; ``node`` is D2, or 1 if it is None."""

    factor: arb
    node: int | None
    operand: int


class Differential(NamedTuple):
    """D1 dv = sum of the parts; ``divisor`` is D1, and ``least`` a lower bound of its size in the tube.

    Of the operands in ``rough`` it is only known that |dv/da| <= 1.
    """

    parts: Sequence[Part]
    divisor: int | None = None
    least: arb = ONE
    rough: tuple[int, ...] = ()


class Operation:
    """The base class of operations; ``operands`` are places of nodes."""

    @property
    def operands(self) -> tuple[int, ...]:
        """The nodes whose coefficients of the same order come first."""
        return ()

    @property
    def partners(self) -> tuple[int, ...]:
        """Nodes that must be there too, before this one or behind it."""
        return ()

    def degree(self, of_operands: Sequence[int | None]) -> int | None:
        """The degree as a polynomial of the time; None if it is none, or depends on the state."""
        return 0 if all(degree == 0 for degree in of_operands) else None

    def moved(self, places: Sequence[int]) -> Self:
        """This operation on nodes that stand at other places."""
        del places
        return self

    def first(self, i: int, s: Series) -> arb:
        raise NotImplementedError

    def following(self, i: int, s: Series, k: int) -> arb:
        raise NotImplementedError

    def left_out(self, i: int, b: Bounds) -> arb:
        raise NotImplementedError

    def apart(self, i: int, b: Bounds) -> arb:
        raise NotImplementedError

    def slopes(self, i: int, b: Bounds) -> Iterator[Slope]:
        raise NotImplementedError

    def differential(self, i: int, b: Bounds) -> Differential:
        raise NotImplementedError


# What has no operands.


@dataclass(frozen=True)
class State(Operation):
    """A component of the state: its orders follow from its rate."""

    component: int

    def degree(self, of_operands: Sequence[int | None]) -> int | None:
        return None


@dataclass(frozen=True)
class Time(Operation):
    """The elapsed time, whose value at the beginning of a step is exact."""

    def degree(self, of_operands: Sequence[int | None]) -> int | None:
        return 1

    def first(self, i: int, s: Series) -> arb:
        return ball(s.begin)

    def following(self, i: int, s: Series, k: int) -> arb:
        return s.length if k == 1 else ZERO


@dataclass(frozen=True)
class Polynomial(Operation):
    """A polynomial of the elapsed time less ``knot``, its coefficient of order 0 first."""

    knot: Fraction
    coefficients: tuple[Fraction, ...]

    def degree(self, of_operands: Sequence[int | None]) -> int | None:
        return len(self.coefficients) - 1

    def first(self, i: int, s: Series) -> arb:
        value = self._derivative(s.begin, 0)
        # A sine loses the bits of its argument before the point.
        with ctx.workprec(ctx.prec + (max(0, floor_log2(value)) if value else 0)):
            return ball(value)

    def following(self, i: int, s: Series, k: int) -> arb:
        return ball(self._derivative(s.begin, k)) * s.length**k

    def _derivative(self, time: Fraction, k: int) -> Fraction:
        """The derivative of order k at a time, over k!."""
        total, binomial = Fraction(0), 1
        for j in range(k, len(self.coefficients)):
            total += self.coefficients[j] * binomial * (time - self.knot) ** (j - k)
            binomial = binomial * (j + 1) // (j + 1 - k)
        return total


# Sums of products.


@dataclass(frozen=True)
class Bilinear(Operation):
    """constant + sum of factor a b + sum of factor e, with exact numbers as factors."""

    constant: Any
    products: tuple[tuple[Any, int, int], ...] = ()
    sums: tuple[tuple[Any, int], ...] = ()

    @property
    def operands(self) -> tuple[int, ...]:
        pairs = [place for _, a, b in self.products for place in (a, b)]
        return (*pairs, *(e for _, e in self.sums))

    def moved(self, places: Sequence[int]) -> Self:
        return replace(
            self,
            products=tuple((c, places[a], places[b]) for c, a, b in self.products),
            sums=tuple((d, places[e]) for d, e in self.sums),
        )

    def degree(self, of_operands: Sequence[int | None]) -> int | None:
        degrees = [degree for degree in of_operands if degree is not None]
        if len(degrees) < len(of_operands):
            return None
        count = 2 * len(self.products)
        pairs = zip(degrees[:count:2], degrees[1:count:2], strict=True)
        return max([0, *(a + b for a, b in pairs), *degrees[count:]])

    def first(self, i: int, s: Series) -> arb:
        factors = s.factors(i)
        return factors.constant + self._sum(factors, s, 0)

    def following(self, i: int, s: Series, k: int) -> arb:
        return self._sum(s.factors(i), s, k)

    def _sum(self, factors: Factors, s: Series, k: int) -> arb:
        total = ZERO
        for factor, a, b in factors.products:
            product = s.product(a, b, k)
            total += product if factor is None else factor * product
        for factor, e in factors.sums:
            entry = s.forward[e][k]
            total += entry if factor is None else factor * entry
        return total

    def left_out(self, i: int, b: Bounds) -> arb:
        sizes = b.factors(i)
        products = [size * b.tail(p, q) for size, p, q in sizes.products]
        return sum((size * b.last(e) for size, e in sizes.sums), sum(products, ZERO))

    def apart(self, i: int, b: Bounds) -> arb:
        sizes, total = b.factors(i), b.missed[i]
        for size, p, q in sizes.products:
            total += size * (b.length[p] * b.beside[q] + b.beside[p] * b.reach(q))
        for size, e in sizes.sums:
            total += size * b.beside[e]
        return total

    def slopes(self, i: int, b: Bounds) -> Iterator[Slope]:
        sizes = b.factors(i)
        for size, p, q in sizes.products:
            yield size * b.reach(p), q
            yield size * b.reach(q), p
        for size, e in sizes.sums:
            yield size, e

    def differential(self, i: int, b: Bounds) -> Differential:
        factors = b.series.factors(i)
        parts = [
            part
            for factor, p, q in factors.products
            for part in (Part(factor or ONE, p, q), Part(factor or ONE, q, p))
        ]
        return Differential([*parts, *(Part(factor or ONE, None, e) for factor, e in factors.sums)])


class Factors(NamedTuple):
    """A bilinear operation with its exact numbers in balls; None for a factor 1."""

    constant: arb
    products: tuple[tuple[Any, int, int], ...]
    sums: tuple[tuple[Any, int], ...]


# Functions of one node. Each returns a value only where its derivative exists.


@dataclass(frozen=True)
class OfOne(Operation):
    """A function of the node ``a``."""

    a: int

    @property
    def operands(self) -> tuple[int, ...]:
        return (self.a,)

    def moved(self, places: Sequence[int]) -> Self:
        return replace(self, a=places[self.a])
