"""Taylor coefficients in balls.

Row k of a series holds the coefficients of order k times h^k, so that the step is s from 0 to 1.
"""

from __future__ import annotations

from typing import Final

from flint import arb, arb_mat, ctx

Rows = list[list[arb]]

# What the last coefficient of a step keeps: it is a last bit of the first one.
_LEAST_BITS: Final = 24


def falling_bits(count: int) -> list[int]:
    """The precision of each of so many coefficients, from the ambient one down.

    A step is so long that the coefficients fall to the last bit of the first one. What is rounded off
    below that bit is in their balls, like every rounding.
    """
    return [_LEAST_BITS + ctx.prec * (count - k) // count for k in range(count)]


def value(series: Rows, s: arb) -> list[arb]:
    """The sum at s, every entry as one product of matrices."""
    powers = [arb(1)]
    for _ in series[1:]:
        powers.append(powers[-1] * s)
    flat = [entry for row in series for entry in row]
    row: list[arb] = (
        arb_mat(1, len(series), powers) * arb_mat(len(series), len(series[0]), flat)
    ).entries()
    return row
