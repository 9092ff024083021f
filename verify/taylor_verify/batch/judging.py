"""Jobs judged on any executor: each stored as it ends, so that an interrupted run can go on."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from pathlib import Path

from taylor_verify.batch.failure import Failed, failing
from taylor_verify.batch.finished_jobs import unfinished
from taylor_verify.batch.job import Job
from taylor_verify.batch.work import run_all
from taylor_verify.judge.judgement import Judgement, unjudged
from taylor_verify.numbers.precision import rung as rung_named
from taylor_verify.records.faults import Refused
from taylor_verify.records.reason import Cause
from taylor_verify.records.status import Status
from taylor_verify.scenes.reading.reader import as_scene
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.registry import PYTHON, as_solver
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.trajectory import Outcome

Progress = Callable[[int, int, Job | None], None]
"""Called with the jobs finished, all jobs, and the one that has just ended (None at the start)."""

# The cost of a run in units of one state in closed form. A Taylor series costs ten times as much, and so
# many radians as much as one more state.
_TAYLOR = 10
_RADIANS_PER_STATE = 1e5


class Interrupted(KeyboardInterrupt):
    """An interrupt of a run of which ``finished`` of ``jobs`` jobs are stored, to go on from there."""

    def __init__(self, finished: int, jobs: int) -> None:
        super().__init__(finished, jobs)
        self.finished, self.jobs = finished, jobs

    def __str__(self) -> str:
        return f"interrupted: {self.finished} of {self.jobs} scenes are stored, to go on from there"


def judge_all(
    jobs: Sequence[Job],
    progress: Progress | None = None,
    workers: int | None = None,
    executor: Executor | None = None,
    resume: bool = False,
    out: Path | None = None,
) -> list[Judgement]:
    """Return every job's judgements, rung by rung, in the order of the jobs.

    Of several jobs each is stored as it ends, until all have, in a folder of this run into ``out``.
    With ``resume``, what the same run had finished before an interrupt is not run again. An
    interrupt is raised as Interrupted.

    One job runs in this process, unless a function that somebody names could end it; several on the
    ``executor``, or in as many ``workers`` as there are cores: heyoka's compiled integrators and the
    truth's big integers both hold the interpreter. Raises Failed for a job that broke, or lost its process;
    whatever ends this early ends the workers first.
    """
    ended = 0

    def report(job: Job | None) -> None:
        nonlocal ended
        ended += job is not None
        if progress is not None:
            progress(ended, len(jobs), job)

    report(None)
    # With the `os._exit(0)` of a function by its name this process would seem to pass.
    is_named = any(isinstance(j.solver, str) and j.solver.startswith(PYTHON) for j in jobs)
    if len(jobs) == 1 and executor is None and not is_named:
        judgements = run_job(jobs[0])
        report(jobs[0])
        return judgements
    with unfinished(jobs, out, resume) as store:

        def keep(job: Job, judgements: list[Judgement]) -> None:
            if store:
                store.keep(job, judgements)
            report(job)

        stored = [store.recall(job) if store else None for job in jobs]
        waiting = []
        for job, known in zip(jobs, stored, strict=True):
            if known is None:
                waiting.append(job)
            else:
                report(job)
        try:
            made = run_all(
                run_beside_others,
                waiting,
                executor,
                workers=workers,
                expense=_expense,
                ended=keep,
                raises=Failed,
            )
        except KeyboardInterrupt as interrupt:
            raise Interrupted(ended if store else 0, len(jobs)) from interrupt
        if store:
            store.forget()
    rest = iter(made)
    return [each for known in stored for each in (next(rest) if known is None else known)]


def run_job(job: Job) -> list[Judgement]:
    """Return the judgements of a job, rung by rung. Raises Failed, with the scene and the rung."""
    scene = _scene(job)
    return [_judged(job, scene, rung) for rung in job.rungs]


def run_beside_others(job: Job) -> list[Judgement]:
    """Return the judgements of a job; a scene that breaks the code is undecided, and stops no other job.

    Raises Failed for a scene that cannot be read, and for what the machine lacks.
    """
    scene, judgements = _scene(job), []
    for rung in job.rungs:
        try:
            judgements.append(_judged(job, scene, rung))
        except Failed as lost:
            if isinstance(lost.__cause__, MemoryError | ImportError):
                raise
            judgements.append(_broken(scene, job.solver, rung, str(lost)))
    return judgements


def _scene(job: Job) -> Scene:
    with failing(job.name, Refused):
        return as_scene(job.scene)


def _judged(job: Job, scene: Scene, rung: str) -> Judgement:
    # Not at the top: where others judge, this process does without it, which takes 300 ms.
    from taylor_verify.chain import judge_scene

    with failing(f"{job.name} on {rung}", Refused):
        return judge_scene(scene, job.solver, rung, job.tolerances)


def _broken(scene: Scene, solver: Solver | str, rung: str, why: str) -> Judgement:
    asked = as_solver(solver), rung_named(rung)
    return unjudged(scene, *asked, Status.UNDECIDED, why, Cause.UNFINISHED, Outcome.RAISED)


def _expense(job: Job) -> float:
    """Return a rank by cost: the longest jobs begin first, so that no core waits for one at the end.

    It counts the tracked states, and ten times as much where the truth, or the flow between two samples of
    a loaded body, is no closed form; of long runs the radians.
    """
    scene = as_scene(job.scene)
    body, start = scene.body, scene.initial
    states = len(start.moving) * (1 + 3 * len(scene.track))
    spin = max(map(abs, start.parts().get("omega", (0,))))
    radians = float(spin * abs(scene.clock.elapsed[-1]))
    return -states * (1 if body.is_integrable else _TAYLOR) - radians / _RADIANS_PER_STATE
