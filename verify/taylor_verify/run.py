"""The run of one scene: solved, compared with the exact motion, and judged."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from os import PathLike
from typing import Any, Literal

from taylor_verify import types


def run(
    scene: types.Scene | str | PathLike[str],
    solver: types.Solver | Callable[..., Any] | str = "taylor",
    rung: types.Rung | str = "f64",
    tolerance: types.Tolerances | types.Tolerance = None,
    *,
    causes: bool = True,
    baseline: str | PathLike[str] | Mapping[str, Any] | None = None,
    gate: Literal["bound", "baseline"] = "bound",
) -> types.Judgement:
    """Solve one scene on one rung and judge the answer.

    Parameters
    ----------
    scene
        A Scene, a path, or the name of a shipped scene.
    solver
        A Solver, a name such as ``taylor?tol=1e-9``, ``process:./mine`` or ``python:package.module:f``, or
        a callable ``solve(problem)``, as `check` takes it.
    rung
        A Rung or ``f32 f64 f80 f128 mpN``.
    tolerance
        The error that is allowed, in place of the bounds that follow from the arithmetic: a number for all
        quantities, or a number by quantity (``{"omega": 1e-8}``; the others keep their bounds). It is
        relative, and radians for the attitude.
    causes
        Whether the likely causes of failures are searched for. The search takes several times as long as
        the rest, and changes no verdict.
    baseline
        Earlier verdicts to compare with, as `--baseline` does: the path of ``verdicts.json`` of an earlier
        report, or of a document of `run --json`, or the document itself.
    gate
        ``bound``: the bounds decide, and the comparison besides. ``baseline``: the comparison alone.

    Returns
    -------
    judge.judgement.Judgement
        A Verdict on the start and for each tracked and each conserved quantity, and their record. That a
        solver fails, that this machine lacks a rung, and that a rung cannot hold the scene, are verdicts.
        With a ``baseline`` it has a ``comparison``, which must pass too.

    Raises
    ------
    records.faults.Refused
        For a scene or a baseline that cannot be read.
    ValueError
        For a name that is no solver or no rung, and for a tolerance that is no positive number below 1 or
        is given for a quantity that the scene does not have, and for a baseline that is none.
    """
    from taylor_verify.batch.comparison import ComparedJudgement
    from taylor_verify.batch.earlier_file import earlier
    from taylor_verify.chain import judge_scene

    before = earlier(baseline, gate)
    result = judge_scene(scene, solver, rung, tolerance, causes=causes)
    if before is None:
        return result
    comparison = before.compare_as_baseline(result, gate == "baseline")
    return ComparedJudgement(**result.common, comparison=comparison)


def solve(
    scene: types.Scene | str | PathLike[str],
    solver: types.Solver | Callable[..., Any] | str = "taylor",
    rung: types.Rung | str = "f64",
) -> types.Trajectory:
    """Solve one scene on one rung and return the trajectory, which nothing has judged.

    Parameters
    ----------
    scene, solver, rung
        As those of `run`.

    Returns
    -------
    solvers.trajectory.Trajectory
        The states at the scene's times, in the scene's units and body axes, and an ``outcome``: NumPy
        arrays of float64 on f64, of float32 on f32, and of exact numbers elsewhere. A run that fails or
        cannot begin has no states, says why in ``outcome`` and ``detail``, and is false.

    Raises
    ------
    records.faults.Refused
        For a scene that cannot be read.
    ValueError
        For a name that is no solver or no rung.
    """
    from taylor_verify.chain import solve_scene

    return solve_scene(scene, solver, rung)
