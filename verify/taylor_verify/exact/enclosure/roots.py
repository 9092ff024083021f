"""The zeros of a function along a motion, none missed: those crossed, and those that may be touched.

On each part of the motion the function g and its rate g' are polynomials with bounds. An interval on which
the ball of g excludes zero has none. On one where that of g' excludes zero there is at most one: exactly
one if the signs at the ends differ, and Newton's step in balls, m - g(m)/g', encloses it. All other
intervals are halved, until nothing more is gained. What is left side by side is one cluster: a zero if
g' has one sign all over it and the signs of g on its two sides differ, or else undecided.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction
from functools import reduce
from typing import Final, NamedTuple

from flint import arb, ctx

from taylor_verify.exact.enclosure.along import Part
from taylor_verify.exact.enclosure.kinks import sign_of
from taylor_verify.numbers.irrational import ball

_NEWTON_STEPS: Final = 12
# A step of Newton that leaves more of an interval than this is the last one.
_GAIN: Final = arb("0.75")


class Zero(NamedTuple):
    """A ball of time that holds exactly one zero, crossed; or, undecided, all that may be zeros there."""

    time: arb
    is_crossed: bool


class _Leaf(NamedTuple):
    """An interval, with the signs of g at its ends, 0 where they are not known.

    ``time`` is a ball of all times at which g may be zero, None where there is none. ``slope`` is the
    sign of g' if it has one.
    """

    begin: int
    end: int
    time: arb | None = None
    slope: int = 0


def zeros(
    parts: Iterable[Part], begins_with_zero: bool = False, is_continuous: bool = True
) -> Iterator[Zero]:
    """Yield the zeros of the first function of the parts, whose rate is the second, in order.

    The function may be known to be zero at the very beginning. One that is not continuous may jump from
    part to part, and changes its sign there, too. Where the parts end with an error, it is raised after
    the zeros before it.
    """
    clusters = _Clusters(begins_with_zero, is_continuous)
    end = None
    try:
        for part in parts:
            clusters.begin = clusters.begin or ball(part.begin)
            for k, leaf in enumerate(_Search(part).leaves(Fraction(0), Fraction(1))):
                if not (k or is_continuous):
                    yield from clusters.jump(ball(part.begin), leaf)
                yield from clusters.add(leaf)
    except ArithmeticError as error:
        end = error
    yield from clusters.settled(None)
    if end is not None:
        raise end


class _Clusters:
    """Leaves side by side that may hold zeros, and the sign of the function before them."""

    def __init__(self, begins_with_zero: bool, is_continuous: bool) -> None:
        self._begins_with_zero, self._is_continuous = begins_with_zero, is_continuous
        self._before: int | None = None
        self._leaves: list[_Leaf] = []
        self.begin: arb | None = None

    def jump(self, time: arb, leaf: _Leaf) -> Iterator[Zero]:
        """Yield the zero of a jump between two signs."""
        if not self._leaves and self._before and self._before * leaf.begin < 0:
            self._before = leaf.begin
            yield Zero(time, is_crossed=True)

    def add(self, leaf: _Leaf) -> Iterator[Zero]:
        if leaf.begin:
            yield from self.settled(leaf.begin)
        if leaf.time is not None:
            self._leaves.append(leaf)
        if leaf.end:
            yield from self.settled(leaf.end)
            self._before = leaf.end

    def settled(self, after: int | None) -> Iterator[Zero]:
        """Yield what an open cluster holds, before a sign, or None at the end of the motion."""
        leaves, self._leaves = self._leaves, []
        before = (leaves[0].begin or self._before) if leaves else None
        if not leaves:
            return
        is_simple = len({leaf.slope for leaf in leaves}) == 1 and bool(leaves[0].slope)
        hull = reduce(arb.union, (leaf.time for leaf in leaves if leaf.time is not None))
        if before is None and self._begins_with_zero and is_simple and self.begin is not None:
            yield Zero(self.begin, is_crossed=True)
        elif not (is_simple and before and after):
            yield Zero(hull, is_crossed=False)
        elif before != after:
            yield Zero(hull, is_crossed=True)
        elif not self._is_continuous:
            yield Zero(hull, is_crossed=False)


class _Search:
    """The leaves of one part of the motion."""

    def __init__(self, part: Part) -> None:
        self._part, self._length = part, ball(part.length)
        self._value, self._rate = part.functions[:2]
        self._least = Fraction(1, 2**ctx.prec)

    def leaves(self, low: Fraction, high: Fraction) -> Iterator[_Leaf]:
        """Yield the leaves of an interval of s, in order."""
        middle, radius = (low + high) / 2, ball((high - low) / 2).abs_upper()
        whole = ball(middle) + arb(0, radius)
        at_middle, slope = self._value.over(ball(middle)), self._slope(whole)
        around = at_middle + slope * arb(0, radius)
        if sign := sign_of(around) or sign_of(self._value.over(whole)):
            yield _Leaf(sign, sign)
        elif direction := sign_of(slope):
            yield self._monotone(low, high, direction)
        elif not self._gains(slope * radius, at_middle) or high - low < self._least:
            yield _Leaf(self._sign(low), self._sign(high), self._time(whole))
        else:
            yield from self.leaves(low, middle)
            yield from self.leaves(middle, high)

    @staticmethod
    def _gains(change: arb, at_middle: arb) -> bool:
        """True if halves of an interval may be known better than the value at its middle."""
        return change.is_finite() and not change.abs_upper() <= arb(at_middle.rad())

    def _monotone(self, low: Fraction, high: Fraction, direction: int) -> _Leaf:
        begin, end = self._sign(low), self._sign(high)
        zero = None if begin and begin == end else self._newton(ball(low).union(ball(high)))
        if zero is None and (sign := begin or end):
            return _Leaf(sign, sign)
        whole = ball(low).union(ball(high)) if zero is None else zero
        return _Leaf(begin, end, self._time(whole), direction)

    def _newton(self, whole: arb) -> arb | None:
        """The part of an interval that may hold the zero; None if that is nothing."""
        for _ in range(_NEWTON_STEPS):
            middle = whole.mid()
            step = middle - self._value.over(middle) / self._slope(whole)
            if not step.overlaps(whole):
                return None
            closer: arb = step.intersection(whole)
            gained = arb(closer.rad()) < arb(whole.rad()) * _GAIN
            whole = closer
            if not gained:
                break
        return whole

    def _slope(self, s: arb) -> arb:
        """The rate by s."""
        return self._rate.over(s) * self._length

    def _sign(self, s: Fraction) -> int:
        return sign_of(self._value.over(ball(s)))

    def _time(self, s: arb) -> arb:
        return ball(self._part.begin) + self._length * s
