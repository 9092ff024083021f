"""An integral from 0 as Chebyshev series, panel by panel, and its inverse, in mpmath.

f is positive and analytic on the real axis. On a panel it is interpolated at the n zeros of T_n, and the
series is integrated term by term. Where its last coefficients are not below the last digit the panel is
halved: towards a place where f is all but singular the panels shrink in proportion to the distance.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, final

from mpmath import mp, mpf

from taylor_verify.exact.solution import Unsettled

# Each node is good for a digit where f is analytic as far as five panels away. The last few
# coefficients must be small.
_NODES_PER_DIGIT: Final = 1
_TAIL: Final = 4
_MOST_TRIES: Final = 400
# Of the width at which the last coefficients should just be small enough.
_MARGIN: Final = 0.9
_LEAST_CHANGE: Final = 0.8
_MOST_PANELS: Final = 2000
_NEWTON_STEPS: Final = 60


@final
@dataclass(frozen=True)
class Panel:
    """A panel from ``left`` to ``right``: ``series`` is the integral on it, ``before`` that up to it."""

    left: mpf
    right: mpf
    before: mpf
    after: mpf
    series: list[mpf]

    def at(self, x: mpf) -> mpf:
        """The integral from 0 to x, by Clenshaw's recurrence."""
        s = (2 * x - self.left - self.right) / (self.right - self.left)
        b, b_next, twice = mpf(0), mpf(0), 2 * s
        for coefficient in reversed(self.series[1:]):
            b, b_next = twice * b - b_next + coefficient, b
        return self.before + s * b - b_next + self.series[0]


class Panels:
    """int_0^x f for x >= 0, as far as it is asked for, at the precision at which this was made.

    ``end`` is where f is asked for last, None where it goes on for ever; ``width`` that of the first panel.
    """

    def __init__(self, f: Callable[[mpf], mpf], width: mpf, end: mpf | None = None) -> None:
        self._f, self._end, self._width = f, end, width
        self._count = _NODES_PER_DIGIT * int(mp.dps) + 2 * _TAIL
        # A coefficient is a mean of n values with some roundings each.
        self._smallest = 1000 * self._count * mp.eps
        quarter = 4 * self._count
        self._cosines = [mp.cospi(mpf(2 * j) / quarter) for j in range(quarter)]
        self._panels: list[Panel] = []

    def at(self, x: mpf) -> mpf:
        """int_0^x f."""
        while self._more() and (not self._panels or self._panels[-1].right < x):
            self._extend()
        k = bisect_left(self._panels, x, key=lambda panel: panel.right)
        return self._panels[min(k, len(self._panels) - 1)].at(x)

    def inverse(self, t: mpf) -> mpf:
        """The x >= 0 at which the integral is t >= 0, by Newton's iteration between two bounds."""
        while self._more() and (not self._panels or self._panels[-1].after < t):
            self._extend()
        k = bisect_left(self._panels, t, key=lambda panel: panel.after)
        panel = self._panels[min(k, len(self._panels) - 1)]
        low, high = panel.left, panel.right
        x = low + (high - low) * (t - panel.before) / (panel.after - panel.before)
        for _ in range(_NEWTON_STEPS):
            step = (t - panel.at(x)) / self._f(x)
            if abs(step) <= 16 * mp.eps * (high + abs(x)):
                return x + step
            low, high = (x, high) if step > 0 else (low, x)
            x += step
            if not panel.left <= x <= panel.right:
                x = (low + high) / 2
        return x

    def _more(self) -> bool:
        return self._end is None or not self._panels or self._panels[-1].right < self._end

    def _extend(self) -> None:
        """Add a panel, as wide as the coefficients of the last one promise."""
        left = self._panels[-1].right if self._panels else mpf(0)
        before = self._panels[-1].after if self._panels else mpf(0)
        if len(self._panels) > _MOST_PANELS:
            raise Unsettled(f"expected at most {_MOST_PANELS} panels up to the time asked for")
        for _ in range(_MOST_TRIES):
            right = left + self._width
            if self._end is not None and right > self._end:
                right = self._end
            values = self._values(left, right)
            a, tail = self._coefficients(values)
            # Of n coefficients that fall like a geometric series in the width, so much wider or narrower.
            factor = _MARGIN * (self._smallest / max(tail, mp.eps)) ** (mpf(1) / self._count)
            # Written so that a NaN is not small.
            if tail <= self._smallest:
                series = _integral(a, (right - left) / 2)
                self._panels.append(Panel(left, right, before, before + mp.fsum(series), series))
                self._width = (right - left) * max(factor, _LEAST_CHANGE)
                return
            is_finite = mp.isfinite(tail)
            self._width = (right - left) * (min(factor, _LEAST_CHANGE) if is_finite else 0.5)
        raise Unsettled("the integrand of the time is not resolved by any panel")

    def _values(self, left: mpf, right: mpf) -> list[mpf]:
        """f at the zeros of T_n on the panel."""
        half, middle = (right - left) / 2, (right + left) / 2
        return [self._f(middle + half * self._cosines[2 * j + 1]) for j in range(self._count)]

    def _coefficients(self, values: list[mpf]) -> tuple[list[mpf], mpf]:
        """The Chebyshev coefficients, the first doubled, and the last of them relative to f.

        Where the last are too large, they alone are computed.
        """
        n, cosines = self._count, self._cosines

        def coefficient(k: int) -> mpf:
            row = (cosines[k * (2 * j + 1) % (4 * n)] for j in range(n))
            return 2 * mp.fdot(zip(values, row, strict=True)) / n

        last = [coefficient(k) for k in range(n - _TAIL, n)]
        size = 2 * mp.fsum(values) / n
        tail = max(abs(c) for c in last) / size if mp.isfinite(size) else mp.inf
        if not tail <= self._smallest:
            return last, tail
        return [*(coefficient(k) for k in range(n - _TAIL)), *last], tail


def _integral(a: list[mpf], half: mpf) -> list[mpf]:
    """The integral from the left end of a panel of this half width, as a Chebyshev series."""
    padded = [*a, mpf(0), mpf(0)]
    series = [half * (padded[k - 1] - padded[k + 1]) / (2 * k) for k in range(1, len(a) + 1)]
    start = mp.fsum(-c if k % 2 else c for k, c in enumerate(series, 1))
    return [-start, *series]
