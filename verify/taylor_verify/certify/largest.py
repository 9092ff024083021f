"""The largest value of a norm of polynomials on many intervals: bounds from above and from below.

On an interval |v| <= 1 the norm is at most that of the sums of the magnitudes of the coefficients, and at
the middle at least that of the first ones. Intervals that may hold more than what is reached elsewhere are
halved, all of them at once, until both bounds agree to a percent.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import comb
from typing import Any, Final, NamedTuple

import numpy as np

from taylor_verify.certify.enclosed_error import Floats, Interval

_CLOSE: Final = 1.01
_ROUNDS: Final = 14
# Roundings of a sum of at most a hundred terms, and of the halvings before it.
_SLACK: Final = 2.0**-40


class Largest(NamedTuple):
    """The norm is at most ``bound``, near the time ``at``; somewhere it is at least ``reached``."""

    bound: float
    reached: float
    at: float


def largest(intervals: Sequence[Interval]) -> Largest:
    """Return the largest norm, by the scale of each interval."""
    work = _Work.of(intervals)
    bound, reached, at = 0.0, 0.0, float(intervals[0].middle)
    for _ in range(_ROUNDS):
        upper, lower, least = work.limits()
        best = int(lower.argmax())
        if lower[best] > reached or not reached:
            reached, at = max(reached, float(lower[best])), float(work.middle[best])
        # Where the polynomial hardly changes, halves have no lower bounds.
        is_open = (upper > _CLOSE * reached) & (upper > _CLOSE * least)
        bound = max(bound, float(upper[~is_open].max(initial=0.0)))
        if not is_open.any():
            return Largest(bound, reached, at)
        work = work.halved(is_open)
    upper, _, _ = work.limits()
    return Largest(max(bound, float(upper.max())), reached, at)


@dataclass(frozen=True)
class _Work:
    """Coefficients (intervals, components, orders), with bounds, middles, half lengths and scales."""

    rows: Floats
    beside: Floats
    middle: Floats
    half: Floats
    scale: Floats

    @classmethod
    def of(cls, intervals: Sequence[Interval]) -> _Work:
        count = max(interval.rows.shape[1] for interval in intervals)
        rows = np.zeros((len(intervals), intervals[0].rows.shape[0], count))
        for k, interval in enumerate(intervals):
            rows[k, :, : interval.rows.shape[1]] = interval.rows
        return cls(
            rows,
            np.array([interval.beside for interval in intervals]),
            np.array([interval.middle for interval in intervals]),
            np.array([interval.half for interval in intervals]),
            np.array([interval.scale for interval in intervals]),
        )

    def limits(self) -> tuple[Floats, Floats, Floats]:
        """The norm on each interval from above, and at its middle from below and from above."""
        sizes = np.abs(self.rows)
        whole = sizes.sum(axis=2) + self.beside
        first = sizes[:, :, 0]
        middle = np.maximum(first - self.beside, 0.0)
        with np.errstate(divide="ignore", invalid="ignore"):
            upper, lower, above = (
                np.sqrt((x * x).sum(axis=1)) / self.scale
                for x in (whole, middle, first + self.beside)
            )
        return upper * (1 + _SLACK), np.where(self.scale > 0, lower * (1 - _SLACK), 0.0), above

    def halved(self, chosen: Any) -> _Work:
        """Both halves of the chosen intervals."""
        rows, beside = self.rows[chosen], self.beside[chosen]
        middle, half, scale = (x[chosen] for x in (self.middle, self.half, self.scale))
        grown = beside + _SLACK * np.abs(rows).sum(axis=2)
        sides = [rows @ _shift(rows.shape[2], side) for side in (-1, 1)]
        return _Work(
            np.concatenate(sides),
            np.concatenate([grown, grown]),
            np.concatenate([middle - half / 2, middle + half / 2]),
            np.concatenate([half, half]) / 2,
            np.concatenate([scale, scale]),
        )


def _shift(count: int, side: int) -> Floats:
    """The matrix from the coefficients in v to those in w, for v = (side + w)/2."""
    matrix = np.zeros((count, count))
    for k in range(count):
        for j in range(k + 1):
            matrix[k, j] = comb(k, j) * float(side) ** (k - j) / 2.0**k
    return matrix
