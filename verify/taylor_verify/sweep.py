"""Many bodies and starts, drawn from a family or read from a folder: solved, judged and summed up."""

from __future__ import annotations

from collections.abc import Callable
from os import PathLike
from typing import Any

from taylor_verify import types


def sweep(
    what: str | PathLike[str],
    *,
    count: int | None = None,
    seed: int | None = None,
    points: str | None = None,
    solver: types.Solver | Callable[..., Any] | str = "taylor",
    rung: str = "f64",
    tolerance: types.Tolerances | types.Tolerance = None,
    executor: types.Executor | None = None,
    jobs: int | None = None,
    out: str | PathLike[str] | None = None,
    resume: bool = False,
    worst: int = 10,
    ahead: int = 64,
) -> types.SweepSummary:
    """Solve and judge many scenes; return how their errors are spread, and the worst of them.

    Parameters
    ----------
    what
        A shipped family (``satellites``), the path of a template, a folder of scene files, or a folder of
        shipped scenes (``extremes``).
    count, seed, points
        How many points are drawn, from which seed, and ``random`` or ``sobol``. Point k of a seed is the
        same however many are drawn. What is None is what the template says, else 100, 1 and ``random``.
    solver, rung, tolerance
        As those of `run`.
    executor
        A `concurrent.futures.Executor` in place of processes of this machine. Only its ``submit`` is
        called, and it is left open. Chunks and rows are pickled; a worker writes nothing.
    jobs
        The number of processes on this machine; as many as cores unless given.
    out
        A folder for the dataset, the summary and the worst cases. Without it nothing is left.
    resume
        Go on from the chunks that the same sweep, in the same folder, had finished.
    worst
        The number of worst cases that are written as scenes.
    ahead
        The number of chunks under way at a time.

    Raises
    ------
    records.faults.Refused
        For a template or scenes that cannot be read, with all their faults, and for a folder that holds
        another sweep.
    ValueError
        For an argument that is none.
    batch.lock.Occupied
        If another run writes to ``out``.
    batch.failure.Failed
        For a chunk whose process was lost, or of which the executor made an error.
    batch.judging.Interrupted
        A KeyboardInterrupt that says how many scenes are stored for ``resume``.

    """
    from taylor_verify.batch.sweeps import sweep as room

    asked = {"count": count, "seed": seed, "points": points}
    how = {"solver": solver, "rung": rung, "tolerance": tolerance, "executor": executor}
    where = {"jobs": jobs, "out": out, "resume": resume, "worst": worst, "ahead": ahead}
    options: dict[str, Any] = {**asked, **how, **where}
    return room.sweep(what, **options)
