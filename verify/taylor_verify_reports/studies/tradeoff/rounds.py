"""Times of one process: settings in rounds of random order, as multiples of the round's yardstick.

A time depends on the machine as much as on the solver. Therefore it is divided by the time of the
yardstick, taylor on f64, in the same round, when the machine was equally warm, busy and fast. Times are
processor times, without those of other programs. A peer, an integrator of another library, has a process of
its own. It takes its turns with all others, and times itself in the same way.
"""

from __future__ import annotations

import gc
import random
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from math import ceil
from statistics import median
from time import perf_counter, thread_time
from typing import Final, NamedTuple, TypeVar

from taylor_verify.models.problem import Problem, pose
from taylor_verify.scenes.precision import rung as rung_named
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.engines.peer import Peer
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.trajectory import Outcome
from taylor_verify.tradeoff.document import TimingMethod
from taylor_verify.tradeoff.order_statistics import CONFIDENCE, FORMULA, coverage, place
from taylor_verify.tradeoff.setting import Name, setting
from taylor_verify.tradeoff.timing import WHAT_IS_TIMED

Answer = TypeVar("Answer")

YARDSTICK: Final = ("taylor", "f64")
ROUNDS: Final = 3
# The least duration of a measurement, in units of the clock's resolution: the clock errs by 1 % at most.
_TIMES_RESOLUTION: Final = 100
# The least duration in seconds: an interrupt does not matter then, nor what the turn before left in caches.
_LEAST_SECONDS: Final = 1e-2
# A setting that takes more seconds, with the start of its program, is solved only once in each process.
_SLOWEST_IN_ROUNDS: Final = 0.2
_MOST_SOLVES: Final = 1000


@dataclass(frozen=True)
class Measured:
    """The times of one setting in one process: medians of its rounds, per solve.

    ``ratio`` is the seconds over the yardstick's in the same round. ``inner`` is the part of the seconds in
    another library's compiled integrator, if known. ``setup`` is the time before the first solve, mainly
    of compiling.
    """

    seconds: float
    ratio: float
    inner: float | None
    setup: float


class _Taken(NamedTuple):
    """A measurement, in seconds per solve.

    ``seconds`` is processor time, ``inner`` the part of it in a compiled integrator, if known, and
    ``waited`` the time on the clock without compiling. ``setup`` is the time of compiling before the first
    propagation.
    """

    seconds: float
    inner: float | None
    waited: float
    setup: float = 0.0


def measured(
    scene: Scene,
    names: Sequence[Name],
    seed: int,
    rounds: int = ROUNDS,
    resolution: float | None = None,
    clock: Callable[[], float] = thread_time,
) -> dict[Name, Measured]:
    """Measure settings on a scene by their names; settings that do not finish are left out.

    The yardstick is always measured too. ``resolution`` is that of a clock in seconds, by default measured
    now. ``clock`` returns the processor's seconds.
    """
    least = max(_LEAST_SECONDS, _TIMES_RESOLUTION * (resolution or clock_resolution()))
    first: dict[Name, _Taken] = {}
    turns: dict[Name, Callable[[], _Taken | None]] = {}
    for name in dict.fromkeys([YARDSTICK, *names]):
        rung = rung_named(name[1])
        solver = setting(name[0], rung).solver
        solve = partial(_solved, solver, pose(scene, rung), clock)
        if (taken := solve(1, is_first=True)) is None:
            continue
        first[name] = taken
        count = _count(taken, least)
        if count or name == YARDSTICK:
            turns[name] = partial(solve, max(1, count))
    if YARDSTICK not in first:
        return {}
    later = dict(zip(turns, in_rounds([*turns.values()], rounds, seed), strict=True))
    unit = later[YARDSTICK]
    return {
        name: _summed(first[name], later.get(name, []), unit) for name in names if name in first
    }


