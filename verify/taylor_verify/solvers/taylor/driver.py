"""heyoka's Taylor integrator as a solver: typed, scaled, step-capped, bounded and checked.

What heyoka does silently by itself and why it cannot happen here:
a coefficient rounded to a double      all coefficients are parameters of the rung's own type
a state far from size one              the problem is posed in units of its own size
a small component lost beside a large  no step is longer than 5/8 of the fastest linear time scale
impulses lost beside a long path       each stretch of the path is counted from where it begins
an interrupt held until the end        no stretch takes longer than about half a second
an endless or a broken run             the number of steps is bounded and the outcome is read
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from itertools import pairwise
from math import ceil, isfinite
from time import perf_counter
from typing import Any, NamedTuple, final

import numpy as np

from taylor_verify.models.algebra import is_absent
from taylor_verify.models.form import Form
from taylor_verify.models.problem import Problem
from taylor_verify.models.rates import Linearised
from taylor_verify.scenes.precision import Rung
from taylor_verify.solvers.options import options
from taylor_verify.solvers.registry import TAYLOR
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.taylor.cache import heyoka_cache_off, stored
from taylor_verify.solvers.taylor.numbers import Arithmetic, arithmetic, unavailable
from taylor_verify.solvers.trajectory import Outcome, Postponed, Trajectory

# In units of the fastest linear rate at hand. heyoka's own step on a regular orbit is of this size;
# a start close to an unstable axis, where the step would grow with the logarithm of the distance,
# is what the cap is for.
LONGEST_STEP = 0.5
# heyoka is called once, since each call cuts a step short. If the rate, looked at afterwards, says that a
# step was longer than this factor allows, the way is gone again with looks so many radians apart, no more
# and no less often than this: a call leads from each to the next, and the fastest rate so far counts.
_SLACK = 1.25
_RADIANS_APART = 4
_FEWEST_LOOKS, _MOST_LOOKS = 4, 24
# A regular orbit takes three to five steps in the time of one radian, a close passage some more. Beyond
# this bound a run has gone astray.
LEAST_STEPS, STEPS_PER_RADIAN = 1000, 64
# What would take longer than days is not begun.
MOST_RADIANS = 1e10
# That takes about half a second where the processor has the arithmetic. A wide rung calls back after
# each step instead, which costs a tenth of a microsecond: nothing beside its steps, but much here.
_RADIANS_AT_ONCE = {"f32": 5e5, "f64": 5e5, "f80": 5e4}
# Beyond this many states optimising straight-line code takes longer than it runs.
_LARGEST_STRAIGHT_LINE = 5
# Where code may be left as it is, it is optimised for ways longer than this, in the units of time. Loops
# run up to twice as fast then (f80), MPFR's calls by a quarter, f128's not at all; in some hundred steps
# that is what optimising takes.
_LONG_WAY = 50
# The standard set asks for nearly four hundred, a scene's rungs one after the other.
_MOST_COMPILED = 128

# A row of the states for each instant.
Rows = np.ndarray[Any, Any]


@final
@dataclass(frozen=True)
class Taylor(Solver):
    """heyoka at a tolerance, which bounds the error of a step: the rung's machine epsilon if None.

    heyoka takes the order from it.
    """

    name: str = "taylor"
    setting: str = ""
    tolerance: Fraction | None = None
    counts_steps = True

    def unavailable(self, rung: Rung) -> str:
        if self.tolerance is not None and not rung.round(self.tolerance) > 0:
            # heyoka would take it for its own default.
            return f"{rung.name} has no number for a tolerance so small"
        return unavailable(rung)

    def solve(self, problem: Problem) -> Trajectory:
        began = perf_counter()
        numbers = arithmetic(problem.rung)
        times = numbers.times(problem.times)
        # Of doubles there is one code for every way.
        is_long = numbers.is_quick_plain or abs(float(times[-1])) > _LONG_WAY
        compiling = perf_counter()
        integrator = compiled(problem.form, problem.rung, self.tolerance, is_long=is_long)
        compile_seconds = perf_counter() - compiling
        outcome, steps, rows, inner = _propagate(integrator, problem, times)
        seconds = perf_counter() - began - compile_seconds
        quantities: Mapping[str, Any] = {}
        if outcome is Outcome.FINISHED:
            # Exact numbers of many samples take longer than the samples: the judge asks for them.
            quantities = Postponed(
                problem,
                lambda: [[numbers.exact(v) for v in row] for row in rows],
            )
        return Trajectory(
            outcome=outcome,
            quantities=quantities,
            steps=steps,
            evaluations=steps * int(integrator.order),
            seconds=seconds,
            compile_seconds=compile_seconds,
            inner_seconds=inner,
        )


def at_tolerance(text: str) -> Taylor:
    """Return the driver at a tolerance, a decimal or a/b; ValueError for one that is not positive."""
    return named(f"{TAYLOR}?tol={text}")


def named(name: str) -> Taylor:
    """Return the driver that `taylor` or `taylor?tol=NUMBER` names; ValueError for any other name."""
    return Taylor(name, tolerance=tolerance(name))


def tolerance(name: str) -> Fraction | None:
    """Return the tolerance that is set in a name, exactly as written; None for the rung's own.

    Raises ValueError for a tolerance that is no positive number, and for a name of something else.
    """
    if name == TAYLOR:
        return None
    return options(name, [TAYLOR], ["tol"]).positive("tol", default="")


@lru_cache(maxsize=_MOST_COMPILED)
def compiled(
    form: Form,
    rung: Rung,
    tolerance: Fraction | None,
    literals: tuple[Fraction, ...] | None = None,
    is_long: bool = True,
) -> Any:
    """Return the one compiled integrator of a form, rung and tolerance; the rest is filled in per problem.

    Parameters cost what literals cost, and serve every body: literals are for measuring that. What it
    computes does not depend on ``is_long``, which tells what pays: optimised loops compute the same to the
    last bit. Optimised straight-line code of doubles does not, because it fuses products with sums.
    """
    import heyoka as hy

    numbers = arithmetic(rung)
    zero = numbers.number(Fraction(0))
    if literals is None:
        coefficients = [hy.par[i] for i in range(len(form.parameters))]
    else:
        coefficients = [hy.expression(numbers.number(value)) for value in literals]
    system = equations(form, coefficients)
    passed = len(form.parameters) if literals is None else 0
    is_small = len(system) <= _LARGEST_STRAIGHT_LINE
    is_optimised = is_small if numbers.is_quick_plain else is_long
    options = {
        "state": np.array([zero] * len(system), dtype=numbers.fp_type),
        "time": zero,
        "pars": np.array([zero] * passed, dtype=numbers.fp_type),
        "fp_type": numbers.fp_type,
        "compact_mode": numbers.compact or not (is_small or numbers.is_quick_plain),
        "opt_level": 3 if is_optimised else 0,
        # heyoka takes 0 for the machine epsilon of the type.
        "tol": zero if tolerance is None else numbers.number(rung.round(tolerance)),
    }
    if numbers.is_found_again:
        return stored(hy.taylor_adaptive, system, **options)
    heyoka_cache_off()
    return hy.taylor_adaptive(system, **options)


def equations(form: Form, coefficients: Sequence[Any]) -> list[tuple[Any, Any]]:
    """Return the states of a form as heyoka's variables, each with its rate."""
    import heyoka as hy

    states = hy.make_vars(*form.states)
    rates = form.rates(states, coefficients)
    return [
        (state, hy.expression(0.0) if is_absent(rate) else rate)
        for state, rate in zip(states, rates, strict=True)
    ]


