"""Closed forms in ball arithmetic (Arb), in which every number carries a proven error bound.

No error is estimated here. A motion is accepted when its balls are narrow enough. A decision (a sign, a
branch) is accepted when the balls exclude the other answer. Until then the precision rises.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import reduce
from itertools import chain
from math import ceil, log2
from typing import Any, Final, final

import numpy as np
from flint import arb, arb_mat, ctx
from mpmath import libmp, mp, mpf

from taylor_verify.exact.solution import Solution, Time, Unsettled
from taylor_verify.numbers.irrational import Undecided, ball
from taylor_verify.numbers.tensors import Matrix
from taylor_verify.scenes.motion import Motion

# Quantity by name; for each time a row of balls, nested as the quantity is shaped.
Enclosure = Mapping[str, Sequence[Any]]

# Bits that a few hundred ball operations lose on a simple orbit.
_FIRST_GUARD_BITS: Final = 40
_ATTEMPTS: Final = 12
# The worst orbits of the tests lose twice the digits asked for. A need for this many times the bits means
# an equality that no precision decides.
_MOST_BITS_PER_BIT: Final = 32
_LEAST_LIMIT: Final = 8192
# A width is reported to two digits, so that only a small upward rounding is needed.
WIDTH_BITS: Final = 64
# Limits of doubles whose squares and quotients are doubles too, and of a narrow ball.
_FAR: Final = 1e140
_NARROW: Final = 2.0**-10


class Undecidable(ArithmeticError):
    """The error for a branch that the balls do not decide at this precision; a higher one may."""


class Enclosed(Solution):
    """A closed form evaluated in balls, with a proven error bound."""

    route = "arb"

    @abstractmethod
    def enclose(self, elapsed: Sequence[Time], bits: int) -> Enclosure:
        """Balls that contain the tracked quantities, computed with ``bits`` bits (already set).

        The times are rational or balls.

        Raises Undecidable if a branch cannot be decided at this precision.
        """

    @final
    def motion(self, elapsed: Sequence[Fraction], digits: int) -> Motion:
        """The midpoints, and the proven relative radius of every row, at most 10^-digits.

        Raises Unsettled when a dozen precisions, each higher than the last, do not suffice.
        """
        target = ceil(digits * log2(10))
        bits, last = target + _FIRST_GUARD_BITS, None
        for _ in range(_ATTEMPTS):
            try:
                motion, widest = self._attempt(elapsed, bits)
            except Undecided as doubt:
                raise Unsettled(str(doubt)) from doubt
            last = motion or last
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

    def _attempt(self, elapsed: Sequence[Fraction], bits: int) -> tuple[Motion | None, mpf]:
        """The motion at one precision, and its widest radius.

        None, and infinite, where a branch is open or a number is not finite.
        """
        try:
            with ctx.workprec(bits):
                return _measured(self.enclose(elapsed, bits), len(elapsed))
        except (Undecidable, ZeroDivisionError):
            return None, mp.inf


def _measured(enclosure: Enclosure, count: int) -> tuple[Motion, mpf]:
    """Midpoints and radii, and the widest one; the radius of a row is that of its widest quantity."""
    flat = {name: _flat(rows, count) for name, rows in enclosure.items()}
    radii = {name: widths(balls, count) for name, (balls, _) in flat.items()}
    numbers, doubles = (
        np.array(radii_of_quantities) for radii_of_quantities in zip(*radii.values(), strict=True)
    )
    row = numbers[doubles.argmax(axis=0), np.arange(count)]
    beyond = np.flatnonzero(np.isnan(doubles).any(axis=0)).tolist()
    for k in beyond:
        row[k] = reduce(max_or_nan, numbers[:, k])
    # The largest double belongs to the largest number; a loop is needed only if some are no doubles.
    candidates = row if beyond or not count else [row[doubles.max(axis=0).argmax()]]
    widest = reduce(max_or_nan, candidates, mpf(0))
    radii_of_quantities = {name: numbers for name, (numbers, _) in radii.items()}
    errors = Converted(flat, radius)
    return Motion(Converted(flat, midpoint), row, radii_of_quantities, errors), widest


def _flat(rows: Sequence[Any], count: int) -> tuple[list[arb], tuple[int, ...]]:
    """The balls of all rows one after the other, and the shape of the whole."""
    flat = rows.tolist() if isinstance(rows, np.ndarray) else rows
    shape = np.array(flat[0], dtype=object).shape if count else ()
    for _ in shape:
        flat = list(chain.from_iterable(flat))
    return list(flat), (count, *shape)


@final
class Converted(Mapping[str, np.ndarray[Any, Any]]):
    """The midpoints of balls, or their radii, in mpmath, by quantity: converted when first asked for."""

    def __init__(
        self,
        balls: Mapping[str, tuple[list[arb], tuple[int, ...]]],
        number: Callable[[arb], mpf],
    ) -> None:
        self._balls: dict[str, Any] = dict(balls)
        self._number = number
        self._numbers: dict[str, np.ndarray[Any, Any]] = {}

    def __getitem__(self, name: str) -> np.ndarray[Any, Any]:
        if name not in self._numbers:
            balls, shape = self._balls[name]
            numbers = np.empty(len(balls), dtype=object)
            numbers[:] = [self._number(b) for b in balls]
            self._numbers[name], self._balls[name] = numbers.reshape(shape), None
        return self._numbers[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._balls)

    def __len__(self) -> int:
        return len(self._balls)

    def __reduce__(self) -> tuple[Any, ...]:
        # A ball of flint cannot be sent to another process.
        return dict, (dict(self),)


def widths(balls: Sequence[arb], count: int) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    """The radius of each of ``count`` rows as by ``width``, and as a double; NaN where it needs more.

    With m the largest midpoint of a row, r = |radii|/m and s = |midpoints|/m >= 1, the radius is at most
    r/(s - r). Some dozen roundings by 2^-52 at most are covered by the last factor; and so is a radius
    that is no double, because one beside it is 10^40 times as much.
    """
    shape = count, len(balls) // max(count, 1)
    # Sorted, so that the axes of a vector may change places: sums of doubles depend on the order.
    radii = np.sort(np.array([float(b.rad()) for b in balls]).reshape(shape))
    middles = np.sort(np.abs(np.array([float(b) for b in balls])).reshape(shape))
    largest = middles.max(axis=1, initial=0.0)
    with np.errstate(all="ignore"):
        shares = radii / largest[:, None]
        r, s = (np.sqrt((x * x).sum(axis=1)) for x in (shares, middles / largest[:, None]))
        bounds = r / (s - r) * (1 + 2.0**-40)
        # Written so that a NaN is outside. A row of exact entries is too: they may be no doubles.
        inside = (1 / _FAR < largest) & (largest < _FAR) & (1 / _FAR < r) & (r < _NARROW)
        inside &= ((shares == 0) | (shares > 1 / _FAR)).all(axis=1)
    outside = np.flatnonzero(~inside).tolist()
    bounds[outside] = 0.0
    mantissas, exponents = np.frexp(bounds)
    parts = zip(np.ldexp(mantissas, 53).astype(np.int64).tolist(), exponents.tolist(), strict=True)
    numbers = np.empty(count, dtype=object)
    numbers[:] = [mp.make_mpf(libmp.from_man_exp(m, e - 53)) for m, e in parts]
    for k in outside:
        numbers[k] = width(balls[k * shape[1] : (k + 1) * shape[1]])
    bounds[outside] = np.nan
    return numbers, bounds


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


def balls_of(times: Iterable[Time]) -> list[arb]:
    """The smallest balls about times; those that are balls as they are."""
    return [ball(t) for t in times]


def balls(vector: Iterable[Fraction]) -> list[arb]:
    return [ball(entry) for entry in vector]


def ball_matrix(matrix: Matrix) -> arb_mat:
    """Return a matrix of rationals in balls."""
    return arb_mat([balls(row) for row in matrix])


def midpoint(value: arb) -> mpf:
    """The midpoint, exactly."""
    return _exactly(value.mid())


def radius(value: arb) -> mpf:
    """The radius, exactly."""
    return _exactly(arb(value.rad()))


def largest_size(value: arb) -> mpf:
    """A bound of the magnitude, exactly."""
    return _exactly(value.abs_upper())


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
