"""Numbers that are drawn: a share between 0 and 1 becomes a decimal of a stated number of digits.

All but `normal` is computed in decimals, correctly rounded, so that every machine draws the same number.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from decimal import Context, Decimal
from fractions import Fraction
from statistics import NormalDist
from typing import Final

from taylor_verify.numbers.precision import as_decimal

# Digits of what is computed before it is rounded to those that were asked for.
_WORKING: Final = Context(prec=50)
# Shares of 0 and 1, whose normal numbers are infinite, are moved by this and by twice this.
_LEAST: Final = 2.0**-54
# Larger whole numbers have a power of ten.
_WRITTEN_OUT: Final = 10**15
# No part of a longer number, of a text in quotation marks, or of a number that was cut short.
_FRACTION: Final = re.compile(r'(?<![\w"./-])-?\d+/[1-9]\d*(?![\w"/.])')


def uniform(share: float, low: Decimal, high: Decimal) -> Decimal:
    """Return the number at a share of the way from ``low`` to ``high``."""
    width = _WORKING.subtract(high, low)
    return _WORKING.add(low, _WORKING.multiply(Decimal(share), width))


def log_uniform(share: float, low: Decimal, high: Decimal) -> Decimal:
    """Return the number at a share of the way from ``low`` to ``high`` by their logarithms."""
    start, end = _WORKING.ln(low), _WORKING.ln(high)
    return _WORKING.exp(uniform(share, start, end))


def normal(share: float, mean: Decimal, deviation: Decimal) -> Decimal:
    """Return the number below which this share of a normal distribution lies."""
    within = min(max(share, _LEAST), 1 - 2 * _LEAST)
    standard = Decimal(NormalDist().inv_cdf(within))
    return _WORKING.add(mean, _WORKING.multiply(deviation, standard))


def choice(share: float, *values: Decimal) -> Decimal:
    """Return one of the values, each for an equal part of the shares."""
    return values[min(int(share * len(values)), len(values) - 1)]


DISTRIBUTIONS: Final[Mapping[str, Callable[..., Decimal]]] = {
    "uniform": uniform,
    "log_uniform": log_uniform,
    "normal": normal,
    "choice": choice,
}


@dataclass(frozen=True)
class Draw:
    """A number of a distribution; ``digits`` is how many significant digits it is rounded to."""

    kind: str
    parameters: tuple[Decimal, ...]
    digits: int

    def value(self, share: float) -> Decimal:
        """Return the number that belongs to a share between 0 and 1, both included."""
        return rounded(DISTRIBUTIONS[self.kind](share, *self.parameters), self.digits)


@dataclass(frozen=True)
class Grid:
    """A number that takes each of its values in turn."""

    values: tuple[Decimal, ...]


def rounded(value: Decimal, digits: int) -> Decimal:
    """Return a decimal rounded to this many significant digits, without zeros at its end."""
    near = Context(prec=digits).plus(value)
    return Decimal(0) if near == 0 else near.normalize(Context(prec=digits))


def number_text(value: Fraction) -> str:
    """Return a rational as a scene file writes it: a decimal where it has one, else ``"a/b"``."""
    if value.denominator == 1 and abs(value) < _WRITTEN_OUT:
        return str(value.numerator)
    exact = as_decimal(value)
    return f'"{value}"' if exact is None else str(exact).replace("E+", "e")


def with_decimals(text: str) -> str:
    """Return a text whose fractions are decimals where they have one, except those in quotation marks."""
    return _FRACTION.sub(lambda match: number_text(Fraction(match[0])).strip('"'), text)
