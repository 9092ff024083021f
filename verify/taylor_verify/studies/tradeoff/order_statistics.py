"""The median of a few values and an interval for it that assumes nothing of how they are spread.

Of n independent values from one distribution each is below its median with probability 1/2. So the
median lies between the k-th smallest and the k-th largest with probability

    1 - 2 sum_{i<k} C(n, i) / 2^n

or more, whatever the distribution (H. A. David and H. N. Nagaraja, Order Statistics, 3rd ed. (2003),
7.1). The largest k is taken that leaves the confidence asked for.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import comb
from statistics import median
from typing import Final, NamedTuple

CONFIDENCE: Final = 0.95
FORMULA: Final = "1 - 2 sum_{i<k} C(n, i)/2^n"


class Estimate(NamedTuple):
    """The median of some values; ``low`` and ``high`` hold that of their distribution.

    Both are None where the values are too few for the confidence asked for.
    """

    median: float
    low: float | None
    high: float | None


def estimate(values: Iterable[float]) -> Estimate:
    """Return the median of at least one value, with its interval of CONFIDENCE."""
    ranked = sorted(values)
    rank = place(len(ranked), CONFIDENCE)
    low, high = (ranked[rank - 1], ranked[-rank]) if rank else (None, None)
    return Estimate(median(ranked), low, high)


def coverage(count: int, rank: int) -> float:
    """Return the probability that the median is between the rank-th smallest and largest of so many."""
    return 1 - 2 * sum(comb(count, i) for i in range(rank)) * 0.5**count


def place(count: int, confidence: float) -> int:
    """Return the largest rank whose interval has the confidence; 0 if not even the extremes have it."""
    ranks = range(1, (count + 1) // 2 + 1)
    return max((rank for rank in ranks if coverage(count, rank) >= confidence), default=0)
