"""The exact motion as decimal text, with a radius that includes the rounding of the digits printed."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np
from mpmath import mp, mpf

from verify.exact.solution import Solution
from verify.scenes.scene import Scene

# The motion is known to this many digits more than are printed, so that printing is what limits.
_SPARE_DIGITS = 3


def document(
    scene: Scene, found: Solution, times: Sequence[tuple[str, Fraction]], digits: int
) -> dict[str, Any]:
    """What `exact --json` prints: a row for each time, given as its text and its exact value.

    ``radius`` bounds the error of every vector and matrix of the row in the Frobenius norm, relative
    to its norm (absolute where that is zero).
    """
    elapsed = [time - scene.clock.start for _, time in times]
    motion = found.motion(elapsed, digits + _SPARE_DIGITS)
    with mp.workdps(digits + 2 * _SPARE_DIGITS):
        # Half a unit in the last of `digits` significant digits, of every entry.
        printing = mpf(10) ** (1 - digits) / 2
        rows = [
            {"t": text}
            | {name: _text(values[k], digits) for name, values in motion.quantities.items()}
            | {"radius": mp.nstr(motion.radius[k] + printing, 2)}
            for k, (text, _) in enumerate(times)
        ]
    return {
        "scene": scene.name,
        "route": found.route,
        "digits": digits,
        "regime": found.regime,
        "rows": rows,
    }


def _text(values: np.ndarray[Any, Any], digits: int) -> Any:
    if values.ndim > 1:
        return [_text(row, digits) for row in values]
    return [mp.nstr(value, digits, strip_zeros=False) if value else "0" for value in values]