def _propagate(
    integrator: Any, problem: Problem, times: np.ndarray[Any, Any]
) -> tuple[Outcome, int, Rows, float]:
    """Return the outcome, the number of steps, the rows, and the seconds that heyoka's own code took.

    The outcome is FINISHED only if every row is there and finite; else the rows are no answer. Steps and
    seconds are those of the way whose rows these are.
    """
    numbers = arithmetic(problem.rung)
    integrator.pars[:] = numbers.array(problem.parameters)
    linearised = Linearised(problem)
    start = numbers.array(problem.initial_momenta)
    rate = linearised.fastest(start)
    if not isfinite(rate):
        return Outcome.NON_FINITE, 0, start[None], 0.0
    # In these units the motion is of size one, also one that is at rest when it begins.
    radians = max(rate, 1.0) * abs(float(times[-1]))
    looks = _looks(radians, problem.rung)
    grid, samples = _grid(problem, times, numbers, looks)
    way = _Way(integrator, problem, linearised, start, grid)
    calls = looks if way.path else _calls(radians, problem.rung)
    ran = way.run(_segments(len(grid), calls), rate)
    if way.was_too_fast(ran, rate):
        ran = way.run(_segments(len(grid), looks), rate, is_watched=True)
    outcome, rows = ran.outcome, ran.rows
    if outcome is Outcome.FINISHED and len(rows) != len(grid):
        outcome = Outcome.INTERRUPTED
    if outcome is Outcome.FINISHED:
        rows = rows[samples]
    return outcome, ran.steps, rows, ran.seconds


