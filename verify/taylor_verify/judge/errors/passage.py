"""The exact motion beside the rows of an answer: how near it passes them, at whatever time.

Where it passes most of them too far off, no shift of time explains their errors. This asks for one motion
in float64, a search of shifts for many.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np

from taylor_verify.judge.errors.shifted import Compared, Floats, Run

# Points between the first and the last row, and on either side of them.
_BETWEEN: Final = 2048
_BEYOND: Final = 256
# The parts of the window that are tried, the longest first.
_PARTS: Final = (1.0, 1 / 8, 1 / 64, 0.0)
# Rows that are compared with all points at once.
_AT_ONCE: Final = 512


@dataclass(frozen=True)
class Passage:
    """The exact motion of a run from before its first row to after its last one, by at most a span."""

    run: Run
    window: float

    @property
    def around(self) -> float:
        """The time before the first row, and after the last one, over which the motion is followed."""
        return self._followed[0]

    @property
    def points(self) -> Mapping[str, Any] | None:
        """The motion at many times in order, in float64; None if it has loads."""
        return self._followed[1]

    @cached_property
    def _followed(self) -> tuple[float, Mapping[str, Any] | None]:
        """The longest part of the window in which float64 follows: a damped motion explodes backwards."""
        around = min(self.window, abs(self.run.span))
        elapsed = np.array(sorted(float(t) for t in self.run.elapsed))
        inner = np.linspace(elapsed[0], elapsed[-1], _BETWEEN)
        for part in _PARTS:
            outer = np.linspace(0.0, part * around, _BEYOND + 1)[1:]
            times = np.concatenate([elapsed[0] - outer[::-1], inner, elapsed[-1] + outer])
            points = self.run.along(times)
            if points is not None:
                return part * around, points
        return 0.0, None

    @property
    def is_followed(self) -> bool:
        """True if the motion is known at all of these times."""
        return self.points is not None

    def distances(self, compared: Compared) -> Floats:
        """Return at most the distance of each row of the answer from a motion that is followed.

        It is in the unit of the error.
        """
        assert self.points is not None
        rows = compared.over_scales(self.run.answer.quantities)
        points = compared.over_scales(self.points)
        # The motion between two points is no further from both than they are apart, about.
        gaps = np.linalg.norm(np.diff(points, axis=0), axis=1)
        return np.asarray(_distances(rows, points) - np.max(gaps))


def _distances(rows: Floats, points: Floats) -> Floats:
    """Return the distance of each row from the nearest of the points."""
    squares = np.sum(points**2, axis=1)
    nearest = []
    for first in range(0, len(rows), _AT_ONCE):
        some = rows[first : first + _AT_ONCE]
        apart = np.min(squares - 2 * some @ points.T, axis=1) + np.sum(some**2, axis=1)
        nearest.append(np.sqrt(np.maximum(apart, 0.0)))
    return np.concatenate(nearest)
