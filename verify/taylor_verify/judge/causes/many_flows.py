"""Flow of equations for many parameters and many arcs at once, by a Runge-Kutta method of order 8.

The method is that of Cooper and Verner (SIAM J. Numer. Anal. 9 (1972) 389): eleven stages, whose numbers
lie in Q(sqrt 21). An array of states has the axes (parameters, components, arcs).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import numpy as np

Floats = np.ndarray[Any, np.dtype[np.float64]]
# A function from times (arcs,) and states (parameters, components, arcs) to the rates of the states.
Rates = Callable[[Floats, Floats], Floats]

_S: Final = 21**0.5
_NODES: Final = (0, 1 / 2, 1 / 2, (7 + _S) / 14, (7 + _S) / 14, 1 / 2, (7 - _S) / 14)
_NODES_OF_STAGES: Final = (*_NODES, (7 - _S) / 14, 1 / 2, (7 + _S) / 14, 1)
_STAGES: Final[tuple[dict[int, float], ...]] = (
    {},
    {0: 1 / 2},
    {0: 1 / 4, 1: 1 / 4},
    {0: 1 / 7, 1: (-7 - 3 * _S) / 98, 2: (21 + 5 * _S) / 49},
    {0: (11 + _S) / 84, 2: (18 + 4 * _S) / 63, 3: (21 - _S) / 252},
    {0: (5 + _S) / 48, 2: (9 + _S) / 36, 3: (-231 + 14 * _S) / 360, 4: (63 - 7 * _S) / 80},
    {
        0: (10 - _S) / 42,
        2: (-432 + 92 * _S) / 315,
        3: (633 - 145 * _S) / 90,
        4: (-504 + 115 * _S) / 70,
        5: (63 - 13 * _S) / 35,
    },
    {0: 1 / 14, 4: (14 - 3 * _S) / 126, 5: (13 - 3 * _S) / 63, 6: 1 / 9},
    {
        0: 1 / 32,
        4: (91 - 21 * _S) / 576,
        5: 11 / 72,
        6: (-385 - 75 * _S) / 1152,
        7: (63 + 13 * _S) / 128,
    },
    {
        0: 1 / 14,
        4: 1 / 9,
        5: (-733 - 147 * _S) / 2205,
        6: (515 + 111 * _S) / 504,
        7: (-51 - 11 * _S) / 56,
        8: (132 + 28 * _S) / 245,
    },
    {
        4: (-42 + 7 * _S) / 18,
        5: (-18 + 28 * _S) / 45,
        6: (-273 - 53 * _S) / 72,
        7: (301 + 53 * _S) / 72,
        8: (28 - 28 * _S) / 45,
        9: (49 - 7 * _S) / 18,
    },
)
_WEIGHTS: Final = {0: 9 / 180, 7: 49 / 180, 8: 64 / 180, 9: 49 / 180, 10: 9 / 180}


def _row(entries: dict[int, float], count: int) -> Floats:
    row = np.zeros(count)
    row[list(entries)] = list(entries.values())
    return row


_TABLE: Final = tuple(_row(entries, stage) for stage, entries in enumerate(_STAGES))
STAGES: Final = len(_STAGES)
_SUM: Final = _row(_WEIGHTS, STAGES)


def flow(rates: Rates, begin: Floats, since: Floats, spans: Floats, steps: int) -> Floats:
    """Return the states after the ``spans`` of the arcs that begin at the times ``since``."""
    states, h = begin, spans / steps
    slopes = np.empty((STAGES, *begin.shape))
    flat = slopes.reshape(STAGES, -1)
    for step in range(steps):
        time = since + step * h
        for stage, (row, node) in enumerate(zip(_TABLE, _NODES_OF_STAGES, strict=True)):
            inner = states
            if stage:
                inner = states + h * (row @ flat[:stage]).reshape(begin.shape)
            slopes[stage] = rates(time + node * h, inner)
        states = states + h * (_SUM @ flat).reshape(begin.shape)
    return states


def cubic(t: Floats, states: Floats, rates: Floats, times: Floats) -> Floats:
    """Return the states at times, by cubics with the states and the rates at both ends (Hermite)."""
    k = np.clip(np.searchsorted(t, times, side="right") - 1, 0, len(t) - 2)
    span = (t[k + 1] - t[k])[:, None]
    s = (times - t[k])[:, None] / span
    begin = (1 + 2 * s) * states[k] + s * span * rates[k]
    end = (3 - 2 * s) * states[k + 1] - (1 - s) * span * rates[k + 1]
    return np.asarray((1 - s) ** 2 * begin + s**2 * end)
