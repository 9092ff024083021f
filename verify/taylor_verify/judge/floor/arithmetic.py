"""The digits of a truth and the working precision of errors, for a rung."""

from __future__ import annotations

from math import ceil, log10
from typing import Final

# With this many digits more than the rung, the error of a truth is below a thousandth of a unit of
# roundoff; the narrowest bound is some units.
MORE_DIGITS: Final = 3
# At this precision differences of exactly stored numbers lose only leading bits.
_SPARE_BITS: Final = 96


def truth_digits(bits: int, more: int = MORE_DIGITS) -> int:
    """Return the digits of a truth for a rung of ``bits`` bits: ``more`` than the rung has."""
    return ceil(bits * log10(2)) + more


def working_bits(bits: int) -> int:
    """Return the precision in bits for computing the errors of an answer on a rung of ``bits`` bits."""
    return bits + _SPARE_BITS
