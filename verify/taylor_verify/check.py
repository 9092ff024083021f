"""Judge your own solver, or a trajectory that is already in a file or in memory."""

from __future__ import annotations

from os import PathLike
from typing import TYPE_CHECKING, Any, overload

from taylor_verify.numbers.working_precision import in_turn

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from taylor_verify.judge.judgement import Judgement
    from taylor_verify.judge.series.files import FilesJudgement
    from taylor_verify.judge.tolerances import Tolerance, Tolerances
    from taylor_verify.models.problem import Problem
    from taylor_verify.numbers.precision import Rung
    from taylor_verify.scenes.scene import Scene


@overload
def check(
    scene: Scene | str | PathLike[str],
    solve_or_file: Callable[[Problem], Any] | str | PathLike[str] | Any,
    rung: Rung | str = "f64",
    accept_conventions: bool = False,
    partial: bool = False,
    tolerance: Tolerances | Tolerance = None,
    columns: Mapping[str, str] | None = None,
) -> Judgement: ...
@overload
def check(
    scene: Scene | str | PathLike[str],
    solve_or_file: list[Any] | tuple[Any, ...],
    rung: Rung | str = "f64",
    accept_conventions: bool = False,
    partial: bool = False,
    tolerance: Tolerances | Tolerance = None,
    columns: Mapping[str, str] | None = None,
    *,
    steps: Sequence[float] | None = None,
    knob: str = "",
) -> FilesJudgement: ...
@in_turn
def check(
    scene: Scene | str | PathLike[str],
    solve_or_file: Callable[[Problem], Any] | str | PathLike[str] | Any,
    rung: Rung | str = "f64",
    accept_conventions: bool = False,
    partial: bool = False,
    tolerance: Tolerances | Tolerance = None,
    columns: Mapping[str, str] | None = None,
    *,
    steps: Sequence[float] | None = None,
    knob: str = "",
) -> Judgement:
    """Judge your own solver, a trajectory file, or a trajectory in memory, on a scene.

    Parameters
    ----------
    scene
        A Scene, a path, or the name of a shipped scene.
    solve_or_file
        A callable ``solve(problem) -> states``, the path of a trajectory file, a trajectory in memory, or a
        list of these: answers of one solver at several steps. States have the shape (samples, n): row k is
        the state at ``problem.given.clock.instants[k]``. Its columns are omega, q0..q3 or x, y, q0..q3,
        centre, untracked groups absent, in the scene's own units; ``problem.given`` holds the exact body,
        start and instants. A file is CSV, NPZ, Parquet, JSON or another of
        solvers.files.formats.reading. In memory it is a pandas or polars DataFrame, an
        xarray Dataset, a dict of arrays such as
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

    Returns
    -------
    judge.judgement.Judgement
        The verdicts and their record. That of a file is a judge.files.judgement.FileJudgement, which has
        the conventions of the file that are not the scene's; that of a list a
        judge.series.files.FilesJudgement, which has the order of convergence of each quantity.

    Raises
    ------
    records.faults.Refused
        For a scene that cannot be read or a file that cannot be judged, with every fault of it.
    ValueError
        For what is neither a callable nor a trajectory, for a name that is no rung, for a tolerance as
        `run`, for ``columns`` of a callable, and for ``steps`` that are no step for each answer of a list.
    """
    if callable(solve_or_file):
        if columns:
            raise ValueError("expected `columns` with a trajectory, got them with a callable")
        from taylor_verify.run import run
        from taylor_verify.solvers.solver import Callback

        return run(scene, Callback(solve_or_file), rung, tolerance)
    from taylor_verify.judge.files.judgement import judge_file
    from taylor_verify.judge.series.files import judge_files
    from taylor_verify.judge.tolerances import tolerances
    from taylor_verify.numbers.precision import rung as rung_named
    from taylor_verify.scenes.reading.reader import as_scene
    from taylor_verify.solvers.files.file import read
    from taylor_verify.solvers.files.objects import pairs, trajectory

    scene = as_scene(scene)
    if isinstance(solve_or_file, list | tuple):
        options = (rung, accept_conventions, partial, tolerance, columns)
        return judge_files(solve_or_file, steps, lambda file: check(scene, file, *options), knob)
    if steps is not None or knob:
        given = "steps" if steps is not None else "knob"
        raise ValueError(f"expected a list of files with {given}, got one answer @ {given}")
    wanted = pairs(columns)
    asked = tolerances(tolerance, [scene])
    is_path = isinstance(solve_or_file, str | PathLike)
    file = (
        read(solve_or_file, wanted, scene) if is_path else trajectory(solve_or_file, scene, wanted)
    )
    return judge_file(file, scene, rung_named(rung), accept_conventions, partial, asked)
