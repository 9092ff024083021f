"""Solves of each setting: the first one, which compiles and fills caches, then later ones in rounds.

A time is the solver's own propagation, as its trajectory states it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from operator import itemgetter
from time import perf_counter
from typing import Final

from taylor_verify.models.problem import Problem
from taylor_verify.solvers.trajectory import Outcome, Trajectory
from taylor_verify.tradeoff.setting import Setting
from taylor_verify.tradeoff.timing import in_rounds

REPEATS: Final = 5
SEED: Final = 1
# If a setting takes more seconds, finer ones of its family are not run. Every setting is repeated once, and
# then only while all its solves have taken fewer seconds together.
PATIENCE: Final = 2.0

# The explanation that stands with all times.
WHAT_IS_TIMED: Final = (
    "the solver's own propagation; taylor runs compiled equations and looks for its longest step in "
    "Python, scipy calls straight-line equations in "
    "Python, geometric and odefun are Python throughout, a program of one's own is timed as it states "
    "itself, and those of other libraries state a later propagation than their first, on the "
    "processor's clock where their process stays"
)


@dataclass(frozen=True)
class Timed:
    """The first answer of a setting, and the times of its later solves in seconds.

    ``first`` is the whole time of the first solve. ``seconds`` is empty for a run that failed. ``inner`` is
    the part of the best time that another library's compiled integrator took, if known.
    """

    setting: Setting
    trajectory: Trajectory
    first: float
    seconds: tuple[float, ...] = ()
    inner: float | None = None

    @property
    def best(self) -> float | None:
        """The shortest time; None for a run that failed."""
        return min(self.seconds, default=None)

    @property
    def spread(self) -> float | None:
        """The slowest time over the fastest."""
        return max(self.seconds) / self.best if self.best else None


# The seconds of a solve, and their part in a compiled integrator. Whole answers would fill the memory.
_Seconds = tuple[float, float | None]


def timed(
    problems: Mapping[Setting, Problem | str], repeats: int, seed: int, patience: float = PATIENCE
) -> list[Timed]:
    """Solve every setting once, and those that finished ``repeats`` times more; return all in their order.

    A text in place of a problem is the reason why a setting cannot run. Without repeats there is only the
    first time, which is enough to measure errors. A setting is not run, and its answer says so, if a
    coarser setting of its family took more than ``patience`` seconds.
    """
    firsts = _first_solves(problems, patience)
    finished = [each for each in firsts if each.trajectory.outcome is Outcome.FINISHED]
    later: dict[Setting, list[_Seconds]] = {each.setting: [] for each in finished}
    turns = [
        partial(_solve_again, each, problems[each.setting], later[each.setting], patience)
        for each in finished
    ]
    in_rounds(turns, repeats, seed)
    return [_with_seconds(each, later.get(each.setting)) for each in firsts]


def _solve_again(
    first: Timed, problem: Problem | str, later: list[_Seconds], patience: float
) -> None:
    """Solve once; after the first repeat only while all solves took less than ``patience`` seconds."""
    assert not isinstance(problem, str)
    spent = first.trajectory.seconds + sum(seconds for seconds, _ in later)
    if later and spent > patience:
        return
    solved = first.setting.solver.solve(problem)
    later.append((solved.seconds, solved.inner_seconds))


def _with_seconds(first: Timed, later: Sequence[_Seconds] | None) -> Timed:
    """Return the first answer with the times of the later solves, or of the only one; none if it failed."""
    if later is None:
        return first
    solves = later or [(first.trajectory.seconds, first.trajectory.inner_seconds)]
    _, inner = min(solves, key=itemgetter(0))
    return replace(first, seconds=tuple(seconds for seconds, _ in solves), inner=inner)


def _first_solves(problems: Mapping[Setting, Problem | str], patience: float) -> list[Timed]:
    """Return the first answer of every setting, or the reason why it was not run."""
    solves: list[Timed] = []
    # Families whose finer settings are not run.
    slow: set[str] = set()
    for setting, problem in problems.items():
        if isinstance(problem, str) or setting.family in slow:
            coarser = f"a coarser setting took more than {patience:g} s"
            because = problem if isinstance(problem, str) else coarser
            nothing = Trajectory(Outcome.NOT_STARTED, detail=because)
            solves.append(Timed(setting, nothing, first=0.0))
            continue
        began = perf_counter()
        trajectory = setting.solver.solve(problem)
        solves.append(Timed(setting, trajectory, first=perf_counter() - began))
        if not trajectory.seconds <= patience:
            slow.add(setting.family)
    return solves
