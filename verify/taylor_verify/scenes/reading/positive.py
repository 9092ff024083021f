"""The positive finite number that a caller gives: a tolerance, a target, a step."""

from __future__ import annotations

from decimal import Decimal
from math import isfinite
from numbers import Real
from typing import Any

from taylor_verify.records.faults import brief


def positive(value: Any, place: str, what: str = "a positive number") -> float:
    """Return the number as a double.

    Raises ValueError for text, for a truth value, and for a number that is zero, negative, not finite,
    or that no double holds.
    """
    is_number = isinstance(value, Real | Decimal) and not isinstance(value, bool)
    try:
        number = float(value) if is_number else 0.0
    except (OverflowError, ValueError):
        number = 0.0
    if not (number > 0 and isfinite(number)):
        raise ValueError(f"expected {what}, got {brief(value)} @ {place}")
    return number
