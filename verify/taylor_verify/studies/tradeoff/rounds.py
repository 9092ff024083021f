"""What one process measures: settings in rounds of random order, as multiples of the round's yardstick.

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
from typing import Final

from taylor_verify.models.problem import Problem, pose
from taylor_verify.scenes.precision import rung as rung_named
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.trajectory import Outcome
from taylor_verify.studies.tradeoff.setting import Setting, setting

YARDSTICK: Final = ("taylor", "f64")
ROUNDS: Final = 3
# A measurement lasts at least so many times the clock's resolution: that is then below 1 %.
TIMES_RESOLUTION: Final = 100
# And so many seconds, so that an interrupt of some microseconds does not show either.
LEAST_SECONDS: Final = 2e-3
# The yardstick enters every ratio of its round.
_YARDSTICK_SECONDS: Final = 1e-2
# What is waited for longer, a program's start included, is solved once a process.
_DEAR: Final = 0.2
_MOST_SOLVES: Final = 1000

# A solver and a rung, by their names: what passes from process to process.
Name = tuple[str, str]


@dataclass(frozen=True)
class Measured:
    """What one process found for one setting: medians of its rounds, per solve.

    ``ratio`` is that of the seconds to the yardstick's of the same round, ``inner`` the seconds in
    somebody else's compiled integrator, where known.
    """

    seconds: float
    ratio: float
    inner: float | None


@dataclass(frozen=True)
class _Taken:
    """One measurement: seconds a solve, those of them in a compiled integrator, the wait for it.

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
    least = max(LEAST_SECONDS, TIMES_RESOLUTION * (resolution or clock_resolution()))
    work = {name: _work(scene, name) for name in dict.fromkeys([YARDSTICK, *names])}
    first = {name: _solved(*work[name], 1) for name in work}
    if first[YARDSTICK] is None:
        return {}
    counts = {
        name: _count(taken, _YARDSTICK_SECONDS if name == YARDSTICK else least)
        for name, taken in first.items()
        if taken is not None
    }
    counts[YARDSTICK] = max(1, counts[YARDSTICK])
    order = random.Random(seed)
    kept: list[dict[Name, _Taken]] = []
    with _without_collector():
        for _ in range(rounds):
            kept.append(_round(work, counts, order))
    return {name: _summed(name, first, kept) for name in names if name in counts}


def _work(scene: Scene, name: Name) -> tuple[Setting, Problem]:
    solver, rung = name
    return setting(solver, rung_named(rung)), pose(scene, rung_named(rung))


def _round(
    work: Mapping[Name, tuple[Setting, Problem]],
    counts: Mapping[Name, int],
    order: random.Random,
) -> dict[Name, _Taken]:
    """Each setting that is not dear, in an order drawn anew."""
    names = [name for name, count in counts.items() if count]
    order.shuffle(names)
    found = {}
    for name in names:
        taken = _solved(*work[name], counts[name])
        if taken is not None:
            found[name] = taken
    return found


def _summed(
    name: Name, first: Mapping[Name, _Taken | None], kept: Iterable[Mapping[Name, _Taken]]
) -> Measured:
    """The medians over the rounds; of a dear setting its only solve, over the yardstick's median."""
    rounds = [one for one in kept if name in one and YARDSTICK in one]
    if not rounds:
        alone = first[name]
        assert alone is not None
        unit = median(one[YARDSTICK].seconds for one in kept if YARDSTICK in one)
        return Measured(alone.seconds, alone.seconds / unit, alone.inner)
    inner = [one[name].inner for one in rounds]
    return Measured(
        median(one[name].seconds for one in rounds),
        median(one[name].seconds / one[YARDSTICK].seconds for one in rounds),
        median(part for part in inner if part is not None) if None not in inner else None,
    )


def _solved(asked: Setting, problem: Problem, count: int) -> _Taken | None:
    """So many solves one after the other, as the solver times itself; None if one did not finish."""
    seconds, inner, compiling = 0.0, 0.0, 0.0
    told_apart, began = True, perf_counter()
    for _ in range(count):
        trajectory = asked.solver.solve(problem)
        if trajectory.outcome is not Outcome.FINISHED:
            return None
        seconds += trajectory.seconds
        told_apart = told_apart and trajectory.inner_seconds is not None
        inner += trajectory.inner_seconds or 0.0
        compiling += trajectory.compile_seconds
    waited = (perf_counter() - began - compiling) / count
    return _Taken(seconds / count, inner / count if told_apart else None, waited)


def _count(taken: _Taken, least: float) -> int:
    """How many solves make a measurement long enough; 0 for a setting that is measured no more."""
    if not taken.waited <= _DEAR:
        return 0
    return min(_MOST_SOLVES, max(1, ceil(least / taken.seconds))) if taken.seconds else _MOST_SOLVES


def clock_resolution(clock: Callable[[], float] = perf_counter) -> float:
    """The smallest step that the clock was seen to make."""

    def step() -> float:
        began = clock()
        while (now := clock()) == began:
            pass
        return now - began

    return min(step() for _ in range(100))


@contextmanager
def _without_collector() -> Iterator[None]:
    """Python's collector of garbage runs before and not in between, where it would hit one by chance."""
    enabled = gc.isenabled()
    gc.collect()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()
