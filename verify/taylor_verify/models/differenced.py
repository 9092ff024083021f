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
        count = rows.shape[1]
        J = np.empty((len(rows), count, count))
        for k in range(count):
            step = _STEP * np.maximum(1.0, np.abs(rows[:, k]))
            around = [rows.copy(), rows.copy()]
            around[0][:, k] += step
            around[1][:, k] -= step
            ahead, behind = (self._rates(states, t) for states in around)
            J[:, :, k] = (ahead - behind) / (2 * step)[:, None]
        return J

    def _rates(self, rows: Floats, t: float) -> Floats:
        rates = self._form.rates(list(rows.T), self._parameters, np.full(len(rows), t))
        return np.array([rate + np.zeros(len(rows)) for rate in rates]).T
