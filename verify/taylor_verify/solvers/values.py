"""The exact value of a number in a file, as text or in binary.

Decimals, ``a/b`` and hexadecimal floats become rationals; a binary number is the rational it is.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Sequence
from datetime import datetime
from decimal import Decimal
from fractions import Fraction
from numbers import Rational
from typing import Any, Final

import numpy as np
from mpmath import libmp, mp

from taylor_verify.numbers.precision import held_exactly
from taylor_verify.records.faults import cut
from taylor_verify.scenes.reading.table import (
    LARGEST_EXPONENT,
    MOST_DIGITS,
    exact_number,
    quantity,
)

# A rational, or the NaN or infinity that the file has in its place.
Value = Fraction | float

_HEXADECIMAL = re.compile(
    r"([+-]?)0x(?=[0-9a-f.])([0-9a-f]*)\.?([0-9a-f]*)(?:p([+-]?[0-9]{1,6}))?", re.IGNORECASE
)
# C writes -nan(ind) too.
_NOT_FINITE = re.compile(r"([+-]?(?:nan|inf|infinity))(?:\(\w*\))?", re.IGNORECASE)
# Fortran writes D for an exponent, and leaves the letter out before three digits.
_FORTRAN = re.compile(r"([+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+))(?:d([+-]?[0-9]+)|([+-][0-9]{3}))", re.I)
_DECIMAL_COMMA = re.compile(r"[+-]?[0-9]*,[0-9]+(?:e[+-]?[0-9]+)?", re.IGNORECASE)
_EXPONENT_BITS: Final = int(LARGEST_EXPONENT * math.log2(10))


def exact(raw: object) -> Value:
    """Return the rational that a text or a number is; NaN and infinity as they are.

    Raises ValueError, whose text is what was expected.
    """
    if isinstance(raw, str):
        return _from_text(raw.strip())
    if isinstance(raw, Fraction):
        return raw
    if isinstance(raw, bool | np.bool_):
        raise ValueError("a number")
    if isinstance(raw, float | np.floating):
        if not np.isfinite(raw):
            return float(raw)
        numerator, denominator = raw.as_integer_ratio()
        return Fraction(int(numerator), int(denominator))
    if isinstance(raw, int | np.integer):
        return Fraction(int(raw))
    if isinstance(raw, datetime | np.datetime64):
        raise ValueError("a number, the time since the start (subtract the first date)")
    if isinstance(raw, Decimal):
        return exact_number(raw) if raw.is_finite() else float(raw)
    raise ValueError("a number")


def _from_text(text: str) -> Value:
    if match := _NOT_FINITE.fullmatch(text):
        return float(match[1])
    if match := _HEXADECIMAL.fullmatch(text):
        sign, whole, part, power = match.groups()
        exponent = int(power or 0) - 4 * len(part)
        if abs(exponent) > _EXPONENT_BITS:
            raise ValueError(f"a number with powers of ten up to {LARGEST_EXPONENT}")
        value = int(whole + part, 16) * Fraction(2) ** exponent
        return -value if sign == "-" else value
    try:
        return exact_number(text)
    except ValueError:
        # The patterns below take the square of the length.
        if len(text) > MOST_DIGITS:
            raise
        fortran = _FORTRAN.fullmatch(text)
        if fortran and (fortran[2] or "." in text):
            return exact_number(f"{fortran[1]}e{fortran[2] or fortran[3]}")
        # Sound numbers are many, and are not asked this.
        if _DECIMAL_COMMA.fullmatch(text):
            raise ValueError("a number with a decimal point") from None
        if quantity(text):
            expected = "a number alone (a unit belongs to the name of the column: `wx [deg/s]`)"
            raise ValueError(expected) from None
        raise


def is_number(text: str) -> bool:
    try:
        _from_text(text)
    except ValueError:
        return False
    return True


def named_once(pairs: Sequence[tuple[str, Any]]) -> dict[str, Any]:
    """Return the object of a JSON document; ValueError for a key that it has twice."""
    document = dict(pairs)
    if len(document) < len(pairs):
        (twice, _), *_ = Counter(name for name, _ in pairs).most_common(1)
        raise ValueError(f"the key {cut(repr(twice))} twice")
    return document


def as_mpf(value: Value, bits: int) -> Any:
    """Return a value as an mpf: exact where it has at most so many bits."""
    if not isinstance(value, Fraction):
        return mp.mpf(value)
    if value.denominator & (value.denominator - 1):
        ratio = (value.numerator, value.denominator)
        return mp.make_mpf(libmp.from_rational(*ratio, bits, libmp.round_nearest))
    return held_exactly(value)


def number_as_mpf(value: Any, bits: int) -> Any:
    """Return the mpf equal to a number of Python, NumPy or mpmath; NaN and infinity stay what they are.

    A rational that is no binary fraction is rounded. Raises TypeError for what is no real number.
    """
    if isinstance(value, mp.mpf):
        return value
    if isinstance(value, Rational) and not isinstance(value, bool):
        number: Value = Fraction(int(value.numerator), int(value.denominator))
    elif isinstance(value, np.floating | float):
        number = exact(value)
    else:
        raise TypeError(f"expected real numbers, got {value!r} of type {type(value).__name__}")
    return as_mpf(number, bits)
