"""The shortest decimals that explain an answer as well as the numbers that were fitted."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from taylor_verify.judge.causes.flow import Floats

_DIGITS: Final = (2, 3, 4, 6)
# A number so small beside the scale of its family is none.
_NOTHING: Final = 1e-8


def shortened(
    numbers: Floats, scale: Floats, worst: float, leaves: Callable[[Floats], float]
) -> Floats:
    """Return the numbers with the fewest digits that leave at most ``worst``; else as they are."""
    large = np.where(np.abs(numbers) > _NOTHING * scale, numbers, 0.0)
    for digits in _DIGITS:
        short = np.array([float(f"{number:.{digits}g}") for number in large])
        if leaves(short) <= worst:
            return short
    return numbers
