"""The times of one process: settings in rounds of random order, as multiples of the round's yardstick.

A time alone says as much of the machine as of the solver, so that what is kept is its ratio to the time
of taylor on f64 in the same round, when the machine was as warm, as busy and as fast.
"""

from __future__ import annotations

import gc
import random
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from math import ceil
from statistics import median
from time import perf_counter
from typing import Final, NamedTuple

from taylor_verify.models.problem import Problem, pose
from taylor_verify.scenes.precision import rung as rung_named
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.trajectory import Outcome
from taylor_verify.studies.tradeoff.document import TimingMethod
from taylor_verify.studies.tradeoff.order_statistics import CONFIDENCE, FORMULA, coverage, place
from taylor_verify.studies.tradeoff.setting import Name, setting
from taylor_verify.studies.tradeoff.timing import WHAT_IS_TIMED

YARDSTICK: Final = ("taylor", "f64")
ROUNDS: Final = 3
# A measurement lasts at least so many times the clock's resolution: that is then below 1 %.
_TIMES_RESOLUTION: Final = 100
# And so many seconds, so that an interrupt of some microseconds does not show either.
_LEAST_SECONDS: Final = 2e-3
# The yardstick enters every ratio of its round.
_YARDSTICK_SECONDS: Final = 1e-2
# What is waited for longer, a program's start included, is solved once a process.
_DEAR: Final = 0.2
_MOST_SOLVES: Final = 1000


@dataclass(frozen=True)
class Measured:
    """The times of one setting in one process: medians of its rounds, per solve.

    ``ratio`` is that of the seconds to the yardstick's of the same round, ``inner`` the seconds in
    somebody else's compiled integrator, where known.
    """

    seconds: float
    ratio: float
    inner: float | None


class _Taken(NamedTuple):
    """A measurement: seconds a solve, those of them in a compiled integrator, the wait for it.

    What compiled before the propagation is not waited for again.
    """

    seconds: float
    inner: float | None
    waited: float


def measured(
    scene: Scene,
    names: Sequence[Name],
    seed: int,
    rounds: int = ROUNDS,
    resolution: float | None = None,
) -> dict[Name, Measured]:
    """Measure these settings on a scene; one that does not finish here is left out.

    The yardstick is measured with them, asked for or not.
    """
    least = max(_LEAST_SECONDS, _TIMES_RESOLUTION * (resolution or clock_resolution()))
    work: dict[Name, tuple[Solver, Problem]] = {}
    for solver, rung in (YARDSTICK, *names):
        on = rung_named(rung)
        work[solver, rung] = setting(solver, on).solver, pose(scene, on)
    solved = {name: _solved(*work[name], 1) for name in work}
    first = {name: taken for name, taken in solved.items() if taken is not None}
    if YARDSTICK not in first:
        return {}
    counts = {name: _count(taken, least) for name, taken in first.items()}
    counts[YARDSTICK] = max(1, _count(first[YARDSTICK], _YARDSTICK_SECONDS))
    # What is dear is measured no more.
    order = [name for name, count in counts.items() if count]
    draw = random.Random(seed)
    kept: list[dict[Name, _Taken]] = []
    with without_collector():
        for _ in range(rounds):
            turn = draw.sample(order, len(order))
            taken = {name: _solved(*work[name], counts[name]) for name in turn}
            kept.append({name: one for name, one in taken.items() if one is not None})
    return {name: _summed(name, first[name], kept) for name in names if name in first}


def _summed(name: Name, first: _Taken, kept: Iterable[Mapping[Name, _Taken]]) -> Measured:
    """Return the medians over the rounds; of a dear setting its only solve over the yardstick's median."""
    with_unit = [one for one in kept if YARDSTICK in one]
    rounds = [(one[name], one[YARDSTICK].seconds) for one in with_unit if name in one]
    if not rounds:
        unit = median(one[YARDSTICK].seconds for one in with_unit)
        return Measured(first.seconds, first.seconds / unit, first.inner)
    inner = [taken.inner for taken, _ in rounds if taken.inner is not None]
    return Measured(
        median(taken.seconds for taken, _ in rounds),
        median(taken.seconds / unit for taken, unit in rounds),
        median(inner) if len(inner) == len(rounds) else None,
    )


def _solved(solver: Solver, problem: Problem, count: int) -> _Taken | None:
    """Solve so many times, as the solver times itself; None if a solve did not finish."""
    seconds, compiling = 0.0, 0.0
    inner: list[float | None] = []
    began = perf_counter()
    for _ in range(count):
        trajectory = solver.solve(problem)
        if trajectory.outcome is not Outcome.FINISHED:
            return None
        seconds += trajectory.seconds
        compiling += trajectory.compile_seconds
        inner.append(trajectory.inner_seconds)
    waited = (perf_counter() - began - compiling) / count
    known = [part for part in inner if part is not None]
    return _Taken(seconds / count, sum(known) / count if len(known) == count else None, waited)


def _count(taken: _Taken, least: float) -> int:
    """Return how many solves make a measurement long enough; 0 for a setting that is dear."""
    if not taken.waited <= _DEAR:
        return 0
    return min(_MOST_SOLVES, max(1, ceil(least / taken.seconds))) if taken.seconds else _MOST_SOLVES


def clock_resolution(clock: Callable[[], float] = perf_counter) -> float:
    """Return the smallest step that the clock was seen to make."""

    def step() -> float:
        began = clock()
        while (now := clock()) == began:
            pass
        return now - began

    return min(step() for _ in range(100))


def method(processes: int, rounds: int, seed: int) -> TimingMethod:
    """Return the method of so many processes and rounds as it is stored."""
    return TimingMethod(
        processes=processes,
        rounds=rounds,
        seed=seed,
        least_seconds=_LEAST_SECONDS,
        times_resolution=_TIMES_RESOLUTION,
        clock_resolution=clock_resolution(),
        confidence=CONFIDENCE,
        # Too few processes have that of their two extremes.
        coverage=coverage(processes, max(place(processes, CONFIDENCE), 1)),
        formula=FORMULA,
        of=WHAT_IS_TIMED,
    )


@contextmanager
def without_collector() -> Iterator[None]:
    """Run Python's collector of garbage before and not in between, where it would hit one by chance."""
    enabled = gc.isenabled()
    gc.collect()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()
