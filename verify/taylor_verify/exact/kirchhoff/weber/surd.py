"""A root of a rational quadratic, h + s sqrt(d), held in rationals: its order and signs are exact."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from math import isqrt
from typing import Any


@dataclass(frozen=True)
class Surd:
    """h + s sqrt(d), s = -1, 0 or 1; where d is the square of a rational, s = d = 0.

    So equal numbers are equal Surds.
    """

    h: Fraction
    s: int = 0
    d: Fraction = Fraction(0)

    def form(self, convert: Callable[[Fraction], Any], sqrt: Callable[[Any], Any]) -> Any:
        """The number in the arithmetic of these two functions."""
        rational = convert(self.h)
        return rational + self.s * sqrt(convert(self.d)) if self.s else rational

    def sign(self, slope: Fraction, offset: Fraction) -> int:
        """The sign of slope times this number, plus offset."""
        even, odd = slope * self.h + offset, slope * self.s
        if odd == 0 or even == 0:
            return _sign(even) or _sign(odd)
        if _sign(even) == _sign(odd):
            return _sign(even)
        # Of opposite signs, the larger square decides; they differ, for sqrt(d) is irrational.
        return _sign(even) * _sign(even**2 - odd**2 * self.d)


def roots(square: Fraction, linear: Fraction, constant: Fraction) -> tuple[Surd, Surd]:
    """The two real roots of a quadratic, the smaller first; ValueError where they are not real."""
    h = -linear / (2 * square)
    d = h**2 - constant / square
    if d < 0:
        raise ValueError(f"expected a quadratic with real roots, got the discriminant {d}")
    root = _rational_root(d)
    if root is not None:
        return Surd(h - root), Surd(h + root)
    return Surd(h, -1, d), Surd(h, 1, d)


def compare(a: Surd, b: Surd) -> int:
    """The sign of a - b, for roots of one quadratic or where one of them is rational."""
    if a.s and b.s:
        if (a.h, a.d) != (b.h, b.d):
            raise ValueError(f"expected roots of one quadratic, got {a} and {b}")
        return _sign(Fraction(a.s - b.s))
    return a.sign(Fraction(1), -b.h) if b.s == 0 else -b.sign(Fraction(1), -a.h)


def _rational_root(d: Fraction) -> Fraction | None:
    root = Fraction(isqrt(d.numerator), isqrt(d.denominator))
    return root if root**2 == d else None


def _sign(value: Fraction) -> int:
    return (value > 0) - (value < 0)
