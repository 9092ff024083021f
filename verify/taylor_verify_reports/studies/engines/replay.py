"""Judgement of stored trajectories, without running an engine; it is the same on every machine."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from math import isfinite
from typing import Any, Final, final

import numpy as np

from taylor_verify.judge.causes.likely import with_causes
from taylor_verify.judge.judgement import Judgement, judgement
from taylor_verify.models.problem import Problem
from taylor_verify.numbers.precision import rung as rung_named
from taylor_verify.records.answers import LikelyCause
from taylor_verify.records.quantities import INITIAL
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.callback import of_states
from taylor_verify.solvers.registry import solver_named
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.trajectory import Trajectory
from taylor_verify_reports.studies.engines.entry import Asked

States = np.ndarray[Any, Any]

# Digits of a stored error.
_DIGITS: Final = 4


@final
@dataclass(frozen=True)
class Stored(Solver):
    """Solver that returns a stored trajectory of shape (samples, n), with the columns of `columns`."""

    name: str
    states: States
    steps: int
    setting: str = ""

    def solve(self, problem: Problem) -> Trajectory:
        """Return the stored trajectory as the answer to ``problem``."""
        return replace(of_states(self.states, problem), steps=self.steps)


@dataclass(frozen=True)
class Errors:
    """The numbers of a judgement that the board shows; see `document.EngineRow`."""

    start: float | None
    errors: dict[str, float]
    floors: dict[str, float]
    cause: str


def states_of(scene: Scene, trajectory: Trajectory) -> States:
    """Return a trajectory as an array (samples, columns): float32 if that changes no number, else float64.

    A number that is no double is rounded; no engine here has any.
    """
    parts = [trajectory.quantities[group.name] for group in scene.groups]
    doubles = np.array(
        [[float(v) for part in parts for v in part[k]] for k in range(len(parts[0]))]
    )
    with np.errstate(over="ignore", under="ignore"):
        singles = doubles.astype(np.float32)
    return singles if np.array_equal(singles.astype(float), doubles) else doubles


def judged(run: Asked, states: States, steps: int) -> Judgement:
    """Return the judgement of stored states, with the likely causes of what failed if the run seeks them.

    The problem has the data as the solver rounds them. The count of steps has no time limit, so that the
    judgement is the same on every machine.
    """
    asked = load(run.scene)
    problem = solver_named(run.solver).problem(asked, rung_named(run.rung))
    stored = Stored(run.solver, states, steps)
    trajectory = stored.solve(problem)
    result = judgement(problem, stored, trajectory)
    # Under loads the candidates are many, and the row says how the loads were given.
    if asked.body.loads or not run.seeks_cause:
        return result
    return with_causes(result, problem, trajectory)


def errors_of(result: Judgement, scene: str) -> Errors:
    """Return the numbers of a judgement on a scene that the board stores."""
    states = {quantity.name for quantity in load(scene).tracked}
    verdicts = {verdict.quantity: verdict for verdict in result.verdicts}
    first = verdicts.pop(INITIAL, None)
    return Errors(
        start=None if first is None else _short(first.max),
        errors={name: e for name, v in verdicts.items() if (e := _short(v.max)) is not None},
        floors={
            name: a
            for name, v in verdicts.items()
            if name in states and (a := _short(v.attainable)) is not None
        },
        cause=_cause(result.causes, verdicts.values()),
    )


def _cause(causes: Iterable[LikelyCause], verdicts: Iterable[Verdict]) -> str:
    """Return the name of the cause that explains most of an error; the main quantity's comes first."""
    order = [verdict.quantity for verdict in verdicts]
    ordered = sorted(causes, key=lambda cause: (order.index(cause.quantity), cause.leaves))
    return ordered[0].name if ordered else ""


def _short(value: float | None) -> float | None:
    """Return an error in four digits; None if it is no finite number."""
    if value is None or not isfinite(value):
        return None
    return float(f"{value:.{_DIGITS - 1}e}")
