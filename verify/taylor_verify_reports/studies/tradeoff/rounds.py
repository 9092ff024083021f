"""Times of one process: settings in rounds of random order, as multiples of the round's yardstick.

A time depends on the machine as much as on the solver. Therefore it is divided by the time of the
yardstick, taylor on f64, in the same round, when the machine was equally warm, busy and fast. Times are
processor times, without those of other programs. A peer, an integrator of another library, has a process of
its own. It takes its turns with all others, and times itself in the same way.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from math import ceil
from statistics import median
from time import perf_counter, thread_time
from typing import Final, NamedTuple

from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers.precision import rung as rung_named
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.engines.peer import Peer
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.trajectory import Outcome, Trajectory
from taylor_verify.tradeoff.setting import Name, setting
from taylor_verify.tradeoff.solves import WHAT_IS_TIMED
from taylor_verify.tradeoff.timing import in_rounds
from taylor_verify_reports.studies.tradeoff.medians import CONFIDENCE, FORMULA, coverage, place
from taylor_verify_reports.studies.tradeoff.trades import TimingMethod

YARDSTICK: Final = ("taylor", "f64")
ROUNDS: Final = 3
# A function that returns seconds.
Clock = Callable[[], float]
# The least duration of a measurement: an interrupt does not matter then, nor what the clock costs.
LEAST_SECONDS: Final = 1e-2
_MOST_CALLS: Final = 1000
# The least duration of a measurement, in units of the clock's resolution: the clock errs by 1 % at most.
_TIMES_RESOLUTION: Final = 100
# A setting that takes more seconds is solved only once in each process.
_SLOWEST_IN_ROUNDS: Final = 0.2


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


class _Turn(NamedTuple):
    """Processor seconds of a solve; ``inner`` is the part in a compiled integrator, if known."""

    seconds: float
    inner: float | None


def measured(
    scene: Scene,
    names: Sequence[Name],
    seed: int,
    rounds: int = ROUNDS,
    resolution: float | None = None,
    clock: Clock = thread_time,
) -> dict[Name, Measured]:
    """Measure settings on a scene by their names; settings that do not finish are left out.

    The yardstick is always measured too. ``resolution`` is that of a clock in seconds, by default measured
    now. ``clock`` returns the processor's seconds.
    """
    least = max(LEAST_SECONDS, _TIMES_RESOLUTION * (resolution or clock_resolution()))
    firsts: dict[Name, Trajectory] = {}
    turns: dict[Name, Callable[[], _Turn | None]] = {}
    for name in dict.fromkeys([YARDSTICK, *names]):
        rung = rung_named(name[1])
        solver, problem = setting(name[0], rung).solver, pose(scene, rung)
        first = solver.solve(problem)
        if first.outcome is not Outcome.FINISHED:
            continue
        firsts[name] = first
        if first.seconds <= _SLOWEST_IN_ROUNDS or name == YARDSTICK:
            turns[name] = partial(
                _turn, solver, problem, calls_to_time(first.seconds, least), clock
            )
    if YARDSTICK not in firsts:
        return {}
    later = dict(zip(turns, in_rounds([*turns.values()], rounds, seed), strict=True))
    unit = later[YARDSTICK]
    return {
        name: _summed(firsts[name], later.get(name, []), unit) for name in names if name in firsts
    }


def _turn(solver: Solver, problem: Problem, count: int, clock: Clock) -> _Turn | None:
    """Time ``count`` solves; None for a peer that no longer answers."""
    if isinstance(solver, Peer):
        answered = solver.seconds(problem, count)
        return None if answered is None else _Turn(answered, None)
    solves = []
    began = clock()
    for _ in range(count):
        # Only the times are stored, because whole trajectories would fill the memory.
        trajectory = solver.solve(problem)
        solves.append((trajectory.seconds, trajectory.inner_seconds))
    seconds = (clock() - began) / count
    # The part in a compiled integrator is known as time on the clock, and is scaled to processor time.
    stated, inner = (
        sum(each for each, _ in solves),
        [part for _, part in solves if part is not None],
    )
    return _Turn(seconds, sum(inner) / stated * seconds if inner and stated else None)


def _summed(
    first: Trajectory, later: Sequence[_Turn | None], unit: Sequence[_Turn | None]
) -> Measured:
    """Return the medians over the rounds; a setting that was solved once has that one time."""
    rounds = [(a, b.seconds) for a, b in zip(later, unit, strict=False) if a and b]
    only = _Turn(first.seconds, first.inner_seconds)
    rounds = rounds or [(only, median(b.seconds for b in unit if b))]
    inner = [turn.inner for turn, _ in rounds if turn.inner is not None]
    return Measured(
        seconds=median(turn.seconds for turn, _ in rounds),
        ratio=median(turn.seconds / seconds for turn, seconds in rounds),
        inner=median(inner) if len(inner) == len(rounds) else None,
        setup=first.compile_seconds,
    )


def calls_to_time(seconds: float, least: float = LEAST_SECONDS) -> int:
    """Return the number of calls of so many ``seconds`` that last ``least`` seconds together."""
    return min(_MOST_CALLS, max(1, ceil(least / seconds))) if seconds > 0 else _MOST_CALLS


def clock_resolution() -> float:
    """Return the smallest observed step of the clock, in seconds."""

    def step() -> float:
        began = perf_counter()
        while (now := perf_counter()) == began:
            pass
        return now - began

    return min(step() for _ in range(100))


def method(processes: int, rounds: int, seed: int) -> TimingMethod:
    """Return the method of the measurement in its stored form."""
    return TimingMethod(
        processes=processes,
        rounds=rounds,
        seed=seed,
        least_seconds=LEAST_SECONDS,
        times_resolution=_TIMES_RESOLUTION,
        clock_resolution=clock_resolution(),
        confidence=CONFIDENCE,
        # With too few processes for the confidence it is the coverage of their extremes.
        coverage=coverage(processes, max(place(processes, CONFIDENCE), 1)),
        formula=FORMULA,
        of=WHAT_IS_TIMED,
    )
