"""The way of one problem through its instants: heyoka's steps, limited, checked and counted."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise
from math import ceil, inf, isfinite
from time import perf_counter
from typing import Any, Final, NamedTuple, final

import numpy as np

from taylor_verify.models.fastest_rate import Linearised
from taylor_verify.models.problem import Problem
from taylor_verify.numbers.precision import Rung
from taylor_verify.solvers.taylor.differenced import Differenced
from taylor_verify.solvers.taylor.numbers import arithmetic
from taylor_verify.solvers.trajectory import Outcome

# In units of the fastest linear rate at hand. A start close to an unstable axis, where heyoka's own step
# would grow with the logarithm of the distance, is what the cap is for. A step h leaves out h^(p+1)/(p+1)!
# of a component that grows or turns at that rate, however small it is beside the others: with h = p/20 less
# than a thousandth of a rounding, since heyoka takes p from the rounding. Longer steps of high orders would
# do that too, but they go into a flip, whose pole is near, and lose hundreds of units.
_LONGEST_STEP, _FULL_ORDER = 1.0, 20
# heyoka is called once, since each call cuts a step short. If the rate, looked at afterwards, says that a
# step was longer than this factor allows, the way is gone again: at once in steps that suit its fastest
# rate, where that takes less than so many times the steps,
_SLACK: Final = 1.25
_MORE_STEPS: Final = 2.0
# else with looks so many radians apart, no more and no less often than this: a call leads from each to the
# next, and the fastest rate so far counts.
_RADIANS_APART: Final = 4
_FEWEST_LOOKS, _MOST_LOOKS = 4, 24
_ROWS_LOOKED_AT: Final = 16
# Steps of which the longest is shorter than this part of the cap were not cut to it.
_UNCUT: Final = 0.9
# A regular orbit takes three to five steps in the time of one radian, a close passage some more. Beyond
# this bound a run has gone astray.
LEAST_STEPS, STEPS_PER_RADIAN = 1000, 64
# Loads may change faster than the motion does.
_LOADED: Final = 100
# What would take longer than days is not begun.
MOST_RADIANS: Final = 1e10
# That takes about half a second where the processor has the arithmetic. A wide rung calls back after
# each step instead, which costs a tenth of a microsecond: nothing beside its steps, but much here.
_RADIANS_AT_ONCE = {"f32": 5e5, "f64": 5e5, "f80": 5e4}
# A crossing of a kink may take a step of no length.
_MOST_STANDING: Final = 8

# A row of the states for each instant.
Rows = np.ndarray[Any, Any]
Places = slice | list[int]


class Ran(NamedTuple):
    """A way as far as it went: its longest step, its steps, and the seconds of heyoka's own code."""

    outcome: Outcome
    rows: Rows
    longest: float
    steps: int
    seconds: float


class _Course(NamedTuple):
    """A plan of a way: its instants with the samples among them, in so many calls, in steps for a rate.

    Where it is watched, the rate is looked at after each call, and the fastest so far counts.
    """

    grid: np.ndarray[Any, Any]
    samples: Places
    calls: int
    rate: float
    is_watched: bool = False

    @property
    def stretches(self) -> list[np.ndarray[Any, Any]]:
        """The instants of each call, of which the last begins the next."""
        if self.calls == 1:
            return [self.grid]
        last = len(self.grid) - 1
        pieces = min(last, self.calls)
        ends = sorted({round(k * last / pieces) for k in range(pieces + 1)}) if pieces else []
        return [self.grid[start : end + 1] for start, end in pairwise(ends)] or [self.grid]


