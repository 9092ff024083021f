"""Functions of time from data: held, linear, or a natural cubic spline, all in exact rationals."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction
from functools import cached_property
from itertools import pairwise


class Kind(StrEnum):
    """The way from one value to the next."""

    HOLD = "hold"
    LINEAR = "linear"
    CUBIC = "cubic"


@dataclass(frozen=True)
class Table:
    """Values at rising times; before the first and after the last time the first or the last value."""

    times: tuple[Fraction, ...]
    values: tuple[Fraction, ...]
    kind: Kind = Kind.LINEAR

    def polynomial(self, time: Fraction) -> tuple[Fraction, tuple[Fraction, ...]]:
        """The piece just after a time: its knot, and the coefficients of powers of t less the knot."""
        k = bisect_right(self.times, time) - 1
        if k < 0 or k >= len(self.times) - 1:
            return self.times[0], (self.values[max(k, 0)],)
        knot, value = self.times[k], self.values[k]
        if self.kind is Kind.HOLD:
            return knot, (value,)
        width = self.times[k + 1] - knot
        slope = (self.values[k + 1] - value) / width
        if self.kind is Kind.LINEAR:
            return knot, (value, slope)
        m, n = self._bends[k], self._bends[k + 1]
        return knot, (value, slope - width * (2 * m + n) / 6, m / 2, (n - m) / (6 * width))

    @cached_property
    def _bends(self) -> Sequence[Fraction]:
        """The second derivatives of the natural spline at the times: zero at both ends."""
        widths = [b - a for a, b in pairwise(self.times)]
        slopes = [(b - a) / w for (a, b), w in zip(pairwise(self.values), widths, strict=True)]
        # By elimination: h_k m_k + 2 (h_k + h_(k+1)) m_(k+1) + h_(k+1) m_(k+2) = 6 (s_(k+1) - s_k).
        ratios, rests = [Fraction(0)], [Fraction(0)]
        for k in range(len(widths) - 1):
            pivot = 2 * (widths[k] + widths[k + 1]) - widths[k] * ratios[-1]
            rests.append((6 * (slopes[k + 1] - slopes[k]) - widths[k] * rests[-1]) / pivot)
            ratios.append(widths[k + 1] / pivot)
        bends = [Fraction(0)]
        for ratio, rest in zip(ratios[:0:-1], rests[:0:-1], strict=True):
            bends.append(rest - ratio * bends[-1])
        return [*([Fraction(0)] if len(widths) > 0 else []), *reversed(bends)]
