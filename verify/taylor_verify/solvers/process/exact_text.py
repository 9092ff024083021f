"""Exact numbers of the question as texts."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction
from typing import Final

import gmpy2

_PLACES: Final = 30


def exact_text(value: Fraction) -> str:
    """Return the decimal that is exactly this number, or "a/b" where there is none."""
    rest, twos = gmpy2.remove(value.denominator, 2)
    rest, fives = gmpy2.remove(rest, 5)
    if rest != 1:
        # str(int) stops at 4300 digits, and that of a Decimal does not.
        return f"{Decimal(value.numerator)}/{Decimal(value.denominator)}"
    places = max(twos, fives)
    whole = Decimal(int(value * 10**places))
    if places > _PLACES:
        return f"{whole}e-{places}"
    sign, digits, _ = whole.as_tuple()
    return f"{Decimal((sign, digits, -places)):f}"
