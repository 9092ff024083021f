"""Judge your own solver, or a trajectory that is already in a file or in memory."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from typing import Any, overload

from taylor_verify import types
from taylor_verify.numbers.working_precision import in_turn


@overload
def check(
    scene: types.Scene | str | PathLike[str],
    solve_or_file: Callable[[types.Problem], Any] | str | PathLike[str] | Any,
    rung: types.Rung | str = "f64",
    accept_conventions: bool = False,
    partial: bool = False,
    tolerance: types.Tolerances | types.Tolerance = None,
    columns: Mapping[str, str] | None = None,
) -> types.Judgement: ...
@overload
def check(
    scene: types.Scene | str | PathLike[str],
    solve_or_file: Any,
    rung: types.Rung | str = "f64",
    *,
    tolerance: types.Tolerances | types.Tolerance = None,
    event: str,
) -> types.EventsJudgement: ...
@overload
def check(
    scene: list[Any] | tuple[Any, ...],
    solve_or_file: Callable[[types.Problem], Any] | types.Solver | str,
    rung: types.Rung | str = "f64",
    accept_conventions: bool = False,
    partial: bool = False,
    tolerance: types.Tolerances | types.Tolerance = None,
    columns: Mapping[str, str] | None = None,
) -> types.Judgements: ...
@overload
def check(
    scene: types.Scene | str | PathLike[str],
    solve_or_file: list[Any] | tuple[Any, ...],
    rung: types.Rung | str = "f64",
    accept_conventions: bool = False,
    partial: bool = False,
    tolerance: types.Tolerances | types.Tolerance = None,
    columns: Mapping[str, str] | None = None,
    *,
    steps: Sequence[float] | None = None,
    knob: str = "",
) -> types.FilesJudgement: ...
@in_turn
def check(
    scene: types.Scene | str | PathLike[str] | list[Any] | tuple[Any, ...],
    solve_or_file: Callable[[types.Problem], Any] | types.Solver | str | PathLike[str] | Any,
    rung: types.Rung | str = "f64",
    accept_conventions: bool = False,
    partial: bool = False,
    tolerance: types.Tolerances | types.Tolerance = None,
    columns: Mapping[str, str] | None = None,
    *,
    steps: Sequence[float] | None = None,
    knob: str = "",
    event: str | None = None,
) -> types.Judgement | types.Judgements | types.EventsJudgement:
    """Judge your own solver, a trajectory file, or a trajectory in memory, on a scene.

    Parameters
    ----------
    scene
        A Scene, a path, or the name of a shipped scene; or a list of these for a callable, which is then
        judged on all cores as by `run_many`.
    solve_or_file
        A callable ``solve(problem)``, ``python:package.module:function``, the path of a trajectory file, a
        trajectory in memory, or a list of these: answers of one solver at several steps. A callable returns
        states of the shape (samples, n): row k is the state at ``problem.given.clock.instants[k]``. Its
        columns are omega, q0..q3 or x, y, q0..q3, centre, untracked groups absent, in the scene's own
        units; ``problem.given`` holds the exact body, start and instants. It may also return (t, y),
        SciPy's OdeResult, a dense output, which is sampled, or a trajectory in memory. A file is CSV,
        NPZ, Parquet, JSON or another of solvers.files.formats.reading. In memory it is a pandas or polars
        DataFrame, an xarray Dataset, a dict of arrays such as
        ``{"t": t, "omega": (n, 3), "attitude": (n, 3, 3), (n, 4) or a scipy Rotation}``, or SciPy's
        OdeResult, whose states are in the order above (solvers.files.objects). Numbers are taken exactly.
    rung
        The precision of the arithmetic that made the answer.
    accept_conventions
        Correct the conventions that were detected in a file before it is judged.
    partial
        Accept a file that lacks tracked columns or covers a part of the span: its row `complete` is vacuous
        and counts for nothing. Without it this row is undecided. An answer of a callable is always whole.
    tolerance
        The error that is allowed, as that of `run`.
    columns
        The column of the file or object for each of our names that it does not have itself nor by a usual
        name: ``{"w1": "rate about 1 [deg/s]", "t": "epoch"}``. A group names all of its components:
        ``{"omega": "gyro"}``.
    steps
        The step that the solver took in each answer of a list, in the scene's unit of time. Without it the
        files say their steps, or their names do (``run_h0.05.csv``).
    knob
        What differs between the answers of a list in place of the step, such as ``"rtol"``: its number is
        read in the names of the files (``run_rtol1e-6.csv``).
    event
        Judge the times of this event in place of the states: ``"w2 = 0"``, as in `events`. The answer is
        then a list of times, an OdeResult with the ``t_events`` of one event, or a file with a column or
        list ``events``.

    Returns
    -------
    judge.judgement.Judgement
        The verdicts and their record. That of a file is a judge.files.judgement.FileJudgement, which has
        the conventions of the file that are not the scene's; that of a list a
        judge.series.files.FilesJudgement, which has the order of convergence of each quantity. With
        ``event`` it is a judge.events.EventsJudgement: answered, missed and invented times.

    Raises
    ------
    records.faults.Refused
        For a scene that cannot be read or a file that cannot be judged, with every fault of it.
    ValueError
        For what is neither a callable nor a trajectory, for a name that is no rung, for a tolerance as
        `run`, for ``columns`` of a callable, and for ``steps`` that are no step for each answer of a list.
    """
    from taylor_verify.judge.tolerances import tolerances
    from taylor_verify.numbers.precision import rung as rung_named
    from taylor_verify.scenes.reading.reader import as_scene
    from taylor_verify.solvers.registry import PYTHON
    from taylor_verify.solvers.solver import Solver

    question: Any = scene
    answer: Any = solve_or_file
    is_path = isinstance(answer, str | PathLike)
    if event is not None:
        from taylor_verify.exact.request import exact_times
        from taylor_verify.judge.events import given_times, judge_events
        from taylor_verify.solvers.files.events import read_events

        scene = as_scene(question)
        times = read_events(answer) if is_path else exact_times(given_times(answer))
        allowed = tolerances(tolerance, [scene]).every
        name = str(answer) if is_path else ""
        return judge_events(scene, event, times, rung_named(rung), allowed, name)
    is_named = isinstance(answer, str) and answer.startswith(PYTHON)
    if callable(answer) or is_named or isinstance(answer, Solver):
        if columns:
            raise ValueError("expected `columns` with a trajectory, got them with a callable")
        if isinstance(scene, list | tuple):
            from taylor_verify.run_many import run_many

            return run_many(scene, answer, [rung_named(rung).name], tolerance=tolerance)
        from taylor_verify.chain import judge_scene

        return judge_scene(scene, answer, rung, tolerance)
    if isinstance(scene, list | tuple):
        raise ValueError(
            "expected a callable with several scenes, got a trajectory @ solve_or_file"
        )
    from taylor_verify.judge.files.judgement import judge_file
    from taylor_verify.judge.series.files import judge_files
    from taylor_verify.solvers.files.file import read
    from taylor_verify.solvers.files.objects import pairs, trajectory

    scene = as_scene(scene)
    if isinstance(answer, list | tuple):
        options = (rung, accept_conventions, partial, tolerance, columns)
        return judge_files(answer, steps, lambda file: check(scene, file, *options), knob)
    if steps is not None or knob:
        given = "steps" if steps is not None else "knob"
        raise ValueError(f"expected a list of files with {given}, got one answer @ {given}")
    wanted = pairs(columns)
    asked = tolerances(tolerance, [scene])
    file = read(answer, wanted, scene) if is_path else trajectory(answer, scene, wanted)
    return judge_file(file, scene, rung_named(rung), accept_conventions, partial, asked)
