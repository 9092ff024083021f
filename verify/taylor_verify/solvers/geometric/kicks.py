"""Loads that a scene writes down, as kicks of the momentum before and after each free step.

    H -> H + h/2 M(t, H),  a free step of length h,  H = G + h/2 M(t + h, H) with G the momentum before

The second kick is the first one backwards, so that the whole is symmetric and of second order, also where
the loads read omega. With loads of attitude and time alone it is Strang's splitting, and a Poisson map.
"""

from __future__ import annotations

from typing import Final, final

from taylor_verify.models.problem import Problem
from taylor_verify.solvers.geometric.vectors import (
    Matrix,
    Quaternion,
    Vector,
    ahead,
    apply,
    conjugate,
    into,
    product,
)

# A fixed point is reached by then, or the step is too long for the loads.
_MOST_TURNS: Final = 100
_NEAR: Final = 2.0**-52
_WITHIN: Final = 2.0**-50


class Unreached(Exception):
    """The error for a step that is too long for the loads."""


@final
class Kicks:
    """The moment on the body of a problem, in the problem's units.

    Momentum, moment and attitude are in principal axes, if ``axes`` leads from these to the body's own.
    """

    def __init__(self, problem: Problem, K: Matrix, axes: Quaternion | None) -> None:
        units = problem.units
        self._problem, self._K, self._axes = problem, K, axes
        self._start, self._time = float(problem.given.clock.start), float(units.time)
        self._unit = float(units.time / units.momentum)
        ends = sorted(float(t) for t in (problem.begin, problem.times[-1]))
        # A switch at an end belongs to one of its sides, and these steps to the other.
        little = _WITHIN * (abs(self._start) / self._time + max(map(abs, ends)))
        self._first, self._last = ends[0] + little, ends[1] - little
        self.evaluations = 0

    def before(self, t: float, H: Vector, q: Quaternion | None, h: float) -> Vector:
        """Return the momentum after the kick before a free step of length h."""
        return ahead(H, h / 2, self._moment(t, H, q))

    def after(self, t: float, G: Vector, q: Quaternion | None, h: float) -> Vector:
        """Return the momentum after the kick behind the step, which ends at t.

        Raises Unreached where the equation for it is not solved by iteration.
        """
        H = G
        for _ in range(_MOST_TURNS):
            H, last = ahead(G, h / 2, self._moment(t, H, q)), H
            if max(abs(a - b) for a, b in zip(H, last, strict=True)) <= _NEAR * max(map(abs, H)):
                return H
        raise Unreached("the step is too long for the loads")

    def _moment(self, t: float, H: Vector, q: Quaternion | None) -> Vector:
        self.evaluations += 1
        omega = apply(self._K, H)
        if self._axes is not None:
            back = conjugate(self._axes)
            omega, q = into(back, omega), q and product(q, back)
        state = [*(w / self._time for w in omega), *(q or ())]
        inside = min(max(t, self._first), self._last)
        M = self._problem.loads(self._start + inside * self._time, state)
        a, b, c = (float(entry) * self._unit for entry in M)
        return (a, b, c) if self._axes is None else into(self._axes, (a, b, c))
