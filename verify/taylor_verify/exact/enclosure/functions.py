"""Operations that come in pairs, or with a helper: trigonometric and hyperbolic functions, and angles.

The helper of a node is another one of the tape: the cosine of a sine, 1 - v^2 of a hyperbolic tangent, and
the divisor of the derivative of an angle.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar, Self

from flint import arb

from taylor_verify.exact.enclosure.operations import (
    ONE,
    Differential,
    Domain,
    OfOne,
    Operation,
    Part,
    Slope,
)

if TYPE_CHECKING:
    from taylor_verify.exact.enclosure.node_bounds import Bounds
    from taylor_verify.exact.enclosure.series import Series


@dataclass(frozen=True)
class Paired(OfOne):
    """A function of a whose derivative is, but for its sign, the node ``pair``."""

    pair: int
    sign: ClassVar[int] = 1

    @property
    def partners(self) -> tuple[int, ...]:
        return (self.pair,)

    def moved(self, places: Sequence[int]) -> Self:
        return replace(self, a=places[self.a], pair=places[self.pair])

    def following(self, i: int, s: Series, k: int) -> arb:
        return self.sign * s.driven(self.a, self.pair, k) / k

    def differential(self, i: int, b: Bounds) -> Differential:
        return Differential([Part(arb(self.sign), self.pair, self.a)])


class Circular(Paired):
    """Sine or cosine: both errors turn, and do not grow."""

    def left_out(self, i: int, b: Bounds) -> arb:
        own, other = b.weighted_tail(self.a, i), b.weighted_tail(self.a, self.pair)
        return (own * own + other * other).sqrt()

    def apart(self, i: int, b: Bounds) -> arb:
        return b.missed[i] + b.beside[self.a]

    def slopes(self, i: int, b: Bounds) -> Iterator[Slope]:
        # The other of the two may not have its bound yet; it is that of this one.
        yield min(ONE, (b.length[self.pair] + b.beside[i]).abs_upper()), self.a


class Sine(Circular):
    """The sine of a; its pair is the cosine."""

    def first(self, i: int, s: Series) -> arb:
        return s.forward[self.a][0].sin()


class Cosine(Circular):
    """The cosine of a; its pair is the sine."""

    sign = -1

    def first(self, i: int, s: Series) -> arb:
        return s.forward[self.a][0].cos()


class Hyperbolic(Paired):
    """Hyperbolic sine or cosine."""

    def left_out(self, i: int, b: Bounds) -> arb:
        return b.weighted_tail(self.a, i) + b.weighted_tail(self.a, self.pair)

    def apart(self, i: int, b: Bounds) -> arb:
        polynomial = b.missed[i] * (2 * b.change[self.a]).exp()
        return polynomial + b.reach(self.a).cosh() * b.beside[self.a]

    def slopes(self, i: int, b: Bounds) -> Iterator[Slope]:
        yield b.reach(self.a).cosh(), self.a


class HyperbolicSine(Hyperbolic):
    """The hyperbolic sine of a; its pair is the cosine."""

    def first(self, i: int, s: Series) -> arb:
        return s.forward[self.a][0].sinh()


class HyperbolicCosine(Hyperbolic):
    """The hyperbolic cosine of a; its pair is the sine."""

    def first(self, i: int, s: Series) -> arb:
        return s.forward[self.a][0].cosh()


class HyperbolicTangent(Paired):
    """The hyperbolic tangent v of a; its pair is 1 - v^2."""

    def first(self, i: int, s: Series) -> arb:
        return s.forward[self.a][0].tanh()

    def left_out(self, i: int, b: Bounds) -> arb:
        return b.weighted_tail(self.a, self.pair) + b.tail(i, i) * b.change[self.a]

    def apart(self, i: int, b: Bounds) -> arb:
        polynomial = b.missed[i] * ((b.length[i] + 1) * b.change[self.a]).exp()
        return polynomial + b.beside[self.a]

    def slopes(self, i: int, b: Bounds) -> Iterator[Slope]:
        yield ONE, self.a


@dataclass(frozen=True)
class Arctangent(OfOne):
    """The arctangent of a; ``divisor`` is 1 + a^2."""

    divisor: int

    @property
    def operands(self) -> tuple[int, ...]:
        return (self.a, self.divisor)

    def moved(self, places: Sequence[int]) -> Self:
        return replace(self, a=places[self.a], divisor=places[self.divisor])

    def first(self, i: int, s: Series) -> arb:
        return s.forward[self.a][0].atan()

    def following(self, i: int, s: Series, k: int) -> arb:
        a, d = s.forward[self.a], s.forward[self.divisor]
        return (k * a[k] - s.weighted(i, self.divisor, k)) / (k * d[0])

    def left_out(self, i: int, b: Bounds) -> arb:
        squares = b.tail(self.a, self.a) * b.change[i]
        return b.weighted_tail(i, self.divisor) + b.last(self.a) + squares

    def apart(self, i: int, b: Bounds) -> arb:
        return b.missed[i] + b.beside[self.a]

    def slopes(self, i: int, b: Bounds) -> Iterator[Slope]:
        yield ONE, self.a

    def differential(self, i: int, b: Bounds) -> Differential:
        return Differential([Part(ONE, None, self.a)], self.divisor)


@dataclass(frozen=True)
class Angle(Operation):
    """The angle of the point (x, y), atan2(y, x); ``divisor`` is x^2 + y^2."""

    y: int
    x: int
    divisor: int

    @property
    def operands(self) -> tuple[int, ...]:
        return (self.y, self.x, self.divisor)

    def moved(self, places: Sequence[int]) -> Self:
        return replace(self, y=places[self.y], x=places[self.x], divisor=places[self.divisor])

    def first(self, i: int, s: Series) -> arb:
        y, x = s.forward[self.y][0], s.forward[self.x][0]
        if not (x > 0 or y > 0 or y < 0):
            raise Domain("atan2 may be on its branch cut")
        return arb.atan2(y, x)

    def following(self, i: int, s: Series, k: int) -> arb:
        turned = s.driven(self.y, self.x, k) - s.driven(self.x, self.y, k)
        return (turned - s.weighted(i, self.divisor, k)) / (k * s.forward[self.divisor][0])

    def left_out(self, i: int, b: Bounds) -> arb:
        products = b.weighted_tail(self.y, self.x) + b.weighted_tail(self.x, self.y)
        squares = (b.tail(self.y, self.y) + b.tail(self.x, self.x)) * b.change[i]
        return b.weighted_tail(i, self.divisor) + products + squares

    def apart(self, i: int, b: Bounds) -> arb:
        self._require_one_side(b)
        beside = (b.beside[self.x] + b.beside[self.y]) / self._distance(b)
        return b.missed[i] / b.least_of_polynomial(self.divisor) + beside

    def _require_one_side(self, b: Bounds) -> None:
        """Raise StepTooLong unless x is positive in the tube, or y has one sign there."""
        if not (b.series.forward[self.x][0] > 0 and b.keeps_from_zero(self.x)):
            b.least(self.y)

    def _distance(self, b: Bounds) -> arb:
        return b.least(self.divisor).sqrt().lower()

    def slopes(self, i: int, b: Bounds) -> Iterator[Slope]:
        slope = 1 / self._distance(b)
        yield slope, self.y
        yield slope, self.x

    def differential(self, i: int, b: Bounds) -> Differential:
        parts = [Part(ONE, self.x, self.y), Part(-ONE, self.y, self.x)]
        return Differential(parts, self.divisor, b.least(self.divisor))
