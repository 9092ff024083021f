"""A closed form in ball arithmetic (Arb): every number carries a bound of its own error.

Nothing is estimated here. A motion is accepted when the balls are narrow enough, and a decision (a
sign, a branch) when the balls exclude the other answer; until then the precision rises.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from functools import reduce
from math import ceil, log2
from typing import Any, Final, final

import numpy as np
from flint import arb, arb_mat, ctx, fmpq
from mpmath import libmp, mp, mpf

from taylor_verify.exact.solution import Solution, Time, Unsettled
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.tensors import Matrix

# Quantity by name; for each time a row of balls, nested as the quantity is shaped.
Enclosure = Mapping[str, Sequence[Any]]

# What a few hundred ball operations lose on an orbit without difficulties.
_FIRST_GUARD_BITS: Final = 40
_ATTEMPTS: Final = 12
# The worst orbits of the tests lose twice the digits asked for; what would take this many times is
# an equality that no precision decides.
_MOST_BITS_PER_BIT: Final = 32
_LEAST_LIMIT: Final = 8192
# A width is told to two digits: all that it asks for is that its rounding upwards is small.
WIDTH_BITS: Final = 64


class Undecidable(ArithmeticError):
    """Two branches that the balls of one precision do not tell apart; a higher one may."""


class Enclosed(Solution):
    """A closed form evaluated in balls: what it says about its error is proven."""

    route = "arb"

    @abstractmethod
    def enclose(self, elapsed: Sequence[Time], bits: int) -> Enclosure:
        """Balls that contain the tracked quantities, computed with ``bits`` bits (already set).

        The times are rational or balls.

        Raises Undecidable where a branch cannot be told at this precision.
        """

    @final
    def motion(self, elapsed: Sequence[Fraction], digits: int, attempts: int = _ATTEMPTS) -> Motion:
        """The midpoints, and the proven relative radius of every row, at most 10^-digits.

        Raises Unsettled when so many precisions, each higher than the last, do not suffice.
        """
        target = ceil(digits * log2(10))
        bits, last = target + _FIRST_GUARD_BITS, None
        for _ in range(attempts):
            motion = self._attempt(elapsed, bits)
            widest = mp.inf
            if motion is not None:
                last, widest = motion, reduce(max_or_nan, motion.radius, mpf(0))
            missing = int(mp.mag(widest)) + target if mp.isfinite(widest) and widest else 0
            if not mp.isfinite(widest):
                bits = 2 * bits
            elif missing <= 0 and motion is not None:
                return motion
            else:
                bits += missing + _FIRST_GUARD_BITS // 2
            if bits > max(_LEAST_LIMIT, _MOST_BITS_PER_BIT * (target + _FIRST_GUARD_BITS)):
                break
        because = f"the balls of the exact solution do not shrink to {digits} digits"
        raise Unsettled.beside(because, last, digits)

    def _attempt(self, elapsed: Sequence[Fraction], bits: int) -> Motion | None:
        """The motion at one precision; None where a branch is open or a number is not finite."""
        try:
            with ctx.workprec(bits):
                found = self.enclose(elapsed, bits)
                return _motion(found, len(elapsed))
        except (Undecidable, ZeroDivisionError):
            return None


def _motion(found: Enclosure, count: int) -> Motion:
    """Midpoints and radii; the radius of a row is that of its widest quantity."""
    quantities, radii = {}, {}
    widest = [mpf(0)] * count
    for name, rows in found.items():
        balls = np.array(rows, dtype=object)
        quantities[name] = np.frompyfunc(midpoint, 1, 1)(balls)
        widths = [width(list(row.flat)) for row in balls]
        radii[name] = np.array(widths, dtype=object)
        widest = [max_or_nan(w, row) for w, row in zip(widest, widths, strict=True)]
    return Motion(quantities, np.array(widest, dtype=object), radii)


def width(balls: Sequence[arb]) -> mpf:
    """The radius of a vector or matrix, as Motion.radius means it, when its midpoints are the answer.

    The norm of the radii by the least norm that the balls allow, rounded upwards: so the bound is
    relative to the true vector, wherever in the balls that is. Zero where every entry is exact. Infinite
    where the vector may be zero and is not known exactly: not one digit of it is proven.
    """
    with ctx.workprec(WIDTH_BITS):
        square = _square(balls)
        if not square.is_finite():
            return mp.inf
        error = _square([b.rad() for b in balls])
        if error.is_zero():
            return mpf(0)
        return upper((error / square).sqrt()) if square > 0 else mp.inf


def size(balls: Sequence[arb]) -> mpf:
    """Return a bound of the norm, wherever in the balls the vector is."""
    with ctx.workprec(WIDTH_BITS):
        # The lower end of the ball of a square may be below zero, where there is no root.
        return upper(_square(balls).upper().sqrt())


def _square(vector: Sequence[arb]) -> arb:
    """The sum of squares, as one product of matrices: a row is measured at every time.

    Not finite where an entry is not.
    """
    row = arb_mat(1, len(vector), vector)
    return (row * row.transpose())[0, 0]


def max_or_nan(a: mpf, b: mpf) -> mpf:
    """The larger, or NaN if either is (Python's max would lose it)."""
    return max(a, b) if a == a and b == b else mp.nan


# Between rationals, balls and mpmath.


def ball(value: Fraction | int | arb) -> arb:
    """The smallest ball about a rational at the ambient precision; a ball as it is."""
    if isinstance(value, arb):
        return value
    value = Fraction(value)
    return arb(fmpq(value.numerator, value.denominator))


def balls(vector: Iterable[Fraction]) -> list[arb]:
    return [ball(entry) for entry in vector]


def ball_matrix(matrix: Matrix) -> arb_mat:
    """Return a matrix of rationals in balls."""
    return arb_mat([balls(row) for row in matrix])


def midpoint(value: arb) -> mpf:
    """The midpoint, exactly."""
    return _exactly(value.mid())


def upper(value: arb) -> mpf:
    """The upper end, exactly; NaN or infinite where the ball is."""
    return _exactly(value.upper())


def _exactly(point: arb) -> mpf:
    if not point.is_finite():
        return mp.nan if point.is_nan() else mp.inf
    mantissa, exponent = point.man_exp()
    return mp.make_mpf(libmp.from_man_exp(int(mantissa), int(exponent)))


# Decisions.


def sign(value: arb) -> int:
    """+1 or -1, proven; raises Undecidable where the ball contains zero."""
    if value > 0:
        return 1
    if value < 0:
        return -1
    raise Undecidable
