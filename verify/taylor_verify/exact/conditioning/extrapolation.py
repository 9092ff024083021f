"""Steps of differential equations in float64, by Gragg's method of extrapolation.

A step is taken as 2, 4, 6, ... parts of the modified midpoint rule. The error of such a result has only
even powers of the length of a part, so each number of parts adds two orders.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from taylor_verify.exact.quadratic_forms import Floats

FINE: Final = (2, 4, 6, 8, 10, 12, 14)
"""Numbers of parts of a step of order 14."""
ROUGH: Final = (2, 4, 6)
"""Numbers of parts of a step of order 6."""


def extrapolated(
    rates: Callable[[Floats], Floats], at: Floats, h: Floats | float, parts: tuple[int, ...] = FINE
) -> tuple[Floats, Floats]:
    """Return the states after a step, and the difference that the last order made.

    ``at`` (n, columns) are the states of n systems, one in each row, and ``rates`` returns their rates of
    change in the same shape. ``h`` is the length of the step: one number, or a column (n, 1).
    """
    first, row = rates(at), list[Floats]()
    for k, count in enumerate(parts):
        part = h / count
        before, now = at, at + part * first
        for _ in range(count - 1):
            before, now = now, before + 2 * part * rates(now)
        above, row = row, [now]
        for j in range(k):
            share = (count / parts[k - 1 - j]) ** 2 - 1
            row.append(row[j] + (row[j] - above[j]) / share)
    return row[-1], row[-1] - row[-2]
