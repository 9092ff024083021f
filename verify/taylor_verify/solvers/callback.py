"""A user's function as a solver."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter
from typing import Any, Final, final

import numpy as np

from taylor_verify.models.problem import Problem
from taylor_verify.numbers.convertible import as_rationals
from taylor_verify.solvers.answered import MisshapenAnswer, Unfinished, answer_of
from taylor_verify.solvers.files.file import TrajectoryFile
from taylor_verify.solvers.opened import opened
from taylor_verify.solvers.solver import Solver, columns, raised
from taylor_verify.solvers.trajectory import Outcome, Trajectory
from taylor_verify.solvers.values import number_as_mpf

_RATIONAL_BITS: Final = 4000


@final
@dataclass(frozen=True)
class Callback(Solver):
    """A user's function as a solver: ``answer(problem, **settings)`` returns an answer.

    An answer is an array of states of shape (samples, n), whose columns are omega, or x and y; then q0..q3
    where the attitude is tracked, then the centre where it is, then the tracked states of the scene's own;
    or (t, y), SciPy's OdeResult, a dense output, or an object that `check` takes (solvers.answered). A
    Python or NumPy number, a Fraction or an mpf is taken exactly. An exception is a failed run, and so is
    `sys.exit` with any code; an interrupt stays an interrupt.
    """

    answer: Callable[..., Any]
    name: str = "callback"
    settings: tuple[tuple[str, float | str], ...] = ()
    takes_loads = True

    @classmethod
    def of(cls, answer: Callable[..., Any]) -> Callback:
        """Return the solver that calls a function or a callable object, and has its name."""
        return cls(answer, getattr(answer, "__qualname__", None) or type(answer).__qualname__)

    def solve(self, problem: Problem) -> Trajectory:
        trajectory = self.answered(problem)
        if trajectory.file is None:
            return trajectory
        expected = "states at the scene's times, in the order of a state"
        detail = f"expected {expected}, got rows that only `run` and `check` judge"
        return Trajectory(Outcome.MISSHAPEN, detail=detail, seconds=trajectory.seconds)

    def answered(self, problem: Problem) -> Trajectory:
        """Return the trajectory, with a ``file`` for an answer that is not made of states."""
        began = perf_counter()
        try:
            raw = as_rationals(self.answer(opened(problem), **dict(self.settings)))
            answered = answer_of(raw, problem)
            if not isinstance(answered, TrajectoryFile):
                answered = np.asarray(answered)
        except Unfinished as reason:
            return Trajectory(Outcome.INTERRUPTED, detail=str(reason))
        except MisshapenAnswer as fault:
            return Trajectory(Outcome.MISSHAPEN, detail=str(fault))
        except (Exception, SystemExit) as error:  # a user's code: its exception is its outcome
            return raised(error)
        seconds = perf_counter() - began
        if isinstance(answered, TrajectoryFile):
            return _of_file(answered, problem, seconds)
        return of_states(answered, problem, seconds)


def _of_file(file: TrajectoryFile, problem: Problem, seconds: float) -> Trajectory:
    """Return the trajectory of a table; it has states where its rows are at the scene's times."""
    rows = range(len(file.times))
    groups = {name: g.as_mpf(rows, _RATIONAL_BITS) for name, g in file.groups.items()}
    wanted = [name for name, _ in columns(problem)]
    given = [float(time) for time in problem.given.clock.instants]
    if set(wanted) <= set(groups) and [float(time) for time in file.times] == given:
        states = {name: groups[name] for name in wanted}
        return Trajectory(Outcome.FINISHED, states, seconds=seconds)
    return Trajectory(Outcome.FINISHED, groups, seconds=seconds, file=file)


def of_states(answered: Any, problem: Problem, seconds: float = 0.0) -> Trajectory:
    """Return the trajectory of states in the order of the protocol."""
    layout, states = columns(problem), np.asarray(answered)
    expected = (len(problem.times), sum(width for _, width in layout))
    if states.shape != expected:
        detail = f"expected states of shape {expected}, got {states.shape}"
        return Trajectory(Outcome.MISSHAPEN, detail=detail, seconds=seconds)
    try:
        numbers = [[number_as_mpf(v, _RATIONAL_BITS) for v in row] for row in states]
    except TypeError as error:
        return Trajectory(Outcome.MISSHAPEN, detail=str(error), seconds=seconds)
    ends = np.cumsum([width for _, width in layout])[:-1]
    parts = np.split(np.array(numbers, dtype=object), ends, axis=1)
    quantities = {name: part for (name, _), part in zip(layout, parts, strict=True)}
    return Trajectory(Outcome.FINISHED, quantities, seconds=seconds)
