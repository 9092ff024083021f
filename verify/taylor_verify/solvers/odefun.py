"""mpmath's own integrator, at hand wherever SymPy is: `mpmath:odefun?tol=NUMBER&degree=NUMBER`.

It sums Taylor series whose coefficients come from finite differences of the equations, at a
precision that grows with the degree. So it is a second integrator of any precision that shares no code
with heyoka's, and some hundred times slower.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from time import perf_counter
from typing import Any, Final, final

from mpmath import mp

from taylor_verify.models.problem import Problem
from taylor_verify.scenes.precision import Rung, exact_value, held_exactly
from taylor_verify.solvers.options import options
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.straight_line import straight_line
from taylor_verify.solvers.trajectory import Outcome, Postponed, Trajectory

PREFIX: Final = "mpmath:"
METHODS: Final = ("odefun",)

# At a tenth of a millisecond to some milliseconds an evaluation these take a few minutes.
_MOST_EVALUATIONS: Final = 10**6
# Twice what mpmath takes of itself on the widest rung; a series costs the square of its degree.
_MOST_DEGREE: Final = 1000


@final
@dataclass(frozen=True)
class Odefun(Solver):
    """`mpmath.odefun` with the rung's bits; ``tol`` and ``degree`` are its own where None.

    ``tol`` bounds the last term of each series, in the problem's units.
    """

    name: str
    tol: Fraction | None = None
    degree: int | None = None
    setting: str = ""
    counts_steps = True

    def unavailable(self, rung: Rung) -> str:
        if rung.name == "f64" or rung.emin is None:
            return ""
        return f"{self.name} has mpmath's numbers: f64 (their first 53 bits) and mpN alone"

    def solve(self, problem: Problem) -> Trajectory:
        if reason := self.unavailable(problem.rung):
            return Trajectory(Outcome.NOT_STARTED, detail=reason)
        run = _Run(problem)
        began = perf_counter()
        try:
            # mpmath works with these bits; a wider exponent than a double's does not show here.
            with mp.workprec(problem.rung.bits):
                rows = run.rows(self)
        except _Endless:
            detail = f"{run.evaluations} evaluations"
            return Trajectory(Outcome.STEP_LIMIT, detail=detail, seconds=perf_counter() - began)
        except (ArithmeticError, ValueError) as error:
            return Trajectory(Outcome.RAISED, detail=f"{type(error).__name__}: {error}")
        seconds = perf_counter() - began
        if not all(mp.isfinite(value) for row in rows for value in row):
            return Trajectory(Outcome.NON_FINITE, seconds=seconds)
        return Trajectory(
            Outcome.FINISHED,
            Postponed(problem, lambda: [[exact_value(v) for v in row] for row in rows]),
            # A series takes as many evaluations as it has terms but the first.
            steps=run.evaluations // (self.degree or _own_degree(problem.rung)),
            evaluations=run.evaluations,
            seconds=seconds,
        )


class _Endless(Exception):
    """More evaluations than a run may take."""


class _Run:
    """One call of odefun, its evaluations counted."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        # odefun knows no time before its start: a motion backward is that of the opposite rates.
        self.direction = -1 if problem.times[-1] < 0 else 1
        self.evaluations = 0

    def rows(self, asked: Odefun) -> list[Sequence[Any]]:
        problem = self.problem
        state = mp.odefun(
            self._rates(),
            mp.zero,
            [held_exactly(value) for value in problem.initial_momenta],
            tol=None if asked.tol is None else mp.mpf(asked.tol.numerator) / asked.tol.denominator,
            degree=asked.degree,
        )
        return [state(held_exactly(abs(t))) for t in problem.times]

    def _rates(self) -> Callable[[Any, Sequence[Any]], list[Any]]:
        problem = self.problem
        forward = straight_line(problem.form, [held_exactly(v) for v in problem.parameters])

        def rates(t: Any, state: Sequence[Any]) -> list[Any]:
            self.evaluations += 1
            if not self.evaluations <= _MOST_EVALUATIONS:
                raise _Endless
            return [self.direction * rate for rate in forward(t, state)]

        return rates


def _own_degree(rung: Rung) -> int:
    """The degree that odefun takes at this precision if it is told none."""
    with mp.workprec(rung.bits):
        return 3 + int(3 * mp.dps / 2.0)


def named(name: str) -> Odefun:
    """The integrator at its tolerance and degree.

    Raises ValueError for a method that there is not, a tolerance outside 0 to 1, and a degree
    that is no whole number from 2 to a thousand.
    """
    asked = options(name, METHODS, ["tol", "degree"])
    tol = asked.positive("tol", "") if "tol" in asked else None
    if tol is not None and not tol <= 1:
        # mpmath would ask for a negative number of bits, and never end.
        raise ValueError(f"expected a tolerance of at most 1, got {asked.values['tol']!r} @ tol")
    if "degree" not in asked:
        return Odefun(name, tol)
    degree = asked.positive("degree", "")
    if degree.denominator != 1 or not 2 <= degree <= _MOST_DEGREE:
        text = asked.values["degree"]
        expected = f"a whole number from 2 to {_MOST_DEGREE}"
        raise ValueError(f"expected {expected}, got {text!r:.60} @ degree")
    return Odefun(name, tol, int(degree))
