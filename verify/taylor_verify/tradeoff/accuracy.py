"""Accuracy of a trajectory: its errors against the exact motion of the same rounded data, and its drift."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from fractions import Fraction
from math import inf, isnan

from mpmath import mp

from taylor_verify.exact.conditioning.loaded import truth
from taylor_verify.exact.invariants import invariants
from taylor_verify.exact.solution import Solution, Unsettled
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.judge.errors.drifts import Drifts
from taylor_verify.judge.errors.state import largest, state_errors
from taylor_verify.judge.floor.arithmetic import MORE_DIGITS, truth_digits, working_bits
from taylor_verify.models.problem import Problem
from taylor_verify.numbers.precision import Rung
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.motion import Motion, State
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.trajectory import Outcome, Trajectory


@dataclass(frozen=True)
class Accuracy:
    """Errors by tracked quantity, in the judge's units; NaN where an answer is no number.

    ``max`` is the largest over all samples, ``final`` that of the last sample. Each is an upper bound: the
    error plus the width of the truth. ``drift`` is the largest drift of a conserved quantity, and
    ``drifting`` the name of that quantity; None and empty under loads that conserve nothing.
    """

    max: Mapping[str, float] = field(default_factory=dict)
    final: Mapping[str, float] = field(default_factory=dict)
    drift: float | None = None
    drifting: str = ""

    @property
    def worst(self) -> float:
        """The largest error of all tracked quantities; NaN if one is NaN, infinite if none was compared."""
        return float(largest(self.max.values())) if self.max else inf


class Truth:
    """The exact motion of one problem, with which all answers are compared.

    Its width is a thousandth of the unit roundoff, as for the judge. Raises Unsettled if the exact motion
    does not reach its digits.
    """

    def __init__(self, problem: Problem) -> None:
        bits = problem.rung.bits
        self._given, self._bits = problem.given, working_bits(bits)
        self._digits = truth_digits(bits)
        try:
            self._motion, self._start = self._evaluated(truth(self._given, self._digits))
        except Unsettled:
            # Near a degenerate orbit the closed form loses digits that Taylor series have.
            self._motion, self._start = self._evaluated(TaylorSolution(self._given))

    def _evaluated(self, exact: Solution) -> tuple[Motion, Motion]:
        """Return the motion at the samples and at the start."""
        motion = exact.motion(self._given.clock.elapsed, self._digits)
        return motion, exact.motion([Fraction(0)], self._digits + MORE_DIGITS)

    def accuracy(self, trajectory: Trajectory) -> Accuracy:
        """Return the accuracy of a finished trajectory."""
        given = self._given
        with mp.workprec(self._bits):
            answer = trajectory.motion(self._bits)
            states = state_errors(given, self._motion, answer)
            bounds = {errors.quantity: errors.values + errors.truth_radius for errors in states}
            most = {name: float(largest(values)) for name, values in bounds.items()}
            final = {name: float(values[-1]) for name, values in bounds.items()}
            conserved = [each for each in invariants(given) if each.is_conserved]
            drifts = Drifts(given, self._start, self._digits, conserved)
            drifts.add(given.clock.elapsed, self._motion, answer, trajectory.quantities)
            sizes = [(float(largest(e.values)), invariant.name) for invariant, e in drifts.errors()]
        # NaN counts as larger than any number.
        drift, drifting = max(sizes, key=lambda size: (isnan(size[0]), size[0]), default=(None, ""))
        return Accuracy(most, final, drift, drifting)


class Truths:
    """The truth of each scene and rung, evaluated once."""

    def __init__(self) -> None:
        self._known: dict[tuple[Scene, Rung, Body, State], Truth | None] = {}

    def accuracy(self, problem: Problem, trajectory: Trajectory) -> Accuracy | None:
        """Return the accuracy; None for an unfinished run, and if the truth does not reach its digits."""
        if trajectory.outcome is not Outcome.FINISHED:
            return None
        # Solvers may round the data of a scene differently.
        key = problem.scene, problem.rung, problem.given.body, problem.given.initial
        if key not in self._known:
            self._known[key] = None
            with suppress(Unsettled):
                self._known[key] = Truth(problem)
        truth = self._known[key]
        return truth.accuracy(trajectory) if truth is not None else None
