"""heyoka's Taylor integrator as a solver: typed, scaled, step-capped, bounded and checked.

What heyoka does silently by itself and why it cannot happen here:
a coefficient rounded to a double      all coefficients are parameters of the rung's own type
a state far from size one              the problem is posed in units of its own size
a small component lost beside a large  no step is longer than half the fastest linear time scale
an endless or a broken run             the number of steps is bounded and the outcome is read
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise
from math import isfinite
from time import perf_counter
from typing import Any, final

import heyoka as hy
import numpy as np

from verify.models.algebra import is_absent
from verify.models.form import Form
from verify.models.problem import Problem
from verify.models.rates import fastest_rate
from verify.scenes.precision import Rung
from verify.scenes.table import exact_number
from verify.solvers.solver import Solver
from verify.solvers.taylor.cache import use_own_cache
from verify.solvers.taylor.numbers import arithmetic, unavailable
from verify.solvers.trajectory import Outcome, Trajectory, from_scaled

# In units of the fastest linear rate at hand. heyoka's own step on a regular orbit is of this size;
# a start close to an unstable axis, where the step would grow with the logarithm of the distance,
# is what the cap is for.
_LONGEST_STEP = 0.5
# The rate is looked at again this many times along the way, and the fastest seen so far counts.
_SEGMENTS = 24
# A regular orbit takes three to five steps in the time of one radian, a close passage some more.
_STEPS_PER_RADIAN = 64
# What would take longer than days is not begun.
_MOST_RADIANS = 1e10
# Beyond this many states straight-line code compiles longer than it runs.
_LARGEST_STRAIGHT_LINE = 5

_OUTCOMES = {
    hy.taylor_outcome.time_limit: Outcome.FINISHED,
    hy.taylor_outcome.err_nf_state: Outcome.NON_FINITE,
    hy.taylor_outcome.step_limit: Outcome.STEP_LIMIT,
}


@final
@dataclass(frozen=True)
class Taylor(Solver):
    """heyoka at a tolerance, which bounds the error of a step: the rung's machine epsilon if None.

    heyoka takes the order from it.
    """

    name: str = "taylor"
    setting: str = ""
    tolerance: Fraction | None = None

    def unavailable(self, rung: Rung) -> str:
        return unavailable(rung)

    def solve(self, problem: Problem) -> Trajectory:
        began = perf_counter()
        integrator = _integrator(problem.form, problem.rung, self.tolerance)
        compiled = perf_counter()
        outcome, steps, rows = _propagate(integrator, problem)
        seconds = perf_counter() - compiled
        numbers = arithmetic(problem.rung)
        quantities = {}
        if outcome is Outcome.FINISHED:
            exact = [[numbers.exact(value) for value in row] for row in rows]
            quantities = from_scaled(problem, exact)
        return Trajectory(
            outcome=outcome,
            quantities=quantities,
            steps=steps,
            evaluations=steps * int(integrator.order),
            seconds=seconds,
            compile_seconds=compiled - began,
        )


def at_tolerance(text: str) -> Taylor:
    """The driver at a tolerance that is a decimal or a/b; ValueError for one that is not positive."""
    tolerance = exact_number(text)
    if not tolerance > 0:
        raise ValueError(f"expected a positive tolerance, got {text!r}")
    return Taylor(setting=f"tol={text}", tolerance=tolerance)


@lru_cache(maxsize=64)
def _integrator(form: Form, rung: Rung, tolerance: Fraction | None) -> Any:
    """One compiled integrator per form, rung and tolerance; the rest is filled in per problem."""
    use_own_cache()
    numbers = arithmetic(rung)
    zero = numbers.number(Fraction(0))
    states = hy.make_vars(*form.states)
    rates = form.rates(states, [hy.par[i] for i in range(len(form.parameters))])
    system = [
        (state, hy.expression(0.0) if is_absent(rate) else rate)
        for state, rate in zip(states, rates, strict=True)
    ]
    return hy.taylor_adaptive(
        system,
        state=np.array([zero] * len(states), dtype=numbers.fp_type),
        time=zero,
        pars=np.array([zero] * len(form.parameters), dtype=numbers.fp_type),
        fp_type=numbers.fp_type,
        compact_mode=numbers.compact or len(states) > _LARGEST_STRAIGHT_LINE,
        # heyoka takes 0 for the machine epsilon of the type.
        tol=zero if tolerance is None else numbers.number(rung.round(tolerance)),
    )


def _propagate(integrator: Any, problem: Problem) -> tuple[Outcome, int, list[Any]]:
    """Sample the problem's times; the outcome is FINISHED only if every row is there and finite."""
    numbers = arithmetic(problem.rung)
    integrator.time = numbers.number(Fraction(0))
    integrator.state[:] = numbers.array(problem.initial)
    integrator.pars[:] = numbers.array(problem.parameters)
    # The grid starts at the integrator's own time, asked for or not.
    grid = problem.times if problem.times[0] == 0 else (Fraction(0), *problem.times)
    rows, total_steps, outcome, rate = [integrator.state.copy()], 0, Outcome.FINISHED, 0.0
    for first, last in _segments(len(grid)):
        rate = max(rate, fastest_rate(problem, [float(value) for value in integrator.state]))
        if not isfinite(rate):
            return Outcome.NON_FINITE, total_steps, []
        radians = rate * float(abs(grid[last] - grid[first]))
        if not radians <= _MOST_RADIANS:
            return Outcome.STEP_LIMIT, total_steps, []
        status, _, _, steps, _, reached = integrator.propagate_grid(
            numbers.array(grid[first : last + 1]),
            max_delta_t=numbers.number(problem.rung.round(Fraction(_LONGEST_STEP / rate))),
            max_steps=1000 + int(_STEPS_PER_RADIAN * radians),
        )
        rows.extend(reached[1:])
        total_steps += int(steps)
        outcome = _OUTCOMES.get(status, Outcome.INTERRUPTED)
        if outcome is Outcome.FINISHED and not _are_finite(reached):
            outcome = Outcome.NON_FINITE
        if outcome is not Outcome.FINISHED:
            return outcome, total_steps, []
    if len(rows) != len(grid):
        return Outcome.INTERRUPTED, total_steps, []
    return outcome, total_steps, rows[len(grid) - len(problem.times) :]


def _segments(instants: int) -> list[tuple[int, int]]:
    """Stretches of the grid, as first and last index, with one step cap each."""
    pieces = min(instants - 1, _SEGMENTS)
    ends = sorted({round(k * (instants - 1) / pieces) for k in range(pieces + 1)}) if pieces else []
    return list(pairwise(ends))


def _are_finite(rows: np.ndarray[Any, Any]) -> bool:
    """x - x is 0 for a finite number of any type, and NaN for all others."""
    return all(bool(value - value == 0) for value in rows.flat)
