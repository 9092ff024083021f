"""What a trajectory achieved: its errors against the truth of one start on one rung, and its drift."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from math import inf, isnan

from mpmath import mp

from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Unsettled
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.judge.errors.drifts import drifts
from taylor_verify.judge.errors.state import largest, state_errors
from taylor_verify.judge.floor.arithmetic import MORE_DIGITS, truth_digits, working_bits
from taylor_verify.models.problem import Problem
from taylor_verify.scenes.motion import Motion
from taylor_verify.solvers.trajectory import Trajectory

# As the judge has them: the truth is a thousandth of a unit of roundoff wide, differences lose no
# more than their leading bits.


@dataclass(frozen=True)
class Accuracy:
    """Errors by tracked quantity, in the judge's units; NaN where an answer is no number.

    Each is the error's size and the truth's own width together, so that the error is no larger.
    ``drift`` is the largest of all conserved quantities, ``drifting`` its name; None under loads,
    which leave nothing conserved.
    """

    max: Mapping[str, float] = field(default_factory=dict)
    final: Mapping[str, float] = field(default_factory=dict)
    drift: float | None = None
    drifting: str = ""

    @property
    def worst(self) -> float:
        """The largest of all tracked quantities; NaN if one is, infinite where none was compared."""
        return float(largest(self.max.values())) if self.max else inf


class Truth:
    """The exact motion of one problem, that every answer to it is compared with.

    Raises Unsettled where its digits cannot be had.
    """

    def __init__(self, problem: Problem) -> None:
        bits = problem.rung.bits
        self._given, self._bits = problem.given, working_bits(bits)
        self._digits = truth_digits(bits)
        try:
            self._motion, self._start = self._evaluate(closed=True)
        except Unsettled:
            self._motion, self._start = self._evaluate(closed=False)

    def _evaluate(self, closed: bool) -> tuple[Motion, Motion]:
        """The motion at the samples and at the start; beside a degenerate orbit, by Taylor series."""
        exact = solution(self._given) if closed else TaylorSolution(self._given)
        motion = exact.motion(self._given.clock.elapsed, self._digits)
        return motion, exact.motion([Fraction(0)], self._digits + MORE_DIGITS)

    def accuracy(self, trajectory: Trajectory) -> Accuracy:
        """Of a trajectory that finished."""
        with mp.workprec(self._bits):
            answer = trajectory.motion(self._bits)
            states = state_errors(self._given, self._motion, answer)
            bounds = {errors.quantity: errors.values + errors.truth_radius for errors in states}
            found = {name: float(largest(values)) for name, values in bounds.items()}
            final = {name: float(values[-1]) for name, values in bounds.items()}
            drift = self._drift(answer, trajectory) if self._given.body.is_free else {}
        if not drift:
            return Accuracy(found, final)
        # NaN is larger than any.
        name = max(drift, key=lambda key: (isnan(drift[key]), drift[key]))
        return Accuracy(found, final, drift[name], name)

    def _drift(self, answer: Motion, trajectory: Trajectory) -> dict[str, float]:
        own = trajectory.quantities
        found = drifts(self._given, self._start, self._motion, answer, own, self._digits)
        return {invariant.name: float(largest(errors.values)) for invariant, errors in found}
