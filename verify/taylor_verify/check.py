"""Judge a solver of one's own, or a trajectory that is already in a file."""

from __future__ import annotations

from os import PathLike
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

    from taylor_verify.judge.judgement import Judgement
    from taylor_verify.models.problem import Problem
    from taylor_verify.scenes.precision import Rung
    from taylor_verify.scenes.scene import Scene


def check(
    scene: Scene | str | PathLike[str],
    solve_or_file: Callable[[Problem], Any] | str | PathLike[str],
    rung: Rung | str = "f64",
    accept_conventions: bool = False,
    partial: bool = False,
) -> Judgement:
    """Judge ``solve(problem) -> states`` or a trajectory file on a scene.

    A callable returns states of shape (samples, n). Row k is the state at problem.times[k]: omega,
    q0..q3 or x, y, q0..q3, centre, untracked groups absent, in the scene's own units;
    ``problem.given`` holds the exact body, start and instants.

    A file (CSV, NPZ, Parquet, JSON; see solvers.file) was made in the arithmetic of ``rung``. Its
    judgement is a judge.answer.FileJudgement, which says what was found out about its conventions;
    they are corrected with ``accept_conventions`` only. A file that lacks tracked columns, or covers a
    part of the span, has a row `complete` that is undecided; with ``partial`` it is vacuous and counts
    for nothing. An answer of a callable is always whole. Raises scenes.faults.Refused for a file that
    cannot be judged, with every fault of it, and ValueError for what is neither a callable nor a file.
    """
    if callable(solve_or_file):
        from taylor_verify.run import run
        from taylor_verify.solvers.solver import Callback

        return run(scene, Callback(solve_or_file), rung)
    if not isinstance(solve_or_file, str | PathLike):
        kind = type(solve_or_file).__name__
        raise ValueError(
            f"expected a callable solve(problem) or a trajectory file, got {kind} "
            "(write it to a file, or return it from a callable)"
        )
    from taylor_verify.judge.answer import judge_file
    from taylor_verify.scenes.precision import rung as rung_named
    from taylor_verify.scenes.reader import as_scene
    from taylor_verify.solvers.file import read

    file = read(solve_or_file)
    return judge_file(file, as_scene(scene), rung_named(rung), accept_conventions, partial)
