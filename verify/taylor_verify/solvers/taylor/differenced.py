"""The fastest rate of a motion under loads that its scene writes down, by differences in doubles.

It answers what `rates.Linearised` answers, for equations that are not polynomials.
"""

from __future__ import annotations

from math import inf, isfinite
from typing import Any, Final

import numpy as np

from taylor_verify.models.functions import functions_of
from taylor_verify.models.problem import Problem
from taylor_verify.models.rates import SLOWEST, largest_eigenvalue
from taylor_verify.solvers.straight_line import straight_line

_STEP: Final = 2.0**-20
# The loads may change with time: at a start they are looked at in these parts of the way.
_LOOKS: Final = (0.0, 0.37, 0.81)

Floats = np.ndarray[Any, Any]


class Differenced:
    """The Jacobian of the rates of one problem, at many states and times."""

    def __init__(self, problem: Problem) -> None:
        parameters = [float(value) for value in problem.parameters]
        self._rates = straight_line(problem.form, parameters, functions_of(np.empty(0)))
        begin, end = float(problem.begin), float(problem.times[-1])
        self._early = [begin + part * (end - begin) for part in _LOOKS]

    def fastest(self, states: Any, times: Any = ()) -> float:
        """Return the fastest rate at all rows of an array, each at its time; infinite where not finite.

        A state without a time is looked at in several. The unit is radians per unit of time.
        """
        at = times if len(times) else self._early
        rows = np.atleast_2d(np.asarray(states, dtype=float))
        rows = np.broadcast_to(rows, (len(at), rows.shape[1]))
        with np.errstate(all="ignore"):
            bound = largest_eigenvalue(self._jacobians(rows, np.array(list(map(float, at)))))
        return max(bound, SLOWEST) if isfinite(bound) else inf

    def _jacobians(self, rows: Floats, times: Floats) -> Floats:
        """Return the Jacobian at each row: the rates at all states beside them at once."""
        count = rows.shape[1]
        steps = _STEP * np.maximum(1.0, np.abs(rows))
        # Axes: the row itself and each state that is moved, the rows, and the states.
        around = np.repeat(rows[None], count + 1, axis=0)
        around[np.arange(count) + 1, :, np.arange(count)] += steps.T
        at = np.broadcast_to(times, around.shape[:-1])
        rates = [rate + 0 * at for rate in self._rates(at, list(np.moveaxis(around, -1, 0)))]
        whole = np.stack(rates, axis=-1)
        J: Floats = np.moveaxis((whole[1:] - whole[0]) / steps.T[:, :, None], 0, -1)
        return J
