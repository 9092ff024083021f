"""Quantiles of any number of sizes in bounded memory: a histogram with bins of a thousandth.

Each bin has a count and its largest size. So a quantile is a size that occurred, at most a thousandth above
the exact one. Libraries for this (t-digest, DDSketch) return numbers that did not occur.
"""

from __future__ import annotations

from bisect import bisect_left
from itertools import accumulate
from math import inf, isfinite
from typing import Any, Final

import numpy as np

from taylor_verify.records.sweep import Quantiles

Array = np.ndarray[Any, Any]

# The bits of a double behind those of a bin: the sign, the exponent and ten bits of the fraction are left.
_BELOW_A_BIN: Final = 42
_SHARES: Final = (0.5, 0.9, 0.99, 0.999, 1.0)


class Sizes:
    """A running count of sizes; NaN counts as larger than every number."""

    def __init__(self) -> None:
        self._counts: dict[int, int] = {}
        self._largest: dict[int, float] = {}
        self.count = 0

    def add(self, sizes: Array) -> None:
        """Count some sizes, none of them negative."""
        sizes = np.sort(np.where(np.isnan(sizes), inf, np.abs(sizes)).astype(float))
        bins = sizes.view(np.uint64) >> np.uint64(_BELOW_A_BIN)
        unique_bins, starts, counts = np.unique(bins, return_index=True, return_counts=True)
        of_bins = (unique_bins, counts, sizes[starts + counts - 1])
        for which, count, largest in zip(*(row.tolist() for row in of_bins), strict=True):
            self._counts[which] = self._counts.get(which, 0) + count
            self._largest[which] = max(self._largest.get(which, 0.0), largest)
        self.count += len(sizes)

    def quantiles(self) -> Quantiles | None:
        """Return the quantiles; None where nothing was counted. A size that is not finite is None."""
        if not self.count:
            return None
        bins = sorted(self._counts)
        totals = list(accumulate(self._counts[which] for which in bins))
        sizes = (self._largest[bins[_place(totals, share * self.count)]] for share in _SHARES)
        return Quantiles(*(size if isfinite(size) else None for size in sizes))


def _place(totals: list[int], wanted: float) -> int:
    """Return the first place at which so many are counted, and at least one."""
    return min(bisect_left(totals, max(wanted, 1)), len(totals) - 1)
