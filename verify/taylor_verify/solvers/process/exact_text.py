"""Exact numbers of the question, as texts and as hexadecimal floats."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction
from typing import Any, Final

import gmpy2

from taylor_verify.numbers.precision import Rung, hexadecimal

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


def exact_number(value: Any, rung: Rung) -> dict[str, Any]:
    """Return a number, a vector or a matrix as the protocol has it: its exact ``text``, and its ``hex``.

    It is rounded to the bits of the rung, whatever the exponent: the scene's own units may be far from one.
    """
    if isinstance(value, Fraction):
        rounded = Rung(rung.name, rung.bits).round(value)
        return {"text": exact_text(value), "hex": hexadecimal(rounded)}
    entries = [exact_number(entry, rung) for entry in value]
    return {kind: [entry[kind] for entry in entries] for kind in ("text", "hex")}
