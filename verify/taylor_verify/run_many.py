"""Many scenes solved and judged, on all cores or on any executor."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from os import PathLike
from typing import Any, Literal

from taylor_verify import types


def run_many(
    scenes: (
        str
        | PathLike[str]
        | types.Scene
        | types.Selection
        | Iterable[types.Scene | str | PathLike[str]]
        | None
    ) = None,
    solver: types.Solver | Callable[..., Any] | str = "taylor",
    rungs: str | Iterable[str] | None = None,
    jobs: int | None = None,
    executor: types.Executor | None = None,
    resume: bool = False,
    out: str | PathLike[str] | None = None,
    progress: types.Progress | None = None,
    tolerance: types.Tolerances | types.Tolerance = None,
    *,
    baseline: str | PathLike[str] | Mapping[str, Any] | None = None,
    gate: Literal["bound", "baseline"] = "bound",
) -> types.Judgements:
    """Solve many scenes on some rungs and judge the answers.

    Parameters
    ----------
    scenes
        Scenes, paths, names of shipped scenes, or folders of these (``extremes``), or a single one; a
        scene named twice is run once. None is the standard set. A `batch.chosen_scenes.Selection` says what
        will be run, what is left out, and what is doubtful, before anything runs.
    solver
        A solver, its name or a callable, as that of `run`. A callable is sent to the processes: one that is
        written in a notebook, and a lambda, need cloudpickle.
    rungs
        ``f32 f64 f80 f128 mpN``, or a single one. None is f64, and all five of the ladder for the standard
        set.
    jobs
        The number of processes on this machine; as many as cores unless given. A single scene runs in
        this process.
    executor
        A `concurrent.futures.Executor` that takes the place of those processes. Only its ``submit`` is
        called, and it is left open. Scenes and judgements are pickled where it has processes. Threads of
        one process take turns, because the arithmetic has one working precision for a process.
    resume
        Go on from the scenes that the same call, in the same folder, had finished before it was
        interrupted.
    out
        A folder into which verdicts, records and tables are written. No other run may write to it
        meanwhile.
    progress
        Called as ``progress(finished, total, job)`` at the start, with None for the job, and as each scene
        ends. ``str(job)`` names the scene and its rungs.
    tolerance
        The error that is allowed, as that of `run`. A name is that of a quantity of some of the scenes.
    baseline, gate
        Earlier verdicts to compare with, and what decides, as those of `run`.

    Returns
    -------
    batch.judgements.Judgements
        A sequence of Judgement, in the order of the scenes and of the rungs within each. Errors
        and bounds are in the unit of each Verdict, times in that of the scene.

    Raises
    ------
    records.faults.Refused
        For scenes that cannot be read, with every fault of all of them.
    ValueError
        For what is no solver, no rung, no number of processes, no tolerance or no baseline, and for any
        other argument of a wrong kind.
    batch.lock.Occupied
        If another run writes to ``out``.
    batch.failure.Failed
        For a run that broke, whose process was lost, or of which the executor made another error; the text
        names scene and rung.
    batch.judging.Interrupted
        A KeyboardInterrupt that says how many scenes are stored for ``resume``.
    batch.report.ReportNotWritten
        An OSError, if all was run and ``out`` could not be written; it has the ``results``.

    Notes
    -----
    All errors but the last three are raised before anything runs. A process imports the script that calls
    this only for a function that is written there, and where cloudpickle is not installed: then the call
    stands under ``if __name__ == "__main__":``.
    """
    from contextlib import nullcontext
    from dataclasses import replace
    from pathlib import Path

    from taylor_verify.batch.chosen_scenes import Selection, select
    from taylor_verify.batch.earlier_file import earlier
    from taylor_verify.batch.judgements import Judgements
    from taylor_verify.batch.judging import judge_all
    from taylor_verify.batch.lock import alone_in
    from taylor_verify.batch.report import ReportNotWritten
    from taylor_verify.judge.tolerances import tolerances
    from taylor_verify.report.folder import write_report
    from taylor_verify.solvers.registry import as_solver

    if faults := list(_faults(solver, jobs, executor, resume, out, progress)):
        raise ValueError("\n".join(faults))
    before = earlier(baseline, gate)
    chosen = as_solver(solver)
    name = solver if isinstance(solver, str) else chosen.name
    if isinstance(scenes, Selection) and rungs is not None:
        raise ValueError("expected rungs within the Selection, got others besides @ rungs")
    selection = scenes if isinstance(scenes, Selection) else select(scenes, rungs)
    tolerated = tolerances(tolerance, selection.scenes)
    folder = Path(out) if out is not None else None
    with alone_in(folder) if folder is not None else nullcontext():
        asked = selection.jobs(solver if isinstance(solver, str) else chosen, tolerated)
        judgements = judge_all(asked, progress, jobs, executor, resume, folder)
        results = Judgements(tuple(judgements), selection, name)
        if before is not None:
            comparison = before.compare_as_baseline(results, gate == "baseline")
            results = replace(results, comparison=comparison)
        if folder is not None:
            try:
                write_report(folder, results)
            except (OSError, ValueError) as error:
                reason = getattr(error, "strerror", None) or error
                message = f"expected to write the reports, got {reason} @ {folder}"
                raise ReportNotWritten(message, results) from error
    return results


def _faults(
    solver: object, jobs: object, executor: object, resume: object, out: object, progress: object
) -> Iterator[str]:
    """Yield a sentence for each argument of a wrong kind."""
    from numbers import Integral

    from taylor_verify.records.faults import brief
    from taylor_verify.solvers.solver import Solver

    if not isinstance(solver, str | Solver) and not callable(solver):
        yield f"expected a solver, the name of one or a callable, got {brief(solver)} @ solver"
    is_count = isinstance(jobs, Integral) and not isinstance(jobs, bool) and int(jobs) >= 1
    if jobs is not None and not is_count:
        yield f"expected jobs of at least 1, got {brief(jobs)} @ jobs"
    elif jobs is not None and executor is not None:
        yield "expected jobs or an executor, which has its own number, got both @ jobs"
    if executor is not None and not callable(getattr(executor, "submit", None)):
        yield f"expected an executor with a method submit, got {brief(executor)} @ executor"
    if not isinstance(resume, bool):
        yield f"expected True or False, got {brief(resume)} @ resume"
    if out is not None and not isinstance(out, str | PathLike):
        yield f"expected the path of a folder, got {brief(out)} @ out"
    if progress is not None and not callable(progress):
        yield f"expected a function (finished, total, job), got {brief(progress)} @ progress"
