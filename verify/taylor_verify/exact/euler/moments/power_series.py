"""The turn of a frame whose angular velocity is a straight line a + b t, as a power series in balls.

Legend: a and b as in regime. q' = q (0, a + b t)/2 and q(0) = 1 have the entire solution sum q_k t^k with

    (k + 1) q_(k+1) = q_k (0, a)/2 + q_(k-1) (0, b)/2.

|q_k| is at most the coefficient of t^k in exp(|a| t/2 + |b| t^2/4), so that by Cauchy the terms from number
N on are together at most e^(|a| r/2 + |b| r^2/4) (t/r)^N/(1 - t/r) for every r > t. A long interval is
halved; the frame goes on from the middle m with a + b m for a.

Its cost grows with the angle and not with 1/|b|, unlike that of Kummer's functions.
"""

from __future__ import annotations

from fractions import Fraction
from math import ceil, log
from typing import Final, final

from flint import arb, arb_mat, ctx

from taylor_verify.exact.balls import ball, balls
from taylor_verify.exact.euler.moments.regime import Line
from taylor_verify.exact.rotation import conjugate, product
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import floor_log2

# Bounds of |a| t/2 and |b| t^2/4 in one sum. Terms of that sum reach the exponential of both.
_HALF_ANGLE: Final = 32
# Those terms cancel, and their balls grow as much.
_GUARD_BITS: Final = ceil(3 * _HALF_ANGLE / log(2))
# r = 8 t is near the best for some hundred bits.
_RADIUS: Final = 8


@final
class SeriesTurn:
    """The turn since t = 0, at the precision of flint at which this was made."""

    def __init__(self, line: Line) -> None:
        self._line = line
        self._turns: dict[tuple[Fraction, Fraction], list[arb]] = {}

    def quaternion(self, t: Fraction) -> list[arb]:
        """The unit quaternion at the time t, 1 at t = 0."""
        self._line.check_reach(t)
        zero = Fraction(0)
        return self._between(zero, t) if t >= 0 else conjugate(self._between(t, zero))

    def _between(self, begin: Fraction, end: Fraction) -> list[arb]:
        """The turn from one time to a later one, of as many factors as there are sums."""
        key = begin, end
        if key not in self._turns:
            line, span = self._line.restarted(begin), end - begin
            if line.is_short(span, _HALF_ANGLE):
                self._turns[key] = _sum(line, span)
            else:
                middle = _simplest_between(begin, end)
                halves = self._between(begin, middle), self._between(middle, end)
                self._turns[key] = product(*halves)
        return self._turns[key]


def _simplest_between(begin: Fraction, end: Fraction) -> Fraction:
    """A multiple of a power of two, so that the intervals of one time are those of another."""
    unit = Fraction(2) ** floor_log2(end - begin)
    middle = (begin // unit + 1) * unit
    return middle if middle < end else (begin // (unit / 2) + 1) * unit / 2


def _sum(line: Line, span: Fraction) -> list[arb]:
    """The series at t = span, in powers of t/span."""
    with ctx.workprec(ctx.prec + _GUARD_BITS):
        a, b = tensors.scaled(span / 2, line.a), tensors.scaled(span**2 / 2, line.b)
        exponent = _RADIUS * _norm(a) + _RADIUS**2 * _norm(b) / 2
        count = ceil((ctx.prec + float(exponent.upper()) / log(2)) / log(_RADIUS, 2))
        step = arb_mat([*_times(balls(a)), *_times(balls(b))])
        term, before = [arb(1), arb(0), arb(0), arb(0)], [arb(0)] * 4
        total = arb_mat(1, 4, term)
        for k in range(1, count):
            fresh = arb_mat(1, 8, [*term, *before]) * step / k
            total += fresh
            term, before = fresh.entries(), term
        tail = exponent.exp() / arb(_RADIUS) ** count / (1 - 1 / arb(_RADIUS))
        return [entry + arb(0, tail.upper()) for entry in total.entries()]


def _norm(vector: tensors.Vector) -> arb:
    return ball(tensors.dot(vector, vector)).sqrt()


def _times(v: list[arb]) -> list[list[arb]]:
    """The matrix of q -> q (0, v), for rows q."""
    units = ([arb(i == j) for j in range(4)] for i in range(4))
    return [product(unit, [arb(0), *v]) for unit in units]