class _Ran(NamedTuple):
    """A way as far as it went: its longest step, its steps, and the seconds of heyoka's own code."""

    outcome: Outcome
    rows: Rows
    longest: float
    steps: int
    seconds: float


@final
@dataclass(frozen=True)
class _Way:
    """A problem on its way over a grid of instants, stretch by stretch, from its start."""

    integrator: Any
    problem: Problem
    linearised: Linearised
    start: np.ndarray[Any, Any]
    grid: np.ndarray[Any, Any]

    @cached_property
    def path(self) -> list[int]:
        """The places of the centre among the states.

        heyoka's tolerance is a part of the largest state, and the path has no bound: nothing depends on the
        centre, so that it may be counted from anywhere.
        """
        return [i for i, name in enumerate(self.problem.form.states) if name.startswith("c")]

    def run(
        self, stretches: Sequence[tuple[int, int]], rate: float, is_watched: bool = False
    ) -> _Ran:
        """Go the whole way, from one index of the grid to the next, in steps that suit the rate.

        Where it is watched, the rate is looked at after each stretch, and the fastest so far counts.
        """
        integrator, path, grid = self.integrator, self.path, self.grid
        zero = grid[0]
        integrator.time = zero
        integrator.state[:] = self.start
        rows, longest, steps, seconds = [self.start[None]], 0.0, 0, 0.0
        began_at, outcome = self.start[path], Outcome.FINISHED
        for first, last in stretches:
            radians = rate * abs(float(grid[last] - grid[first]))
            if not radians <= MOST_RADIANS:
                outcome = Outcome.STEP_LIMIT if isfinite(rate) else Outcome.NON_FINITE
                break
            integrator.state[path] = zero
            began = perf_counter()
            status, _, max_h, taken, _, reached = integrator.propagate_grid(
                grid[first : last + 1], **self._limits(rate, radians)
            )
            seconds += perf_counter() - began
            longest, steps = max(longest, float(max_h)), steps + int(taken)
            if path:
                reached[:, path] += began_at
                began_at = reached[-1, path]
            rows.append(reached[1:])
            if is_watched:
                rate = max(rate, self.linearised.fastest(reached[-1]))
            outcome = outcome_of(status)
            if outcome is Outcome.FINISHED and not np.isfinite(reached).all():
                outcome = Outcome.NON_FINITE
            if outcome is not Outcome.FINISHED:
                break
        return _Ran(outcome, np.concatenate(rows), longest, steps, seconds)

    def was_too_fast(self, ran: _Ran, rate: float) -> bool:
        """Return True where the rate has grown, and steps were too long for it or ran out for it."""
        some = ran.rows[:: -ceil(len(ran.rows) / _MOST_LOOKS)]
        if ran.outcome is Outcome.FINISHED:
            # A bound that is soon found is nearly always enough.
            return all(
                self.linearised.fastest(some, squarings) * ran.longest > _SLACK * LONGEST_STEP
                for squarings in (2, 4)
            )
        return self.linearised.fastest(some) > rate

    def _limits(self, rate: float, radians: float) -> dict[str, Any]:
        """Return the longest step, the number of steps, and what listens to an interrupt."""
        rung = self.problem.rung
        return {
            "max_delta_t": arithmetic(rung).double(LONGEST_STEP / rate),
            "max_steps": LEAST_STEPS + int(STEPS_PER_RADIAN * radians),
            "callback": None if rung.name in _RADIANS_AT_ONCE else _go_on,
        }


