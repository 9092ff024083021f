"""Solutions of homogeneous quadratic equations in float64, by Taylor series.

z' = Q(z, z) with a bilinear map Q. A constant component 1 allows linear and constant terms. The
coefficients obey (k + 1) z_k+1 = sum of Q(z_i, z_k-i). Several equations, each for many starts, are
solved at once.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import numpy as np

Floats = np.ndarray[Any, np.dtype[np.float64]]
# A function that returns z' for every row of z; homogeneous of degree two.
Rate = Callable[[Floats], Floats]

# With 20 terms a step may be a sixth of the radius of convergence: (1/6)^20 is a roundoff of float64.
_TERMS: Final = 20
_ROUNDOFF: Final = 2.0**-53
# Limit for the number of steps from one row to the next.
_MOST_STEPS: Final = 400


def bilinear(rate: Rate, size: int) -> Floats:
    """Return the symmetric map Q (d, d, d) of a homogeneous rate; Q[:, j, k] multiplies z_j z_k."""
    unit = np.eye(size)
    single = rate(unit)
    j, k = np.triu_indices(size, 1)
    mixed = (rate(unit[j] + unit[k]) - single[j] - single[k]) / 2
    Q = np.zeros((size, size, size))
    Q[:, range(size), range(size)] = single.T
    Q[:, j, k] = Q[:, k, j] = mixed.T
    return Q


def flow(maps: Floats, begin: Floats, spans: Floats, sizes: Floats) -> Floats:
    """Return z after these spans, (m, n, d), for m maps (m, d, d, d) and n starts (n, d).

    ``sizes`` (d,) are typical sizes of the components, infinite for a component that does not move. A
    motion that would take too many steps, or that diverges, is NaN.
    """
    count, size = maps.shape[:2]
    columns = maps.reshape(count, size, size * size).transpose(0, 2, 1)
    state = np.broadcast_to(begin, (count, *begin.shape)).copy()
    left = np.broadcast_to(spans, state.shape[:2]).copy()
    for _ in range(_MOST_STEPS):
        series = _series(columns, state)
        last = np.max(np.abs(series[-2:] / sizes), axis=(0, 3))
        reach = (_ROUNDOFF / last) ** (1 / _TERMS)
        step = np.sign(left) * np.fmin(np.abs(left), reach)
        state = series[-1]
        for coefficient in series[-2::-1]:
            state = coefficient + step[:, :, None] * state
        left = left - step
        if not np.any(left):
            break
    state[left != 0] = np.nan
    return state


def _series(columns: Floats, state: Floats) -> Floats:
    """Return the Taylor coefficients (k, m, n, d) of the motion at each state (m, n, d)."""
    series = np.empty((_TERMS + 1, *state.shape))
    series[0] = state
    products = (*state.shape[:2], state.shape[2] ** 2)
    for k in range(_TERMS):
        pairs = np.einsum("kmni,kmnj->mnij", series[: k + 1], series[k::-1])
        series[k + 1] = pairs.reshape(products) @ columns / (k + 1)
    return series
