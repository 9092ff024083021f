"""Many scenes solved and judged, on all cores."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable
    from os import PathLike

    from taylor_verify.judge.judgement import Judgement


def run_many(
    scenes: Iterable[str | PathLike[str]],
    solver: str = "taylor",
    rungs: Iterable[str] = ("f64",),
    jobs: int | None = None,
) -> list[Judgement]:
    """Solve many scenes on some rungs and judge the answers, in ``jobs`` processes.

    A scene is a path or the name of a shipped scene, the solver the name of one, the rungs ``f32 f64 f80
    f128 mpN``. There are as many processes as cores unless ``jobs`` says how many. The judgements are in
    the order of the scenes, and of the rungs within each. Every process imports the script that calls
    this: there the call stands under ``if __name__ == "__main__":``.

    Raises scenes.faults.Refused for the first scene that cannot be read, ValueError for what is no
    solver, no rung or no number of processes, and parallel.Failed for a run that broke: all but the last
    before anything runs.
    """
    import os

    from taylor_verify.job import jobs as jobs_of
    from taylor_verify.scenes.precision import rung
    from taylor_verify.scenes.reader import load
    from taylor_verify.solvers.registry import check_name
    from taylor_verify.standard import run_all

    if jobs is not None and not jobs >= 1:
        raise ValueError(f"expected jobs of at least 1, got {jobs}")
    check_name(solver)
    names = [os.fspath(scene) for scene in scenes]
    for name in names:
        load(name)
    asked = jobs_of(names, solver, [rung(name).name for name in dict.fromkeys(rungs)])
    return run_all(asked, lambda job: None, jobs) if asked else []