@final
class Way:
    """A problem on its way from its start through its instants.

    ``integrator`` is that of the problem's form, shared with other problems: each run fills it in anew.
    ``looked_at`` is the same problem with the kinks of its loads, where those were taken out.
    ``numbers`` are those of its rung, and ``order`` is that of its Taylor series.
    """

    def __init__(self, integrator: Any, problem: Problem, looked_at: Problem | None = None) -> None:
        numbers = arithmetic(problem.rung)
        self._integrator, self._problem = integrator, problem
        # Views of heyoka's own memory.
        self._pars, self._state = integrator.pars, integrator.state
        self.numbers, self.order = numbers, int(integrator.order)
        self._longest = longest_step(self.order)
        self._parameters = numbers.array(problem.parameters)
        self._start = numbers.array(problem.initial_momenta)
        self._times = numbers.array(problem.times)
        self._is_loaded = problem.given.body.loads is not None
        self._linearised = (
            Differenced(looked_at or problem) if self._is_loaded else Linearised(problem)
        )
        self._rate = self._linearised.fastest(self._start)
        # In these units the motion is of size one, also one that is at rest when it begins.
        span = abs(float(self._times[-1]) - float(problem.begin))
        if not span:
            raise OverflowError("the span is beyond the doubles")
        self._radians = max(self._rate, 1.0) * span
        self._calls = _calls(self._radians, problem.rung)
        self._grid = self._instants(self._calls)
        self._course: _Course | None = None

    def run(self, foreseen: Callable[[], float] = lambda: 0.0) -> Ran:
        """Go the whole way, in steps that suit its rate at the start and the one foreseen.

        The outcome is FINISHED only if a row is there for every sample, and finite; else the rows are no
        answer. Steps and seconds are those of the run whose rows these are. A further run is the same to
        the last bit: it takes the course that the first one has found, and looks at no rates again.
        """
        if not isfinite(self._rate):
            return Ran(Outcome.NON_FINITE, self._start[None], longest=0.0, steps=0, seconds=0.0)
        if self._course is None:
            self._course, ran = self._suited(foreseen())
        else:
            ran = self._went(self._course)
        if ran.outcome is not Outcome.FINISHED:
            return ran
        grid, samples = self._course.grid, self._course.samples
        if len(ran.rows) != len(grid):
            return ran._replace(outcome=Outcome.INTERRUPTED)
        return ran if len(grid) == len(self._times) else ran._replace(rows=ran.rows[samples])

    def _suited(self, foreseen: float) -> tuple[_Course, Ran]:
        """Return a course whose steps suit every rate on its way, with its run."""
        rate = max(self._rate, foreseen if isfinite(foreseen) else 0.0)
        course = _Course(*self._grid, self._calls, rate)
        ran = self._went(course)
        if not self._was_too_fast(ran, course):
            return course, ran
        fastest = self._linearised.fastest(*_some(ran, course.grid))
        watched = self._instants(self._look_count)
        if ran.outcome is Outcome.FINISHED and fastest <= _MORE_STEPS * rate:
            course = _Course(*watched, self._calls, fastest)
            ran = self._went(course)
            if not self._was_too_fast(ran, course):
                return course, ran
        course = _Course(*watched, self._look_count, rate, is_watched=True)
        return course, self._went(course)

    @property
    def parameters(self) -> np.ndarray[Any, Any]:
        """The parameters at the end of the last run: its events may have changed some."""
        parameters: np.ndarray[Any, Any] = self._pars
        return parameters

    def fastest(self) -> float:
        """Return the fastest rate at the instants; infinite where the way does not reach its end."""
        ran = self.run()
        is_whole = ran.outcome is Outcome.FINISHED
        return self._linearised.fastest(ran.rows, self._times) if is_whole else inf

    def _went(self, course: _Course) -> Ran:
        """Go from the first instant of each stretch of a course to its last."""
        rate = course.rate
        self._pars[:] = self._parameters
        self._state[:] = self._start
        self._integrator.time = course.grid[0]
        legs = list[Ran]()
        for instants in course.stretches:
            leg = self._leg(instants, rate)
            legs.append(leg)
            if leg.outcome is not Outcome.FINISHED:
                break
            if course.is_watched:
                rate = max(rate, self._linearised.fastest(leg.rows[-1:], instants[-1:]))
        return legs[0] if len(legs) == 1 else _joined(legs)

    def _leg(self, instants: np.ndarray[Any, Any], rate: float) -> Ran:
        """Go from the first instant, where the integrator is, to the last: one call of heyoka."""
        radians = rate * abs(float(instants[-1] - instants[0]))
        if not radians <= MOST_RADIANS:
            outcome = Outcome.STEP_LIMIT if isfinite(rate) else Outcome.NON_FINITE
            return Ran(outcome, self._start[None], longest=0.0, steps=0, seconds=0.0)
        cap = self._longest / rate
        began = perf_counter()
        callback = self._callback
        status, _, uncut, steps, _, rows = self._integrator.propagate_grid(
            instants,
            max_delta_t=self.numbers.double(cap),
            max_steps=most_steps(radians) * (_LOADED if self._is_loaded else 1),
            callback=callback,
        )
        seconds = perf_counter() - began
        outcome = outcome_of(status)
        if callback is not None and callback.stands_still:
            outcome = Outcome.NON_FINITE
        if outcome is Outcome.FINISHED and not np.isfinite(rows).all():
            outcome = Outcome.NON_FINITE
        # Steps that were cut to the cap are left out of heyoka's longest.
        step = float(uncut)
        longest = step if 0 < step < _UNCUT * cap else cap
        return Ran(outcome, rows, longest, int(steps), seconds)

    def _was_too_fast(self, ran: Ran, course: _Course) -> bool:
        """Return True where the rate has grown, and steps were too long for it or ran out for it."""
        if not len(ran.rows):
            return False
        (rows, times), is_whole = _some(ran, course.grid), ran.outcome is Outcome.FINISHED
        allowed = _SLACK * self._longest / ran.longest if is_whole else course.rate
        return not self._linearised.fastest(rows, times) <= allowed

    @property
    def _callback(self) -> _Advance | None:
        """The callback of a wide rung."""
        return None if self._problem.rung.name in _RADIANS_AT_ONCE else _Advance()

    @property
    def _look_count(self) -> int:
        """The number of times that the rate is looked at where it changes much."""
        wanted = self._radians / _RADIANS_APART if self._radians <= MOST_RADIANS else _MOST_LOOKS
        return max(self._calls, min(max(_FEWEST_LOOKS, ceil(wanted)), _MOST_LOOKS))

    def _instants(self, pieces: int) -> tuple[np.ndarray[Any, Any], Places]:
        """Return the instants that heyoka is asked for, and where the samples are among them.

        They begin at its own time, asked for or not. Between few samples there are more, so that a way of
        so many pieces can be cut there as often as between many.
        """
        times, exact = self._times, self._problem.times
        begin = self._problem.begin
        first = self.numbers.array([begin])
        grid = times if times[0] == first[0] else np.concatenate([first, times])
        if len(grid) > pieces:
            return grid, slice(len(grid) - len(times), None)
        ends = list(exact) if len(grid) == len(times) else [begin, *exact]
        instants, samples = ends[:1], [0]
        for after, before in pairwise(ends):
            instants += _waypoints(
                after, before, abs(ends[-1] - begin) / pieces, self._problem.rung
            )
            samples.append(len(instants))
            instants.append(before)
        return self.numbers.array(instants), samples[len(grid) - len(times) :]


