"""Many runs on all cores: scenes and rungs in, judgements out in the order they were asked for."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from taylor_verify.job import Job
from taylor_verify.parallel import Failed, available_cores, fault, on_all_cores
from taylor_verify.unfinished import Unfinished, unfinished

if TYPE_CHECKING:
    from taylor_verify.judge.judgement import Judgement

Finished = Callable[[Job], None]

# What a run takes, in that of one state in closed form: Taylor series as many times as much, and so many
# radians as much as one more.
_TAYLOR = 10
_RADIANS_PER_STATE = 1e5


class Interrupted(KeyboardInterrupt):
    """An interrupt of a run of which ``finished`` of ``jobs`` jobs are kept, to go on from there."""

    def __init__(self, finished: int, jobs: int) -> None:
        super().__init__()
        self.finished, self.jobs = finished, jobs


def run_all(
    asked: Sequence[Job],
    finished: Finished,
    workers: int | None = None,
    resume: bool = False,
    out: Path | None = None,
) -> list[Judgement]:
    """Every job's judgements, rung by rung; ``finished`` is told of each job as it ends.

    Of several jobs each is kept as it ends, until all have, in a folder of this run into ``out``. What
    the same run had finished before an interrupt is not run again if ``resume`` is asked for. An
    interrupt is raised as Interrupted.

    One job runs in this process, several in as many as there are cores: heyoka's compiled
    integrators and the truth's big integers both hold the interpreter. Raises Failed for a job that
    broke, or lost its process; whatever ends this early, an interrupt too, ends the workers first.
    """
    if len(asked) == 1:
        (job,) = asked
        found = _run(job)
        finished(job)
        return found
    ended: list[Job] = []

    def ends(job: Job) -> None:
        ended.append(job)
        finished(job)

    workers = min(workers or available_cores(), len(asked))
    with unfinished(asked, out, resume) as store:
        try:
            work = partial(_run_or_recall, store)
            results = on_all_cores(work, asked, _expense, ends, workers)
        except KeyboardInterrupt as interrupt:
            raise Interrupted(len(ended) if store else 0, len(asked)) from interrupt
        if store:
            store.forget()
    return [judgement for result in results for judgement in result]


def _run_or_recall(store: Unfinished | None, job: Job) -> list[Judgement]:
    """Run a job of several, unless it is in the store, and store it as soon as it is finished."""
    found = store.recall(job) if store else None
    if found is None:
        found = _run(job)
        if store:
            store.keep(job, found)
    return found


def _run(job: Job) -> list[Judgement]:
    from taylor_verify.run import run
    from taylor_verify.scenes.faults import Refused
    from taylor_verify.scenes.reader import load

    found, place = [], job.scene
    try:
        scene = load(job.scene)
        for rung in job.rungs:
            place = f"{job.scene} on {rung}"
            found.append(run(scene, job.solver, rung))
    except Exception as error:
        # Only text is sure to pass from process to process.
        reason = str(error) if isinstance(error, Refused) else fault(error)
        raise Failed(f"{place}: {reason}") from error
    return found


def _expense(job: Job) -> float:
    """The longest first, so that no core is left with one at the end.

    What is tracked tells, and whether the truth, or the flow between two samples of a loaded body, is
    a closed form or Taylor series, which are many times as dear; of long runs the radians. The scene is
    read again for it, which costs a millisecond.
    """
    from taylor_verify.scenes.bodies import RigidBody
    from taylor_verify.scenes.motion import Spin
    from taylor_verify.scenes.reader import load

    scene = load(job.scene)
    body, start = scene.body, scene.initial
    has_closed_form = body.is_free and (isinstance(body, RigidBody) or body.axis_of_symmetry)
    states = {"euler": 3, "kirchhoff": 6}[scene.model] * (1 + 3 * len(scene.track))
    spin = max(map(abs, start.omega)) if isinstance(start, Spin) else 0
    radians = float(spin * abs(scene.clock.elapsed[-1]))
    return -states * (1 if has_closed_form else _TAYLOR) - radians / _RADIANS_PER_STATE
