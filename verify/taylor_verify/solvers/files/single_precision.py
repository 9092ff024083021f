"""Recognition of float32 numbers by what is written, as binary numbers or as decimals.

A decimal of k digits is the text of a float32 if the float32 nearest to it, rounded to k digits, is that
decimal. A number that has nothing to do with float32 passes by a chance of d/D, where d is the unit of its
last digit and D the distance of neighbouring float32 numbers there. This is 1 for six digits or fewer, at
most 1/6 for nine, and 2e-9 for a double. Where all numbers pass, the chances of the different ones are
multiplied. They are float32 numbers if the product is at most 1e-6. Zeros, small integers and simple
fractions of powers of two are numbers of any precision, and count nothing.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from math import floor, log10
from typing import Any, Final

import numpy as np

from taylor_verify.solvers.files.compact_rows import NO_DIGITS, Floats, is_decimal
from taylor_verify.solvers.files.formats.column import CHUNK
from taylor_verify.solvers.values import exact

Written = tuple[Sequence[Any] | Floats, Floats]
"""The entries of a column as they are written, and the doubles nearest to them."""

# The least sum of the logarithms of chances.
_ENOUGH: Final = 6.0
# Numbers as narrow as this are small integers and simple fractions in any precision.
_TELLING_BITS: Final = 18


def are_single_precision(columns: Iterable[Written]) -> bool:
    """Return True if every finite number of the columns is one of float32, and not by chance.

    The first row is left out: it may be a copy of the scene's own start.
    """
    telling: dict[float, float] = {}
    for written, doubles in columns:
        for first in range(1, len(doubles), CHUNK):
            entries, values = written[first : first + CHUNK], doubles[first : first + CHUNK]
            if not _are_texts_of_float32(entries, values):
                return False
            if sum(telling.values()) < _ENOUGH:
                telling |= dict(_evidence(entries, values))
    return sum(telling.values()) >= _ENOUGH


def _are_texts_of_float32(entries: Sequence[Any] | Floats, values: Floats) -> bool:
    """Return True if each finite number is a float32, rounded to the digits that are written."""
    with np.errstate(over="ignore", invalid="ignore"):
        nearest = values.astype(np.float32).astype(np.float64)
    others = np.flatnonzero(np.isfinite(values) & (nearest != values))
    return all(_is_text_of(float(nearest[k]), entries[k]) for k in others.tolist())


def _is_text_of(number: float, entry: Any) -> bool:
    """Return True if a decimal is this number, rounded to the digits that are written."""
    written = Fraction(_decimal(entry))
    unit = Fraction(10) ** (floor(log10(abs(written))) + 1 - len(_digits(entry)))
    return math.isfinite(number) and abs(written - Fraction(number)) <= unit / 2


def _unit(digits: str, value: float) -> float:
    return float(10.0 ** (floor(log10(abs(value))) + 1 - len(digits)))


def _evidence(entries: Sequence[Any] | Floats, values: Floats) -> Iterator[tuple[float, float]]:
    """Yield the numbers that tell, each with how unlikely it is by chance, in powers of ten."""
    # A number of fewer bits is an integer when scaled to one bit less than is telling.
    mantissas = np.frexp(np.where(np.isfinite(values), values, 0.0))[0]
    for k in np.flatnonzero(mantissas * 2.0 ** (_TELLING_BITS - 1) % 1).tolist():
        value = float(values[k])
        # Zeros at the end may be there for the width of the column.
        unit = _unit(_digits(entries[k]).rstrip("0"), value)
        yield abs(value), max(log10(abs(float(np.spacing(np.float32(value)))) / unit), 0.0)


def _digits(entry: Any) -> str:
    """Return the significant digits of a number as it is written."""
    return NO_DIGITS.sub("", _decimal(entry)).lstrip("0")


def _decimal(entry: Any) -> str:
    """Return a decimal as it is written, or the shortest decimal of a binary number."""
    return entry.strip() if is_decimal(entry) else repr(float(exact(entry)))