def outcome_of(status: Any) -> Outcome:
    """Return the outcome that heyoka's own word stands for."""
    import heyoka as hy

    known = {
        hy.taylor_outcome.time_limit: Outcome.FINISHED,
        hy.taylor_outcome.err_nf_state: Outcome.NON_FINITE,
        hy.taylor_outcome.step_limit: Outcome.STEP_LIMIT,
    }
    return known.get(status, Outcome.INTERRUPTED)


def _looks(radians: float, rung: Rung) -> int:
    """Return how often the rate is looked at on a way so long, and an interrupt heard."""
    if not radians <= MOST_RADIANS:
        return _MOST_LOOKS
    looks = min(max(_FEWEST_LOOKS, ceil(radians / _RADIANS_APART)), _MOST_LOOKS)
    return max(looks, _calls(radians, rung))


def _calls(radians: float, rung: Rung) -> int:
    """Return how often heyoka is called on a way so long, that an interrupt may be heard."""
    at_once = _RADIANS_AT_ONCE.get(rung.name)
    return 1 if at_once is None or not radians <= MOST_RADIANS else max(1, ceil(radians / at_once))


def _grid(
    problem: Problem, times: np.ndarray[Any, Any], numbers: Arithmetic, pieces: int
) -> tuple[np.ndarray[Any, Any], slice | list[int]]:
    """Return the instants that heyoka is asked for, and where the samples are among them.

    They begin at its own time, asked for or not. Between few samples there are more, so that the
    rate and the path are looked at as often there as between many.
    """
    zero = numbers.array([Fraction(0)])
    grid = times if times[0] == zero[0] else np.concatenate([zero, times])
    if len(grid) > pieces:
        return grid, slice(len(grid) - len(times), None)
    exact = list(problem.times) if len(grid) == len(times) else [Fraction(0), *problem.times]
    instants, samples = exact[:1], [0]
    for after, before in pairwise(exact):
        instants += _waypoints(after, before, abs(exact[-1]) / pieces, problem.rung)
        samples.append(len(instants))
        instants.append(before)
    return numbers.array(instants), samples[len(grid) - len(times) :]


def _waypoints(after: Fraction, before: Fraction, gap: Fraction, rung: Rung) -> list[Fraction]:
    """Return numbers of the rung between two others, in order and no farther apart than about ``gap``."""
    pieces = ceil(abs(before - after) / gap)
    found = [after]
    for k in range(1, pieces):
        instant = rung.round(after + (before - after) * Fraction(k, pieces))
        if min(found[-1], before) < instant < max(found[-1], before):
            found.append(instant)
    return found[1:]


def _go_on(integrator: Any) -> bool:
    """Go on; heyoka returns to the interpreter for it, where an interrupt is waiting to be heard."""
    del integrator
    return True


def _segments(instants: int, pieces: int) -> list[tuple[int, int]]:
    """Return stretches of the grid, as first and last index, with one step cap each."""
    pieces = min(instants - 1, pieces)
    ends = sorted({round(k * (instants - 1) / pieces) for k in range(pieces + 1)}) if pieces else []
    return list(pairwise(ends))
