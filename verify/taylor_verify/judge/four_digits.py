"""Numbers as a record keeps them: in four decimal digits."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Final

import numpy as np

from taylor_verify.records.doubles import Doubles

Floats = np.ndarray[Any, np.dtype[np.float64]]

# Decimal digits of a number that a picture needs.
_DIGITS: Final = 4


def four_digits(values: Iterable[float]) -> Doubles:
    """Return the numbers, each the nearest double to its own first four decimal digits.

    A million numbers are written out once for each of the four digits that occur, not once each.
    """
    exact: Floats = np.asarray(values if isinstance(values, np.ndarray) else list(values), float)
    found = exact.copy()
    with np.errstate(all="ignore"):
        power = np.floor(np.log10(np.abs(exact))) - (_DIGITS - 1)
        counts = exact / 10.0**power
        whole = np.rint(counts)
        # Elsewhere a rounding of the quotient cannot change the digits.
        is_clear = (np.abs(power) < 250) & (np.abs(np.abs(counts - whole) - 0.5) > 1e-6)
    codes = whole[is_clear] + 1j * power[is_clear]
    each, places = np.unique(codes, return_inverse=True)
    texts = [float(f"{int(code.real)}e{int(code.imag)}") for code in each]
    found[is_clear] = np.array(texts, dtype=float)[places]
    others = np.flatnonzero(~is_clear)
    found[others] = [float(f"{value:.{_DIGITS}g}") for value in exact[others].tolist()]
    return Doubles(found)
