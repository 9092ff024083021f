"""The fastest rate of a motion under loads that its scene writes down, by differences in doubles.

It answers what `rates.Linearised` answers, for equations that are not polynomials.
"""

from __future__ import annotations

from math import inf
from typing import Any, Final

import numpy as np

from taylor_verify.models.problem import Problem
from taylor_verify.models.rates import SLOWEST

_STEP: Final = 2.0**-20
# The loads may change with time: they are looked at in these parts of a piece of it.
_LOOKS: Final = (0.0, 0.37, 0.81)

Floats = np.ndarray[Any, Any]


class Differenced:
    """The Jacobian of the rates of one problem at many states, and at some times."""

    def __init__(self, problem: Problem) -> None:
        self._form = problem.form
        self._parameters = [float(value) for value in problem.parameters]
        begin, end = float(problem.begin), float(problem.times[-1])
        self._times = [begin + part * (end - begin) for part in _LOOKS]

    def fastest(self, states: Any) -> float:
        """Return the fastest rate at a state, or at all rows of an array; infinite where not finite.

        The unit is radians per unit of time.
        """
        rows = np.atleast_2d(np.asarray(states, dtype=float))
        with np.errstate(all="ignore"):
            J = np.concatenate([self._jacobians(rows, t) for t in self._times])
        if not np.isfinite(J).all():
            return inf
        return max(float(np.abs(np.linalg.eigvals(J)).max()), SLOWEST)

    def is_within(self, states: Any, rate: float) -> bool:
        """Return True if no row of an array of states has a faster rate."""
        return self.fastest(states) <= rate

    def _jacobians(self, rows: Floats, t: float) -> Floats:
        steps = _STEP * np.maximum(1.0, np.abs(rows))
        # One state beside each row for each component.
        beside = steps[:, None, :] * np.eye(rows.shape[1])
        ahead, behind = (self._rates(rows[:, None, :] + sign * beside, t) for sign in (1, -1))
        return np.swapaxes((ahead - behind) / (2 * steps)[:, :, None], 1, 2)

    def _rates(self, states: Floats, t: float) -> Floats:
        """Return the rates at each of many states, the last axis of the array."""
        columns = list(states.reshape(-1, states.shape[-1]).T)
        times = np.full(len(columns[0]), t)
        rates = self._form.rates(columns, self._parameters, times)
        return np.stack([rate + np.zeros(len(times)) for rate in rates], axis=-1).reshape(
            states.shape
        )
