"""Many runs on all cores: scenes and rungs in, judgements out in the order they were asked for."""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from dataclasses import dataclass

from verify.judge.judgement import Judgement
from verify.scenes.precision import rung as rung_named


@dataclass(frozen=True)
class Job:
    """One scene on several rungs by one solver: the rungs share the condition of the orbit."""

    scene: str
    solver: str
    rungs: tuple[str, ...]


Finished = Callable[[Job], None]


def jobs(scenes: Iterable[str], solver: str, rungs: Sequence[str]) -> list[Job]:
    return [Job(scene, solver, tuple(rungs)) for scene in scenes]


def run_all(
    asked: Sequence[Job], finished: Finished, workers: int | None = None
) -> list[Judgement]:
    """Every job's judgements, rung by rung; ``finished`` is told of each job as it ends.

    One job runs in this process, several in as many as there are cores: heyoka's compiled
    integrators and the truth's big integers both hold the interpreter. An error in a job is raised.
    """
    workers = min(workers or available_cores(), len(asked))
    if workers <= 1:
        results = []
        for job in asked:
            results.append(_run(job))
            finished(job)
        return [judgement for result in results for judgement in result]
    # Not fork: heyoka's threads and locks do not survive it.
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(workers, mp_context=context) as pool:
        futures = {job: pool.submit(_run, job) for job in sorted(asked, key=_expense)}
        _report(futures, finished)
        return [judgement for job in asked for judgement in futures[job].result()]


def available_cores() -> int:
    """The cores this process may use, which in a container are fewer than the machine has."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _run(job: Job) -> list[Judgement]:
    from verify.run import run

    return [run(job.scene, job.solver, rung) for rung in job.rungs]


def _report(futures: dict[Job, Future[list[Judgement]]], finished: Finished) -> None:
    by_future = {future: job for job, future in futures.items()}
    for future in as_completed(by_future):
        future.result()
        finished(by_future[future])


def _expense(job: Job) -> tuple[int, int]:
    """The longest first, so that no core is left with one at the end.

    Precision counts most, then what is tracked: the scene is read again, which costs a millisecond.
    """
    from verify.scenes.reader import load

    bits = max(rung_named(name).bits for name in job.rungs)
    scene = load(job.scene)
    weight = {"euler": 3, "kirchhoff": 6}[scene.model] * (1 + 3 * len(scene.track))
    return (-weight, -bits)

