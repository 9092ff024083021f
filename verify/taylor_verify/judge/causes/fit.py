"""Gauss-Newton least squares, for hypotheses whose numbers are fitted to the answer."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from taylor_verify.judge.causes.flow import Floats

# Step of a central difference in a parameter's unit: truncation and roundoff errors are about equal.
_DIFFERENCE: Final = 1e-5
_ITERATIONS: Final = 8
_SETTLED: Final = 1e-10
# Directions that change the motion less than this part of the strongest direction are left alone.
_UNSEEN: Final = 1e-7

# A function from parameters (m, p) to states (m, n, d); NaN for impossible parameters.
Model = Callable[[Floats], Floats]


def fitted(model: Model, target: Floats, sizes: Floats, start: Floats) -> tuple[Floats, Floats]:
    """Return the parameters whose states are nearest to the target, and those states."""
    count = len(start)
    best, nearest = start, np.full(target.shape, np.nan)
    least, parameters = np.inf, start
    shifts = _DIFFERENCE * np.vstack([np.zeros(count), np.eye(count), -np.eye(count)])
    for _ in range(_ITERATIONS):
        tried = model(parameters + shifts)
        if not np.all(np.isfinite(tried)):
            break
        miss = ((target - tried[0]) / sizes).ravel()
        size = float(miss @ miss)
        if size >= least:
            break
        best, nearest, least = parameters, tried[0], size
        slopes = (tried[1 : count + 1] - tried[count + 1 :]) / (2 * _DIFFERENCE) / sizes
        step = np.linalg.lstsq(slopes.reshape(count, -1).T, miss, rcond=_UNSEEN)[0]
        parameters = parameters + step
        if np.max(np.abs(step)) <= _SETTLED * np.max(np.abs(parameters)):
            break
    return best, nearest
