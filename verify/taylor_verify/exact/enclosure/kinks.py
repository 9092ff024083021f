"""Absolute values and norms, which have a kink where their operand is zero.

A step keeps to one side of a kink, or it is *flat*: across the kink, and so short that the polynomial of
the node is 0. A sign, and whether a node is flat, belong to one step.

Both functions change by no more than their operands do, and a derivative in [-1, 1] serves where there is
none: sqrt(a^2 + e^2) in place of |a| obeys every bound with e more, has such a derivative, and its motion
tends to the true one with e.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Self

from flint import arb

from taylor_verify.exact.enclosure.operations import (
    ONE,
    ZERO,
    Differential,
    OfOne,
    Operation,
    Part,
    Slope,
)

if TYPE_CHECKING:
    from taylor_verify.exact.enclosure.node_bounds import Bounds
    from taylor_verify.exact.enclosure.series import Series


class Kink(ArithmeticError):
    """The operand of a kink may be zero where a step begins; ``node`` is the place of the kink."""

    def __init__(self, node: int) -> None:
        super().__init__()
        self.node = node


def sign_of(value: arb) -> int:
    """1, -1, or 0 if the ball is the number zero or holds both signs."""
    return 1 if value > 0 else -1 if value < 0 else 0


@dataclass(frozen=True)
class Absolute(OfOne):
    """The absolute value of a: its sign times a."""

    def first(self, i: int, s: Series) -> arb:
        return self._signed(i, s, 0)

    def following(self, i: int, s: Series, k: int) -> arb:
        return self._signed(i, s, k)

    def _signed(self, i: int, s: Series, k: int) -> arb:
        """The coefficient of a with the sign of its first one that is not zero."""
        entry = s.forward[self.a][k]
        if i in s.flat or (i not in s.sign and entry.is_zero()):
            return ZERO
        sign = s.sign.setdefault(i, sign_of(entry))
        if not sign:
            raise Kink(i)
        return sign * entry

    def left_out(self, i: int, b: Bounds) -> arb:
        return b.last(self.a)

    def apart(self, i: int, b: Bounds) -> arb:
        if i in b.series.flat:
            return b.reach(self.a)
        return b.missed[i] + b.beside[self.a] + 2 * b.below_zero(i)

    def slopes(self, i: int, b: Bounds) -> Iterator[Slope]:
        yield ONE, self.a

    def differential(self, i: int, b: Bounds) -> Differential:
        if b.is_on_one_side(i, self.a):
            return Differential([Part(arb(b.series.sign[i]), None, self.a)])
        return Differential([], rough=(self.a,))


@dataclass(frozen=True)
class Sign(OfOne):
    """The sign of a, which is the slope of its absolute value; within 1 of 0 where it may change."""

    def first(self, i: int, s: Series) -> arb:
        return arb(sign_of(s.forward[self.a][0]))

    def following(self, i: int, s: Series, k: int) -> arb:
        return ZERO

    def left_out(self, i: int, b: Bounds) -> arb:
        return ZERO

    def apart(self, i: int, b: Bounds) -> arb:
        return ZERO if b.keeps_from_zero(self.a) else 1 + b.length[i]

    def slopes(self, i: int, b: Bounds) -> Iterator[Slope]:
        yield from ()


@dataclass(frozen=True)
class Norm(Operation):
    """The root of the sum of the squares of some nodes.

    If all but one of them are zero throughout, it is the absolute value of that one. If all are exactly
    zero at the beginning, as for a body that starts from rest, their common power of s is taken out.
    """

    nodes: tuple[int, ...]

    @property
    def operands(self) -> tuple[int, ...]:
        return self.nodes

    def moved(self, places: Sequence[int]) -> Self:
        return replace(self, nodes=tuple(places[a] for a in self.nodes))

    def first(self, i: int, s: Series) -> arb:
        return self._order(i, s, 0)

    def following(self, i: int, s: Series, k: int) -> arb:
        return self._order(i, s, k)

    def _order(self, i: int, s: Series, k: int) -> arb:
        if i in s.flat:
            return ZERO
        begin = s.valuation.get(i)
        if begin is None:
            return self._leading(i, s, k)
        squares = sum((s.square(a, begin, k) for a in self.nodes), ZERO)
        return (squares - s.square(i, begin, k)) / (2 * s.forward[i][begin])

    def _leading(self, i: int, s: Series, k: int) -> arb:
        entries = [s.forward[a][k] for a in self.nodes]
        if all(entry.is_zero() for entry in entries):
            return ZERO
        squared = sum((entry * entry for entry in entries), ZERO)
        if not squared > 0:
            raise Kink(i)
        s.valuation[i] = k
        return squared.sqrt()

    def left_out(self, i: int, b: Bounds) -> arb:
        if i in b.series.flat:
            return ZERO
        if (single := b.series.single.get(i)) is not None:
            return b.last(single)
        return b.tail(i, i) + sum((b.tail(a, a) for a in self.nodes), ZERO)

    def apart(self, i: int, b: Bounds) -> arb:
        if i in b.series.flat:
            return self._root_of(b.reach(a) for a in self.nodes)
        beside = self._root_of(b.beside[a] for a in self.nodes)
        if i in b.series.single:
            return b.missed[i] + beside + 2 * b.below_zero(i)
        return beside if b.missed[i].is_zero() else b.missed[i] / b.least_of_norm(i) + beside

    @staticmethod
    def _root_of(sizes: Iterator[arb]) -> arb:
        return sum((size * size for size in sizes), ZERO).sqrt()

    def slopes(self, i: int, b: Bounds) -> Iterator[Slope]:
        for a in self.nodes:
            yield ONE, a

    def differential(self, i: int, b: Bounds) -> Differential:
        single = b.series.single.get(i)
        if single is not None and b.is_on_one_side(i, single):
            others = tuple(a for a in self.nodes if a != single)
            return Differential([Part(arb(b.series.sign[i]), None, single)], rough=others)
        if i in b.series.flat or single is not None or b.series.valuation.get(i) != 0:
            return Differential([], rough=self.nodes)
        return Differential([Part(ONE, a, a) for a in self.nodes], i, b.least(i))
