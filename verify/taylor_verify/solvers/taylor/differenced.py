"""The fastest rate of a motion under loads that its scene writes down, by differences in doubles.

It answers what `rates.Linearised` answers, for equations that are not polynomials.
"""

from __future__ import annotations

from math import inf
from typing import Any, Final

import numpy as np

from taylor_verify.models.functions import functions_of
from taylor_verify.models.problem import Problem
from taylor_verify.models.rates import SLOWEST
from taylor_verify.solvers.straight_line import straight_line

_STEP: Final = 2.0**-20
# The loads may change with time: they are looked at in these parts of a piece of it.
_LOOKS: Final = (0.0, 0.37, 0.81)

Floats = np.ndarray[Any, Any]


class Differenced:
    """The Jacobian of the rates of one problem at many states, and at some times."""

    def __init__(self, problem: Problem) -> None:
        parameters = [float(value) for value in problem.parameters]
        self._rates = straight_line(problem.form, parameters, functions_of(np.empty(0)))
        begin, end = float(problem.begin), float(problem.times[-1])
        self._times = np.array([begin + part * (end - begin) for part in _LOOKS])

    def fastest(self, states: Any) -> float:
        """Return the fastest rate at a state, or at all rows of an array; infinite where not finite.

        The unit is radians per unit of time.
        """
        rows = np.atleast_2d(np.asarray(states, dtype=float))
        with np.errstate(all="ignore"):
            J = self._jacobians(rows)
        if not np.isfinite(J).all():
            return inf
        return max(float(np.abs(np.linalg.eigvals(J)).max()), SLOWEST)

    def is_within(self, states: Any, rate: float) -> bool:
        """Return True if no row of an array of states has a faster rate."""
        return self.fastest(states) <= rate

    def _jacobians(self, rows: Floats) -> Floats:
        """Return the Jacobian at each time and row: the rates at all states beside them at once."""
        count = rows.shape[1]
        steps = _STEP * np.maximum(1.0, np.abs(rows))
        moves = steps[:, None, :] * np.eye(count)
        # Axes: the times, ahead or behind, the rows, the state that is moved, and the states.
        around = np.stack([rows[:, None, :] + moves, rows[:, None, :] - moves])
        shape = (len(self._times), *around.shape)
        states = np.broadcast_to(around, shape).reshape(-1, count)
        times = np.broadcast_to(self._times[:, None, None, None], shape[:-1]).ravel()
        rates = [rate + 0 * times for rate in self._rates(times, list(states.T))]
        ahead, behind = np.moveaxis(np.stack(rates, axis=-1).reshape(shape), 1, 0)
        J: Floats = (ahead - behind) / (2 * steps)[:, :, None]
        return J
