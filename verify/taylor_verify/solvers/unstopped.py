"""The rates of a motion for an integrator that stops at no switch and at no instant of held states.

So are many simulators written: one call of the integrator, whose rates look up which loads act now, and
take a held value at the first evaluation that does not come before its instant. The state of that
evaluation is not the state of the instant, so that the answer is of first order there.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from typing import Any

from taylor_verify.models.problem import Problem
from taylor_verify.models.stretch import holding, taking
from taylor_verify.numbers.precision import exact_value
from taylor_verify.numbers.tensors import Vector
from taylor_verify.solvers.between_switches import held_at_start, legs
from taylor_verify.solvers.straight_line import Counting, Rates, straight_line


class Unstopped(Counting):
    """The rates of all legs of a motion in double precision, counted.

    A held value is that of the last instant so far that an evaluation has reached.
    """

    def __init__(self, problem: Problem, most: int) -> None:
        loads = problem.given.body.loads
        assert loads is not None
        super().__init__(most)
        self._legs = list(legs(problem, loads))
        self._sign = 1 if problem.times[-1] > 0 else -1
        self._ends = [self._sign * float(leg.problem.times[-1]) for leg in self._legs]
        self._held = [held_at_start(problem)]
        self._rates: dict[int, Rates] = {}

    def __call__(self, t: float, state: Sequence[float]) -> list[Any]:
        self.count()
        ended = self._ended(t, state)
        return self._of_leg(min(ended, len(self._legs) - 1))(t, state)

    def held_at(self, t: float, state: Sequence[float]) -> Vector:
        """Return the held values at a time, in the scene's units; on an instant those taken there."""
        return self._held[self._ended(t, state)]

    def _ended(self, t: float, state: Sequence[float]) -> int:
        """Return how many legs have ended; what is taken at their ends is taken from this state."""
        ended = bisect_right(self._ends, self._sign * t)
        while len(self._held) <= ended:
            leg, values = self._legs[len(self._held) - 1], self._held[-1]
            if leg.instant is not None:
                exactly = tuple(exact_value(value) for value in state)
                values = taking(holding(leg.problem, values), leg.instant, exactly)
            self._held.append(values)
        return ended

    def _of_leg(self, k: int) -> Rates:
        if k not in self._rates:
            posed = holding(self._legs[k].problem, self._held[k])
            self._rates[k] = straight_line(posed.form, list(map(float, posed.parameters)))
        return self._rates[k]