def in_rounds(turns: Sequence[Callable[[], Answer]], rounds: int, seed: int) -> list[list[Answer]]:
    """Call every turn once in each round, in a random order, and return the answers of each turn by round.

    Python's garbage collector runs once before the first round and is off until the last one, so that it
    disturbs no turn.
    """
    answers: list[list[Answer]] = [[] for _ in turns]
    order, draw = list(range(len(turns))), random.Random(seed)
    enabled = gc.isenabled()
    gc.collect()
    gc.disable()
    try:
        for _ in range(rounds):
            draw.shuffle(order)
            for i in order:
                answers[i].append(turns[i]())
    finally:
        if enabled:
            gc.enable()
    return answers


def _summed(
    first: _Taken, later: Sequence[_Taken | None], unit: Sequence[_Taken | None]
) -> Measured:
    """Return the medians over the rounds; a setting that was solved once has that one time."""
    rounds = [(a, b.seconds) for a, b in zip(later, unit, strict=False) if a and b]
    rounds = rounds or [(first, median(b.seconds for b in unit if b))]
    inner = [taken.inner for taken, _ in rounds if taken.inner is not None]
    return Measured(
        seconds=median(taken.seconds for taken, _ in rounds),
        ratio=median(taken.seconds / seconds for taken, seconds in rounds),
        inner=median(inner) if len(inner) == len(rounds) else None,
        setup=first.setup,
    )


def _solved(
    solver: Solver, problem: Problem, clock: Callable[[], float], count: int, is_first: bool = False
) -> _Taken | None:
    """Time ``count`` solves by the processor's clock; None if a solve did not finish."""
    if isinstance(solver, Peer) and not is_first:
        seconds = solver.seconds(problem, count)
        return None if seconds is None else _Taken(seconds, inner=None, waited=seconds)
    began, processor_began = perf_counter(), clock()
    made = []
    for _ in range(count):
        # Only the times are stored, because whole trajectories would fill the memory.
        trajectory = solver.solve(problem)
        if trajectory.outcome is not Outcome.FINISHED:
            return None
        made.append((trajectory.seconds, trajectory.compile_seconds, trajectory.inner_seconds))
    spent, waited = clock() - processor_began, perf_counter() - began
    stated, compiling, inner = (list(values) for values in zip(*made, strict=True))
    if isinstance(solver, Peer):
        return _Taken(seconds=stated[0], inner=None, waited=stated[0], setup=compiling[0])
    # The first solve may compile, and states the time of its propagation separately.
    seconds = min(spent, sum(stated)) if is_first else spent
    # The part in a compiled integrator is known as time on the clock, and is scaled to processor time.
    known = [part for part in inner if part is not None]
    share = sum(known) / sum(stated) if len(known) == count and sum(stated) else None
    inside = None if share is None else share * seconds / count
    return _Taken(
        seconds=seconds / count,
        inner=inside,
        waited=(waited - sum(compiling)) / count,
        setup=compiling[0],
    )


def _count(taken: _Taken, least: float) -> int:
    """Return the number of solves that last long enough together; 0 for a setting that is too slow."""
    if not taken.waited <= _SLOWEST_IN_ROUNDS:
        return 0
    return min(_MOST_SOLVES, max(1, ceil(least / taken.seconds))) if taken.seconds else _MOST_SOLVES


def clock_resolution(clock: Callable[[], float] = perf_counter) -> float:
    """Return the smallest observed step of the clock, in seconds."""

    def step() -> float:
        began = clock()
        while (now := clock()) == began:
            pass
        return now - began

    return min(step() for _ in range(100))


def method(processes: int, rounds: int, seed: int) -> TimingMethod:
    """Return the method of the measurement in its stored form."""
    return TimingMethod(
        processes=processes,
        rounds=rounds,
        seed=seed,
        least_seconds=_LEAST_SECONDS,
        times_resolution=_TIMES_RESOLUTION,
        clock_resolution=clock_resolution(),
        confidence=CONFIDENCE,
        # With too few processes for the confidence it is the coverage of their extremes.
        coverage=coverage(processes, max(place(processes, CONFIDENCE), 1)),
        formula=FORMULA,
        of=WHAT_IS_TIMED,
    )
