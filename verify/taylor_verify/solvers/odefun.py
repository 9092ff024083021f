"""mpmath's own integrator: `mpmath:odefun?tol=NUMBER&degree=NUMBER`.

It sums Taylor series whose coefficients come from finite differences of the equations, at a
precision that grows with the degree. So it is a second integrator of any precision that shares no code
with heyoka's, and some hundred times slower.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from time import perf_counter
from typing import Any, Final, final

from mpmath import mp

from taylor_verify.models.problem import Problem
from taylor_verify.numbers.precision import Rung, held_exactly
from taylor_verify.solvers.between_switches import piece_by_piece
from taylor_verify.solvers.options import options
from taylor_verify.solvers.solver import Solver, raised
from taylor_verify.solvers.straight_line import Counted, Endless
from taylor_verify.solvers.trajectory import Outcome, Trajectory, of_rows

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
    counts_steps = True
    takes_loads = True

    def unavailable(self, rung: Rung) -> str:
        if rung.name == "f64" or rung.emin is None:
            return ""
        return f"{self.name} has mpmath's numbers: f64 (their first 53 bits) and mpN alone"

    def solve(self, problem: Problem) -> Trajectory:
        if reason := self.unavailable(problem.rung):
            return Trajectory(Outcome.NOT_STARTED, detail=reason)
        return piece_by_piece(problem, self._solve)

    def _solve(self, problem: Problem) -> Trajectory:
        parameters = [held_exactly(value) for value in problem.parameters]
        rates = Counted(problem.form, parameters, _MOST_EVALUATIONS)
        began = perf_counter()
        try:
            # mpmath works with these bits; a wider exponent than a double's does not show here.
            with mp.workprec(problem.rung.bits):
                rows = self._rows(problem, rates)
                # odefun takes this degree if it is told none.
                degree = self.degree or 3 + int(3 * mp.dps / 2.0)
        except Endless as error:
            seconds = perf_counter() - began
            return Trajectory(Outcome.STEP_LIMIT, detail=str(error), seconds=seconds)
        except (ArithmeticError, ValueError) as error:
            return raised(error)
        return of_rows(
            problem,
            rows,
            mp.isfinite,
            # A series takes as many evaluations as it has terms but the first.
            steps=rates.evaluations // degree,
            evaluations=rates.evaluations,
            seconds=perf_counter() - began,
        )

    def _rows(self, problem: Problem, rates: Counted) -> list[Sequence[Any]]:
        # odefun only goes forwards: a motion backwards is the forward motion with opposite rates.
        direction = -1 if problem.times[-1] < 0 else 1
        state = mp.odefun(
            lambda t, state: [direction * rate for rate in rates(direction * t, state)],
            held_exactly(abs(problem.begin)),
            [held_exactly(value) for value in problem.initial_momenta],
            tol=None if self.tol is None else mp.mpf(self.tol.numerator) / self.tol.denominator,
            degree=self.degree,
        )
        return [state(held_exactly(abs(t))) for t in problem.times]


def named(name: str) -> Odefun:
    """Return the integrator at its tolerance and degree.

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
    return Odefun(name, tol, asked.whole("degree", 2, _MOST_DEGREE))
