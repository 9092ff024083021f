"""How long each setting takes: in a fresh order each time, start-up apart, caches off for the cold.

A time is the solver's own propagation, as its trajectory states it. The first solve of a setting is
apart: it compiles, imports and fills caches. What follows is repeated in rounds, each of them in an
order shuffled anew, so that whatever the machine does besides meets no setting always.
"""

from __future__ import annotations

import os
import random
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from time import perf_counter
from typing import Final

from taylor_verify.models.problem import Problem
from taylor_verify.solvers.trajectory import Outcome, Trajectory
from taylor_verify.studies.tradeoff.setting import Setting

REPEATS: Final = 5
SEED: Final = 1
# A setting that took longer is not set finer, and one that has is not repeated more than once.
PATIENCE: Final = 2.0
_HEYOKA_CACHE: Final = "HEYOKA_CACHE_DIR"

# What the times compare, said wherever they are shown.
WHAT_IS_TIMED: Final = (
    "the solver's own propagation; taylor runs compiled equations and looks for its longest step in "
    "Python, scipy calls straight-line equations in Python, geometric and odefun are Python "
    "throughout, a program of one's own is timed as it states itself, and those of other libraries "
    "state their second propagation"
)

Clock = Callable[[], float]


@dataclass(frozen=True)
class Timed:
    """The first answer of a setting and the times of all others, in seconds.

    ``first`` is the whole of the first solve as the caller waits for it, ``compiling`` the part of
    it that the solver says went before the propagation. ``seconds`` is empty for a run that failed.
    ``inner`` is what the best of them spent in somebody else's compiled integrator, where known.
    """

    setting: Setting
    trajectory: Trajectory
    first: float
    seconds: tuple[float, ...] = ()
    inner: float | None = None

    @property
    def compiling(self) -> float:
        return self.trajectory.compile_seconds

    @property
    def best(self) -> float | None:
        return min(self.seconds, default=None)

    @property
    def spread(self) -> float | None:
        """The slowest over the fastest."""
        best = self.best
        return max(self.seconds) / best if best else None


def timed(
    problems: Mapping[Setting, Problem],
    repeats: int,
    seed: int,
    clock: Clock = perf_counter,
    patience: float = PATIENCE,
) -> list[Timed]:
    """Every setting solved once and those that finished ``repeats`` times more, in their own order.

    Without repeats the first time is all there is, as for whoever is after the errors alone.
    A setting is left out where a coarser one of its family took more than ``patience`` seconds; the
    outcome says so.
    """
    firsts = _first_solves(problems, clock, patience)
    again: dict[Setting, list[Trajectory]] = {
        one.setting: [] for one in firsts if one.trajectory.outcome is Outcome.FINISHED
    }
    spent = {one.setting: one.trajectory.seconds for one in firsts}
    order = random.Random(seed)
    for _ in range(repeats):
        settings = [s for s, made in again.items() if not made or spent[s] <= patience]
        order.shuffle(settings)
        for setting in settings:
            # The numbers are those of the first solve; kept, they would fill the memory.
            solved = replace(setting.solver.solve(problems[setting]), quantities={})
            again[setting].append(solved)
            spent[setting] += solved.seconds
    return [_with_times(one, again.get(one.setting, ())) for one in firsts]


def _with_times(one: Timed, again: Sequence[Trajectory]) -> Timed:
    if not again and one.trajectory.outcome is Outcome.FINISHED:
        again = (one.trajectory,)
    best = min(again, key=lambda solved: solved.seconds, default=None)
    inner = best.inner_seconds if best is not None else None
    return replace(one, seconds=tuple(solved.seconds for solved in again), inner=inner)


def _first_solves(
    problems: Mapping[Setting, Problem], clock: Clock, patience: float
) -> list[Timed]:
    found: list[Timed] = []
    dear: set[str] = set()
    for setting, problem in problems.items():
        if setting.family in dear:
            detail = f"a coarser setting took more than {patience:g} s"
            found.append(Timed(setting, Trajectory(Outcome.NOT_STARTED, detail=detail), 0.0))
            continue
        began = clock()
        trajectory = setting.solver.solve(problem)
        found.append(Timed(setting, trajectory, clock() - began))
        if not trajectory.seconds <= patience:
            dear.add(setting.family)
    return found


@contextmanager
def cold_caches() -> Iterator[None]:
    """What heyoka compiles within is compiled for the first time, and not kept for the next time.

    What this process has compiled before, it still has: a cold figure asks for a process of its own.
    """
    before = os.environ.get(_HEYOKA_CACHE)
    with tempfile.TemporaryDirectory() as empty:
        os.environ[_HEYOKA_CACHE] = empty
        try:
            yield
        finally:
            if before is None:
                del os.environ[_HEYOKA_CACHE]
            else:
                os.environ[_HEYOKA_CACHE] = before
