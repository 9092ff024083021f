"""The digits that a truth needs beside a rung, and the bits that errors are formed in."""

from __future__ import annotations

from math import ceil, log10
from typing import Final

# The error of a truth with this many digits beyond the rung's own is below a thousandth of a unit of
# roundoff, where the narrowest bound is some units.
MORE_DIGITS: Final = 3
# Differences of exactly held numbers lose no more than their leading bits at this precision.
_SPARE_BITS: Final = 96


def truth_digits(bits: int, more: int = MORE_DIGITS) -> int:
    """Return the digits of a truth for a rung of so many bits, ``more`` than the rung's own."""
    return ceil(bits * log10(2)) + more


def working_bits(bits: int) -> int:
    """Return the precision in bits that the errors of an answer on a rung of so many bits are formed in."""
    return bits + _SPARE_BITS
