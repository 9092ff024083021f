"""The chain for one scene: scene, problem, trajectory, truth and judgement."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from os import PathLike
from time import perf_counter
from typing import Any

from taylor_verify import types
from taylor_verify.judge.causes.likely import with_causes
from taylor_verify.judge.files.judgement import judge_file
from taylor_verify.judge.files.stored import with_note_of_answer
from taylor_verify.judge.judgement import Judgement, judgement, unjudged
from taylor_verify.judge.tolerances import Tolerances, tolerances
from taylor_verify.models.problem import NotRepresentable, Problem
from taylor_verify.numbers.precision import Rung
from taylor_verify.numbers.precision import rung as rung_named
from taylor_verify.numbers.working_precision import in_turn
from taylor_verify.records.faults import Refused
from taylor_verify.records.reason import Cause
from taylor_verify.records.status import Status
from taylor_verify.scenes.doubles import within_doubles
from taylor_verify.scenes.reading.reader import as_scene
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.callback import Callback
from taylor_verify.solvers.files.file import TrajectoryFile
from taylor_verify.solvers.registry import as_solver
from taylor_verify.solvers.solver import Lack, Solver, raised
from taylor_verify.solvers.trajectory import Outcome, Trajectory, native


@in_turn
def judge_scene(
    scene: types.Scene | str | PathLike[str],
    solver: types.Solver | Callable[..., Any] | str = "taylor",
    rung: types.Rung | str = "f64",
    tolerance: types.Tolerances | types.Tolerance = None,
    *,
    causes: bool = True,
) -> types.Judgement:
    """Solve one scene on one rung and judge the answer, as the public `run` describes it."""
    scene, solver, rung = as_scene(scene), as_solver(solver), rung_named(rung)
    asked = tolerances(tolerance, [scene])
    problem = posed(scene, solver, rung)
    if isinstance(problem, Trajectory):
        return _not_begun(scene, solver, rung, problem)
    began = perf_counter()
    try:
        trajectory = _answer(solver, problem)
    except NotRepresentable as reason:
        trajectory = Trajectory(Outcome.NOT_REPRESENTABLE, detail=str(reason))
        return _not_begun(scene, solver, rung, trajectory)
    seconds = perf_counter() - began
    if trajectory.file is not None:
        try:
            return _judged_as_file(scene, solver, rung, trajectory.file, asked)
        except Refused as fault:
            trajectory = Trajectory(Outcome.MISSHAPEN, detail=str(fault))
    judged = judgement(problem, solver, trajectory, seconds, asked)
    if causes:
        judged = with_causes(judged, problem, trajectory)
    return with_note_of_answer(judged, rung, trajectory)


def _not_begun(scene: Scene, solver: Solver, rung: Rung, trajectory: Trajectory) -> Judgement:
    """Return the judgement of a run that could not begin, by the outcome that says why."""
    outcome = trajectory.outcome
    is_refused, is_missing = outcome is Outcome.NOT_REPRESENTABLE, outcome is Outcome.NO_PACKAGE
    status = Status.REFUSED if is_refused else Status.UNAVAILABLE
    cause = Cause.MISSING_PACKAGE if is_missing else Cause.NOT_POSED
    return unjudged(scene, solver, rung, status, trajectory.detail, cause, outcome)


def _judged_as_file(
    scene: Scene, solver: Solver, rung: Rung, file: TrajectoryFile, asked: Tolerances
) -> Judgement:
    """Judge the rows of a user's function at their own times, under the name of the function."""
    judged = judge_file(file, scene, rung, tolerances=asked)
    verdicts = (replace(v, solver=solver.name, setting=solver.setting) for v in judged.verdicts)
    record = judged.record and replace(judged.record, solver=solver.name)
    return replace(judged, verdicts=tuple(verdicts), record=record)


@in_turn
def solve_scene(
    scene: types.Scene | str | PathLike[str],
    solver: types.Solver | Callable[..., Any] | str = "taylor",
    rung: types.Rung | str = "f64",
) -> types.Trajectory:
    """Return the trajectory of a solver, as the public `solve` describes it."""
    solver, rung = as_solver(solver), rung_named(rung)
    problem = posed(as_scene(scene), solver, rung)
    if isinstance(problem, Trajectory):
        return problem
    try:
        answered = _answer(solver, problem)
    except NotRepresentable as reason:
        return Trajectory(Outcome.NOT_REPRESENTABLE, detail=str(reason))
    times = problem.given.clock.instants if answered.file is None else answered.file.times
    quantities = native(answered.quantities, rung)
    return replace(answered, quantities=quantities, times=tuple(times) if quantities else ())


def posed(scene: Scene, solver: Solver, rung: Rung) -> Problem | Trajectory:
    """Return the problem, or a trajectory whose outcome is the reason why there is none."""
    if missing := solver.unavailable(rung):
        lack = missing.outcome if isinstance(missing, Lack) else Outcome.UNSUITED
        return Trajectory(lack, detail=str(missing))
    try:
        problem = solver.problem(scene, rung)
    except NotRepresentable as reason:
        return Trajectory(Outcome.NOT_REPRESENTABLE, detail=str(reason))
    if unsuited := solver.unsuited(problem):
        return Trajectory(Outcome.UNSUITED, detail=str(unsuited))
    return problem


def _answer(solver: Solver, problem: Problem) -> Trajectory:
    """Return the solver's trajectory; a solver that calls `sys.exit` has failed, its caller goes on.

    Raises NotRepresentable where sizes of the scene are beyond the doubles that its steps are chosen by.
    """
    try:
        if isinstance(solver, Callback):
            return solver.answered(problem)
        with within_doubles(problem.scene, NotRepresentable, has_warnings=False):
            return solver.solve(problem)
    except SystemExit as end:
        return raised(end)
