"""The fastest rate of a motion under loads that its scene writes down, by differences in doubles.

It answers what `rates.Linearised` answers, for equations that are not polynomials.
"""

from __future__ import annotations

from math import inf, isfinite
from typing import Any, Final

import numpy as np

from taylor_verify.models.fastest_rate import SLOWEST, largest_eigenvalue
from taylor_verify.models.functions import functions_of
from taylor_verify.models.problem import Problem
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
        at = np.asarray(times if len(times) else self._early, dtype=float)
        rows = np.atleast_2d(np.asarray(states, dtype=float))
        with np.errstate(all="ignore"):
            bound = largest_eigenvalue(self._jacobians(rows.T, at))
        return max(bound, SLOWEST) if isfinite(bound) else inf

    def _jacobians(self, columns: Floats, times: Floats) -> Floats:
        """Return the Jacobian at each time: the rates at all states beside them at once."""
        count = len(columns)
        # Axes: the states, the row itself and each state that is moved, the rows.
        around = np.empty((count, count + 1, len(times)))
        around[:] = columns[:, None]
        steps = _STEP * np.maximum(1.0, np.abs(around[:, 0]))
        around.reshape(-1, len(times))[1 :: count + 2] += steps
        whole = np.empty_like(around)
        for place, rate in enumerate(self._rates(times, list(around))):
            whole[place] = rate
        J: Floats = ((whole[:, 1:] - whole[:, :1]) / steps).transpose(2, 0, 1)
        return J
