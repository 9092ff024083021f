"""SciPy's `solve_ivp`, an optional extra: `scipy:METHOD?rtol=NUMBER&atol=NUMBER`.

It integrates the problem's own equations, in units of size one, and answers at the samples with the
method's own interpolation, as `t_eval` does for any user of it. Under written loads it begins anew at
each switch and each instant; with `stop=no` one call steps over all of them.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from fractions import Fraction
from importlib import import_module
from importlib.util import find_spec
from math import isfinite
from time import perf_counter
from typing import Any, Final, final

import numpy as np

from taylor_verify.models.problem import Problem
from taylor_verify.numbers.precision import Rung
from taylor_verify.scenes.reading.positive import positive
from taylor_verify.solvers.between_switches import piece_by_piece
from taylor_verify.solvers.options import options
from taylor_verify.solvers.solver import Lack, Solver, float64_alone, raised
from taylor_verify.solvers.straight_line import Counted, Endless
from taylor_verify.solvers.trajectory import Outcome, Trajectory, of_rows
from taylor_verify.solvers.unstopped import Unstopped

METHODS: Final = ("RK45", "DOP853", "Radau", "BDF", "LSODA")

_INSTALL: Final = "pip install 'taylor-verify[scipy]'"
# The defaults of solve_ivp.
_RTOL, _ATOL = "1e-3", "1e-6"
# solve_ivp replaces a smaller one by this, and says so in a warning.
_LEAST_RTOL: Final = 100 * Fraction(1, 2**52)
# At some tens of microseconds an evaluation these take a quarter of an hour.
_MOST_EVALUATIONS: Final = 10**7


def unavailable(name: str, rung: Rung) -> str:
    """Return the reason why a solver made of SciPy cannot run on that rung here; empty where it can."""
    if reason := float64_alone(name, rung):
        return reason
    if find_spec("scipy") is None:
        return Lack(f"SciPy is not installed: {_INSTALL}", Outcome.NO_PACKAGE)
    try:
        import_module("scipy.integrate")
    except ImportError as error:
        return Lack(f"SciPy cannot be imported ({error}): {_INSTALL}", Outcome.NO_PACKAGE)
    return ""


@final
@dataclass(frozen=True)
class SciPy(Solver):
    """A method of `solve_ivp` at one pair of tolerances; atol counts in the problem's units."""

    method: str
    name: str
    rtol: float = float(_RTOL)
    atol: float = float(_ATOL)
    stops: bool = True
    counts_steps = True
    takes_loads = True

    def __post_init__(self) -> None:
        """Raise ValueError for a tolerance that is no positive number, or a method that is unknown."""
        if self.method not in METHODS:
            raise ValueError(f"expected one of {', '.join(METHODS)}, got {self.method!r} @ method")
        for place in ("rtol", "atol"):
            object.__setattr__(self, place, positive(getattr(self, place), place))

    def unavailable(self, rung: Rung) -> str:
        return unavailable(self.name, rung)

    def solve(self, problem: Problem) -> Trajectory:
        if reason := self.unavailable(problem.rung):
            return Trajectory(Outcome.NOT_STARTED, detail=reason)
        return piece_by_piece(problem, self._solve) if self.stops else self._solve(problem)

    def _solve(self, problem: Problem) -> Trajectory:
        asked = perf_counter()
        import_module("scipy.integrate")
        run = _Run(problem, self.stops)
        began = perf_counter()
        try:
            solution = run.solve(self)
        except Endless as error:
            seconds = perf_counter() - began
            return Trajectory(Outcome.STEP_LIMIT, detail=str(error), seconds=seconds)
        except _NotFinite:
            return Trajectory(Outcome.NON_FINITE, seconds=perf_counter() - began)
        except (ArithmeticError, ValueError, np.linalg.LinAlgError) as error:
            return raised(error)
        work: dict[str, Any] = {
            "steps": run.steps,
            "evaluations": run.rates.evaluations,
            "seconds": perf_counter() - began,
            "compile_seconds": began - asked,
        }
        rows = run.rows(solution)
        if solution.status != 0 or len(rows) != len(problem.times):
            detail = f"solve_ivp: {solution.message}"
            return Trajectory(Outcome.INTERRUPTED, detail=detail, **work)
        return of_rows(problem, rows, **work)


class _NotFinite(Exception):
    """A rate that is no number."""


class _Run:
    """A call of solve_ivp, its steps and evaluations counted."""

    def __init__(self, problem: Problem, stops: bool) -> None:
        self.problem, self.steps = problem, 0
        # On Python's own floats: those of a NumPy array take five times as long each.
        self.rates: Counted | Unstopped = (
            Counted(problem.form, list(map(float, problem.parameters)), _MOST_EVALUATIONS)
            if stops or problem.given.body.loads is None
            else Unstopped(problem, _MOST_EVALUATIONS)
        )

    def solve(self, asked: SciPy) -> Any:
        from scipy import integrate

        times = [float(t) for t in self.problem.times]
        with warnings.catch_warnings():
            # LSODA tells of a failure in a warning too; the outcome has it.
            warnings.simplefilter("ignore")
            return integrate.solve_ivp(
                self._finite_rates,
                (float(self.problem.begin), times[-1]),
                [float(value) for value in self.problem.initial_momenta],
                method=self._counted(getattr(integrate, asked.method)),
                t_eval=times,
                rtol=asked.rtol,
                atol=asked.atol,
            )

    def rows(self, solution: Any) -> list[list[Any]]:
        """Return the states at the samples, with the held values of a motion without stops."""
        rows: list[list[Any]] = solution.y.T.tolist()
        if not isinstance(self.rates, Unstopped):
            return rows
        return [
            [*row, *self.rates.held_at(t, row)] for t, row in zip(solution.t, rows, strict=True)
        ]

    def _finite_rates(self, t: float, state: Any) -> list[float]:
        rates = self.rates(t, state.tolist())
        if not all(map(isfinite, rates)):
            # With a step of NaN the explicit methods would try for ever.
            raise _NotFinite
        return rates

    def _counted(self, method: Any) -> Any:
        """Return the same method; solve_ivp says how often it evaluated, not how many steps it took."""

        def step(solver: Any) -> Any:
            self.steps += 1
            return method.step(solver)

        return type(method.__name__, (method,), {"step": step})


def named(name: str) -> SciPy:
    """Return the method of that name at its tolerances.

    Raises ValueError for a method that there is not, and for tolerances that are not positive or
    smaller than SciPy can take.
    """
    asked = options(name, METHODS, ["rtol", "atol", "stop"])
    rtol, atol = asked.positive("rtol", _RTOL), asked.positive("atol", _ATOL)
    if not rtol >= _LEAST_RTOL:
        raise ValueError(
            f"expected at least {float(_LEAST_RTOL):.3g}, SciPy's own bound, got "
            f"{asked.values['rtol']!r} @ rtol"
        )
    stops = asked.word("stop", ("yes", "no")) == "yes"
    return SciPy(asked.method, name, float(rtol), float(atol), stops)
