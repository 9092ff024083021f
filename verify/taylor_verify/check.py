"""Judge a solver of one's own, or a trajectory that is already in a file or in memory."""

from __future__ import annotations

from os import PathLike
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from taylor_verify.judge.judgement import Judgement
    from taylor_verify.models.problem import Problem
    from taylor_verify.scenes.precision import Rung
    from taylor_verify.scenes.scene import Scene


def check(
    scene: Scene | str | PathLike[str],
    solve_or_file: Callable[[Problem], Any] | str | PathLike[str] | Any,
    rung: Rung | str = "f64",
    accept_conventions: bool = False,
    partial: bool = False,
    columns: Mapping[str, str] | None = None,
) -> Judgement:
    """Judge a solver of one's own, a trajectory file, or a trajectory in memory, on a scene.

    Parameters
    ----------
    scene
        A Scene, a path, or the name of a shipped scene.
    solve_or_file
        A callable ``solve(problem) -> states``, the path of a trajectory file, or a trajectory in memory.
        States have the shape (samples, n): row k is the state at ``problem.times[k]``. Its columns are
        omega, q0..q3 or x, y, q0..q3, centre, untracked groups absent, in the scene's own units;
        ``problem.given`` holds the exact body, start and instants. A file is CSV, NPZ, Parquet or JSON
        (solvers.file). In memory it is a pandas or polars DataFrame, an xarray Dataset, a dict of arrays
        such as ``{"t": t, "omega": (n, 3), "attitude": (n, 3, 3), (n, 4) or a scipy Rotation}``, or SciPy's
        OdeResult, whose states are in the order above (solvers.objects). Numbers are taken exactly.
    rung
        The precision of the arithmetic that made the answer.
    accept_conventions
        Correct what was found out about the conventions of a file before it is judged.
    partial
        Accept a file that lacks tracked columns or covers a part of the span: its row `complete` is vacuous
        and counts for nothing. Without it this row is undecided. An answer of a callable is always whole.
    columns
        The column of the file or object for each of our names that it does not have itself nor by a usual
        name: ``{"w1": "rate about 1 [deg/s]", "t": "epoch"}``. A group names all of its components:
        ``{"omega": "gyro"}``.

    Returns
    -------
    judge.judgement.Judgement
        The verdicts and their record. That of a file is a judge.answer.FileJudgement, which has the
        conventions of the file that are not the scene's.

    Raises
    ------
    scenes.faults.Refused
        For a scene that cannot be read or a file that cannot be judged, with every fault of it.
    ValueError
        For what is neither a callable nor a trajectory, for a name that is no rung, and for ``columns`` of
        a callable.
    """
    if callable(solve_or_file):
        if columns:
            raise ValueError("expected `columns` with a trajectory, got them with a callable")
        from taylor_verify.run import run
        from taylor_verify.solvers.solver import Callback

        return run(scene, Callback(solve_or_file), rung)
    from taylor_verify.judge.answer import judge_file
    from taylor_verify.scenes.precision import rung as rung_named
    from taylor_verify.scenes.reader import as_scene
    from taylor_verify.solvers.file import read
    from taylor_verify.solvers.objects import pairs, trajectory

    asked, wanted = as_scene(scene), pairs(columns)
    is_path = isinstance(solve_or_file, str | PathLike)
    file = read(solve_or_file, wanted) if is_path else trajectory(solve_or_file, asked, wanted)
    return judge_file(file, asked, rung_named(rung), accept_conventions, partial)
