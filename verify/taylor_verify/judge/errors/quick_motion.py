"""The exact motion of a scene at any time, followed in float64 from the rows where it is known.

It is quick where an exact motion is slow, to try many times. What is found by it is asked again of the
exact motion.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final, final

import numpy as np

from taylor_verify.exact.rates import FloatFlow
from taylor_verify.judge.causes.many_flows import flow

Floats = np.ndarray[Any, np.dtype[np.float64]]
Places = np.ndarray[Any, np.dtype[np.intp]]

# The length of a step over the shortest time in which the motion changes: some turns are right to 1e-8.
_STEP: Final = 0.5
# Steps one behind the other.
_MOST_STEPS: Final = 4096


@final
class QuickMotion:
    """The motion of ``equations`` through known rows.

    ``known`` has the quantities of the rows in the scene's units, and ``times`` their times since the
    start, in any order and in the unit of the equations.
    """

    def __init__(self, equations: FloatFlow, known: Mapping[str, Any], times: Floats) -> None:
        self._equations = equations
        self.rows, self._since = equations.states(known), times
        order = np.argsort(times, kind="stable")
        self._times, self._nodes = times[order], self.rows[order]

    def at(self, times: Floats) -> Floats | None:
        """Return the states at times; None where float64 does not follow, or not in so many steps."""
        ways = self._ways(times, np.zeros_like(times))
        return None if ways is None else ways[0] + ways[1]

    def beyond(self, places: Places, later: Floats) -> Floats | None:
        """Return the states so much later than the known rows at these places, less those rows.

        The difference has all its digits, however small it is. None as in ``at``.
        """
        ways = self._ways(self._since[places], later)
        return None if ways is None else (ways[0] - self.rows[places]) + ways[1]

    def _ways(self, since: Floats, later: Floats) -> tuple[Floats, Floats] | None:
        """Return the node nearest to each time, and the way from there."""
        times = since + later
        with np.errstate(all="ignore"):
            if not self._reaches(np.array([np.min(times), np.max(times)])):
                return None
            after = np.minimum(np.searchsorted(self._times, times), len(self._times) - 1)
            before = np.maximum(after - 1, 0)
            is_after = self._times[after] - times < times - self._times[before]
            nearest = np.where(is_after, after, before)
            way = self._way(self._nodes[nearest], (since - self._times[nearest]) + later)
        return None if way is None else (self._nodes[nearest], way)

    def _reaches(self, ends: Floats) -> bool:
        """Add nodes at both ends until they reach two times; False if they do not."""
        times, nodes = self._times[[0, -1]], self._nodes[[0, -1]]
        every = [(self._times, self._nodes)]
        for _ in range(_MOST_STEPS):
            goes_on = np.array([ends[0] < times[0], ends[1] > times[1]])
            if not np.any(goes_on):
                break
            longest = self._steps(nodes)
            if not np.all(longest[goes_on] > 0):
                return False
            step = np.where(goes_on, np.clip(ends - times, -longest, longest), 0.0)
            times, nodes = times + step, nodes + self._step(nodes, step)
            every.append((times[goes_on], nodes[goes_on]))
        else:
            return False
        if len(every) > 1:
            self._times, order = np.unique(np.concatenate([t for t, _ in every]), return_index=True)
            self._nodes = np.vstack([rows for _, rows in every])[order]
        return True

    def _way(self, begin: Floats, spans: Floats) -> Floats | None:
        """Return the changes of states over spans."""
        way, left = np.zeros_like(begin), spans.copy()
        for _ in range(_MOST_STEPS):
            some = np.flatnonzero(left)
            if not len(some):
                return way
            here = begin[some] + way[some]
            longest = self._steps(here)
            if not np.all(longest > 0):
                return None
            step = np.clip(left[some], -longest, longest)
            way[some] += self._step(here, step)
            left[some] -= step
        return None

    def _steps(self, states: Floats) -> Floats:
        """Return the longest step from each state."""
        return np.asarray(_STEP / self._equations.paces(states))

    def _step(self, states: Floats, spans: Floats) -> Floats:
        """Return the changes of states in one step, which are followed by themselves: none is rounded."""

        def rates(_: Floats, changes: Floats) -> Floats:
            return self._equations.rates(states + changes.T).T

        return flow(rates, np.zeros_like(states.T), np.zeros_like(spans), spans, 1).T
