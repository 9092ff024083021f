"""The median of a few values, with an interval without assumptions on their distribution.

Each of n independent values from one distribution is below its median with probability 1/2. Therefore the
median lies between the k-th smallest and the k-th largest value with probability

    1 - 2 sum_{i<k} C(n, i) / 2^n

or more, for any distribution (H. A. David and H. N. Nagaraja, Order Statistics, 3rd ed. (2003), 7.1).
The interval has the largest k with the required confidence.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import comb
from statistics import median
from typing import Final, NamedTuple

CONFIDENCE: Final = 0.95
FORMULA: Final = "1 - 2 sum_{i<k} C(n, i)/2^n"


class Estimate(NamedTuple):
    """The median of some values; ``low`` and ``high`` enclose the median of their distribution.

    Both are None if the values are too few for the confidence.
    """

    median: float
    low: float | None
    high: float | None


def estimate(values: Iterable[float]) -> Estimate:
    """Return the median of the values, at least one, with its interval at CONFIDENCE."""
    ranked = sorted(values)
    rank = place(len(ranked), CONFIDENCE)
    low, high = (ranked[rank - 1], ranked[-rank]) if rank else (None, None)
    return Estimate(median(ranked), low, high)


def coverage(count: int, rank: int) -> float:
    """Return the probability that the median is between the rank-th smallest and largest value."""
    return 1 - 2 * sum(comb(count, i) for i in range(rank)) * 0.5**count


def place(count: int, confidence: float) -> int:
    """Return the largest rank whose interval has the confidence; 0 if not even rank 1 has it."""
    ranks = range(1, (count + 1) // 2 + 1)
    return max((rank for rank in ranks if coverage(count, rank) >= confidence), default=0)
