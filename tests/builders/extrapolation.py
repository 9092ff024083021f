"""The method of Gragg, Bulirsch and Stoer in mpmath: one large step of any equations."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from mpmath import mpf

Vector = list[Any]
Rates = Callable[[Any, Vector], Vector]


def extrapolated(rates: Rates, t: Any, y: Vector, h: Any, columns: int) -> tuple[Vector, Any]:
    """Take one large step: the modified midpoint rule at 2, 4, .. small ones, extrapolated to none."""
    table: list[list[Vector]] = []
    for j in range(1, columns + 1):
        row = [_midpoint(rates, t, y, h, 2 * j)]
        for k in range(1, j):
            ratio = (mpf(j) / (j - k)) ** 2
            row.append(
                [b + (b - a) / (ratio - 1) for a, b in zip(table[-1][k - 1], row[-1], strict=True)]
            )
        table.append(row)
    last, before = table[-1][-1], table[-2][-1]
    return last, max(abs(a - b) for a, b in zip(last, before, strict=True))


def _midpoint(rates: Rates, t: Any, y: Vector, h: Any, count: int) -> Vector:
    s = h / count
    before, here = y, [a + s * r for a, r in zip(y, rates(t, y), strict=True)]
    for k in range(1, count):
        rate = rates(t + k * s, here)
        before, here = here, [a + 2 * s * r for a, r in zip(before, rate, strict=True)]
    rate = rates(t + h, here)
    return [(a + b + s * r) / 2 for a, b, r in zip(before, here, rate, strict=True)]