def _some(ran: Ran, grid: np.ndarray[Any, Any]) -> tuple[Rows, np.ndarray[Any, Any]]:
    """Return the rows of a way at which the rate is looked at afterwards, and their times."""
    some = slice(None, None, -ceil(len(ran.rows) / _ROWS_LOOKED_AT))
    return ran.rows[some], grid[: len(ran.rows)][some]


def _joined(legs: Sequence[Ran]) -> Ran:
    """Return the whole of several legs, each of which begins where the one before it ended."""
    rows = [leg.rows[1:] if k else leg.rows for k, leg in enumerate(legs)]
    longest = max(leg.longest for leg in legs)
    steps, seconds = sum(leg.steps for leg in legs), sum(leg.seconds for leg in legs)
    return Ran(legs[-1].outcome, np.concatenate(rows), longest, steps, seconds)


def longest_step(order: int) -> float:
    """Return the longest step that is taken in an order, in units of the fastest linear rate."""
    return _LONGEST_STEP * min(1.0, order / _FULL_ORDER)


def most_steps(radians: float) -> int:
    """Return a bound that no regular orbit comes near: what needs more has gone astray."""
    return LEAST_STEPS + int(STEPS_PER_RADIAN * radians)


def outcome_of(status: Any) -> Outcome:
    """Return the outcome that heyoka's own word stands for."""
    return _outcomes().get(status, Outcome.INTERRUPTED)


@lru_cache
def _outcomes() -> dict[Any, Outcome]:
    import heyoka as hy

    return {
        hy.taylor_outcome.time_limit: Outcome.FINISHED,
        hy.taylor_outcome.err_nf_state: Outcome.NON_FINITE,
        hy.taylor_outcome.step_limit: Outcome.STEP_LIMIT,
    }


def _calls(radians: float, rung: Rung) -> int:
    """Return the number of calls of heyoka on a way of this length, so that an interrupt can be handled."""
    at_once = _RADIANS_AT_ONCE.get(rung.name)
    return 1 if at_once is None or not radians <= MOST_RADIANS else max(1, ceil(radians / at_once))


def _waypoints(after: Fraction, before: Fraction, gap: Fraction, rung: Rung) -> list[Fraction]:
    """Return numbers of the rung between two others, in order and no farther apart than about ``gap``."""
    pieces = ceil(abs(before - after) / gap)
    points = [after]
    for k in range(1, pieces):
        instant = rung.round(after + (before - after) * Fraction(k, pieces))
        if min(points[-1], before) < instant < max(points[-1], before):
            points.append(instant)
    return points[1:]


class _Advance:
    """The callback of each step: heyoka returns to the interpreter, where an interrupt waits to be heard.

    Where a motion becomes infinite, steps of a wide rung shrink until time stands still: no number of it
    overflows. There it stops.
    """

    def __init__(self) -> None:
        self._time: Any = None
        self._standing = 0

    @property
    def stands_still(self) -> bool:
        """True if the last steps have not changed the time."""
        return self._standing >= _MOST_STANDING

    def __call__(self, integrator: Any) -> bool:
        time = integrator.time
        self._standing = self._standing + 1 if time == self._time else 0
        self._time = time
        return not self.stands_still
