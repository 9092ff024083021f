"""How near the exact motion passes the rows of an answer, at whatever time.

Where it passes most of them too far off, no shift of time explains their errors. This asks for one motion
in float64, a search of shifts for many enclosures.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from taylor_verify.judge.errors.shifted import Compared, Floats, Run

# Points between two rows, and on either side of all of them.
_BETWEEN: Final = 2048
_BEYOND: Final = 256
# Rows that are compared with all points at once.
_AT_ONCE: Final = 512


def is_passed_by(compared: Compared, window: float, within: float, most: int) -> bool:
    """Return True if at most so many rows are further than ``within`` from the exact motion.

    The motion is followed from ``window`` before the first row to as long after the last one. ``within`` is
    in the unit of the error. True if the motion cannot be followed in float64.
    """
    along = compared.run.along(_times(compared.run, window))
    if along is None:
        return True
    points, rows = compared.over_scales(along), compared.over_scales(compared.run.answer.quantities)
    if not np.all(np.isfinite(points)):
        return True
    gaps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    # A point of the motion is at most half of a gap from one of its points; its arc is longer than the gap.
    off = _distances(rows, points) - np.max(gaps)
    return int(np.count_nonzero(off > within)) <= most


def _times(run: Run, window: float) -> Floats:
    """Return times since the start in order."""
    elapsed = np.array(sorted(float(t) for t in run.elapsed))
    inner = np.linspace(elapsed[0], elapsed[-1], _BETWEEN)
    outer = np.linspace(0.0, window, _BEYOND + 1)[1:]
    return np.concatenate([elapsed[0] - outer[::-1], inner, elapsed[-1] + outer])


def _distances(rows: Floats, points: Floats) -> Floats:
    """Return the distance of each row from the nearest of the points."""
    squares = np.sum(points**2, axis=1)
    nearest = []
    for first in range(0, len(rows), _AT_ONCE):
        some = rows[first : first + _AT_ONCE]
        apart = np.min(squares - 2 * some @ points.T, axis=1) + np.sum(some**2, axis=1)
        nearest.append(np.sqrt(np.maximum(apart, 0.0)))
    return np.concatenate(nearest)
