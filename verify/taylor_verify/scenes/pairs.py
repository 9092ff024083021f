"""Arrays of balls whose midpoints are sums of two doubles: ball arithmetic for many bodies at once.

A number is hi + lo with |lo| at most half a unit in the last place of hi, and lies within ``rad`` of
the true one. Sums and products of doubles are exact as such pairs (Knuth's TwoSum, Dekker's
product). The operations on pairs have proven relative errors below 16 u^2, u = 2^-53 (Joldes, Muller,
Popescu, ACM TOMS 44, 2017: 3 u^2 for the sum, 7 u^2 for the product, 15 u^2 for the quotient,
25/8 u^2 for the root). Radii are sums and products of numbers that are not negative. Their own
roundings are small, and `radius` allows for them.

FLINT has no arrays of balls. One of its operations, called from Python, costs as much as a hundred of
these.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final, final

import numpy as np

Floats = np.ndarray[Any, np.dtype[np.float64]]

_SPLITTER: Final = 2.0**27 + 1
_UNIT: Final = 2.0**-53
# Above the relative error of every operation.
_ROUNDING: Final = 2.0**-102
# Above the error of a product that is below the normal numbers.
_LEAST: Final = 2.0**-960
# Radii are made by fewer than 2^20 operations, each of which is a rounding of 2^-53.
_RADII: Final = 1 + 2.0**-30


def two_sum(a: Any, b: Any) -> tuple[Any, Any]:
    """Return the rounded sum and its error."""
    total = a + b
    other = total - a
    return total, (a - (total - other)) + (b - other)


def two_product(a: Any, b: Any) -> tuple[Any, Any]:
    """Return the rounded product and its error, of numbers between 2^-480 and 2^480."""
    product = a * b
    wide = _SPLITTER * a
    a_high = wide - (wide - a)
    a_low = a - a_high
    wide = _SPLITTER * b
    b_high = wide - (wide - b)
    b_low = b - b_high
    error = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low
    return product, error


def _ordered_sum(a: Any, b: Any) -> tuple[Any, Any]:
    """Return the rounded sum and its error, for |a| >= |b|."""
    total = a + b
    return total, b - (total - a)


@final
class Pairs:
    """An array of balls; operations broadcast as NumPy's do, and take doubles as exact numbers."""

    __slots__ = ("hi", "lo", "rad")
    # NumPy's arrays leave the operations to this class.
    __array_ufunc__ = None

    def __init__(self, hi: Any, lo: Any = 0.0, rad: Any = 0.0) -> None:
        self.hi, self.lo, self.rad = hi, lo, rad

    def radius(self) -> Floats:
        """Return a bound of the error of hi + lo; infinite where nothing is known."""
        radius: Floats = np.broadcast_to(self.rad * _RADII, np.shape(self.hi))
        return np.where(np.isfinite(self.hi) & (radius >= 0), radius, np.inf)

    def widened(self, error: Any) -> Pairs:
        """Return the balls with a further error."""
        return Pairs(self.hi, self.lo, self.rad + error)

    def __iter__(self) -> Iterator[Any]:
        """The parts hi, lo, rad."""
        return iter((self.hi, self.lo, self.rad))

    def __getitem__(self, places: Any) -> Pairs:
        parts = (np.broadcast_to(p, np.shape(self.hi))[places] for p in (self.lo, self.rad))
        return Pairs(self.hi[places], *parts)

    def chosen(self, condition: Any, other: Pairs) -> Pairs:
        """Return these balls where the condition holds, and the other ones elsewhere."""
        pairs = ((self.hi, other.hi), (self.lo, other.lo), (self.rad, other.rad))
        return Pairs(*(np.where(condition, one, two) for one, two in pairs))

    def __neg__(self) -> Pairs:
        return Pairs(-self.hi, -self.lo, self.rad)

    def __add__(self, other: Any) -> Pairs:
        if not isinstance(other, Pairs):
            high, error = two_sum(self.hi, other)
            hi, lo = _ordered_sum(high, error + self.lo)
            return Pairs(hi, lo, self.rad + _ROUNDING * abs(hi))
        high, error = two_sum(self.hi, other.hi)
        low, rest = two_sum(self.lo, other.lo)
        high, error = _ordered_sum(high, error + low)
        hi, lo = _ordered_sum(high, error + rest)
        return Pairs(hi, lo, self.rad + other.rad + _ROUNDING * abs(hi))

    __radd__ = __add__

    def __sub__(self, other: Any) -> Pairs:
        return self.__add__(-other)

    def __rsub__(self, other: Any) -> Pairs:
        return self.__neg__().__add__(other)

    def __mul__(self, other: Any) -> Pairs:
        if not isinstance(other, Pairs):
            high, error = two_product(self.hi, other)
            hi, lo = _ordered_sum(high, error + self.lo * other)
            return Pairs(hi, lo, abs(other) * self.rad + (_ROUNDING * abs(hi) + _LEAST))
        high, error = two_product(self.hi, other.hi)
        hi, lo = _ordered_sum(high, error + (self.hi * other.lo + self.lo * other.hi))
        rad = abs(self.hi) * other.rad + (abs(other.hi) + other.rad) * self.rad
        return Pairs(hi, lo, rad + (_ROUNDING * abs(hi) + _LEAST))

    __rmul__ = __mul__

    def scaled(self, power: Any) -> Pairs:
        """Return these numbers times a power of two, exactly."""
        return Pairs(self.hi * power, self.lo * power, self.rad * abs(power))

    def __truediv__(self, other: Any) -> Pairs:
        if not isinstance(other, Pairs):
            other = Pairs(other)
        first = self.hi / other.hi
        rest = self - Pairs(other.hi, other.lo) * first
        hi, lo = _ordered_sum(first, rest.hi / other.hi)
        room = abs(other.hi) * (1 - 4 * _UNIT) - other.rad
        rad = np.where(room > 0, (self.rad + abs(hi) * other.rad) / room, np.inf)
        return Pairs(hi, lo, rad + (_ROUNDING * abs(hi) + _LEAST))

    def __rtruediv__(self, other: Any) -> Pairs:
        return Pairs(np.broadcast_to(np.float64(other), np.shape(self.hi))) / self

    def sqrt(self) -> Pairs:
        """Return the square roots of positive numbers; infinite radii where one may be none."""
        root = np.sqrt(self.hi)
        square, error = two_product(root, root)
        hi, lo = _ordered_sum(root, (((self.hi - square) - error) + self.lo) / (2 * root))
        rad = np.where(self.hi > 2 * self.rad, self.rad / root * (1 + 8 * _UNIT), np.inf)
        return Pairs(hi, lo, rad + (_ROUNDING * abs(hi) + _LEAST))


def difference(a: Any, b: Any) -> Pairs:
    """Return the difference of doubles, exactly."""
    return Pairs(*two_sum(a, -b))


def product(a: Any, b: Any) -> Pairs:
    """Return the product of doubles, exactly."""
    return Pairs(*two_product(a, b), _LEAST)
