"""Many runs on all cores: scenes and rungs in, judgements out in the order they were asked for."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
import traceback
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from verify.unfinished import forget, keep, kept

if TYPE_CHECKING:
    from verify.judge.judgement import Judgement
    from verify.scenes.scene import Scene


# What a run takes, in that of one state in closed form: a recursion as many times as much, and so many
# radians as much as one more.
_RECURSION = 10
_RADIANS_PER_STATE = 1e5


class Failed(RuntimeError):  # noqa: N818 (it names what happened to the run)
    """A run that came to no judgement, by no fault of its scene; the text says which and why."""


@dataclass(frozen=True)
class Job:
    """One scene on several rungs by one solver: the rungs share the condition of the orbit."""

    scene: str
    solver: str
    rungs: tuple[str, ...]


class Interrupted(KeyboardInterrupt):
    """An interrupt of a run of which ``finished`` of ``jobs`` jobs are kept, to go on from there."""

    def __init__(self, finished: int, jobs: int) -> None:
        super().__init__()
        self.finished, self.jobs = finished, jobs


Finished = Callable[[Job], None]
Asked = TypeVar("Asked")
Result = TypeVar("Result")


def jobs(scenes: Iterable[str], solver: str, rungs: Sequence[str]) -> list[Job]:
    return [Job(scene, solver, tuple(rungs)) for scene in scenes]


def run_all(
    asked: Sequence[Job], finished: Finished, workers: int | None = None, resume: bool = False
) -> list[Judgement]:
    """Every job's judgements, rung by rung; ``finished`` is told of each job as it ends.

    What an interrupted run had finished is not run again if ``resume`` is asked for: of several jobs
    each is kept as it ends, until all have. An interrupt is raised as Interrupted.

    One job runs in this process, several in as many as there are cores: heyoka's compiled
    integrators and the truth's big integers both hold the interpreter. Raises Failed for a job that
    broke, or lost its process; whatever ends this early, an interrupt too, ends the workers first.
    """
    if len(asked) == 1:
        (job,) = asked
        found = _run(job)
        finished(job)
        return found
    if not resume:
        forget()
    ended: list[Job] = []

    def ends(job: Job) -> None:
        ended.append(job)
        finished(job)

    workers = min(workers or available_cores(), len(asked))
    try:
        results = on_all_cores(_run_or_recall, asked, _expense, ends, workers)
    except KeyboardInterrupt as interrupt:
        raise Interrupted(len(ended), len(asked)) from interrupt
    forget()
    return [judgement for result in results for judgement in result]


def on_all_cores(
    work: Callable[[Asked], Result],
    asked: Sequence[Asked],
    expense: Callable[[Asked], Any],
    finished: Callable[[Asked], None],
    workers: int,
) -> list[Result]:
    """The results of ``work`` in the order asked for, begun in the order of ``expense``.

    ``finished`` is told of each as it ends. Whatever ends this early, an interrupt too, ends the
    worker processes first; Failed is raised where one was lost.
    """
    # Not fork: heyoka's threads and locks do not survive it.
    context = multiprocessing.get_context("spawn")
    others = set(multiprocessing.active_children())
    with ProcessPoolExecutor(workers, context, initializer=_begin_worker) as pool:
        try:
            with _interrupts_held():
                futures = {one: pool.submit(work, one) for one in sorted(asked, key=expense)}
            by_future = {future: one for one, future in futures.items()}
            for future in as_completed(by_future):
                future.result()
                finished(by_future[future])
            return [futures[one].result() for one in asked]
        except BaseException as error:
            # Nobody waits for the rest, and the pool would.
            for worker in set(multiprocessing.active_children()) - others:
                worker.terminate()
            _hang_up(pool)
            if isinstance(error, BrokenProcessPool):
                raise Failed(
                    "a worker process was ended from outside (short of memory?)"
                ) from error
            raise


def documents(
    make: Callable[[Scene], dict[str, Any]],
    names: Sequence[str],
    expense: Callable[[str], Any],
    finished: Callable[[str], None],
) -> list[dict[str, Any]]:
    """What ``make`` says of many scenes, on all cores, in the order given.

    ``finished`` is told the name of each scene as it ends. Raises Failed for one that came to
    nothing.
    """
    workers = max(1, min(available_cores(), len(names)))
    return on_all_cores(partial(_document, make), names, expense, finished, workers)


def _document(make: Callable[[Scene], dict[str, Any]], name: str) -> dict[str, Any]:
    from verify.exact.solution import Unsettled
    from verify.scenes.reader import load

    try:
        return make(load(name))
    except Exception as error:
        # Only text is sure to pass from process to process.
        reason = str(error) if isinstance(error, Unsettled) else fault(error)
        raise Failed(f"{name}: {reason}") from error


def _hang_up(pool: ProcessPoolExecutor) -> None:
    """Let the pool see the end of its results, whose writers have been ended.

    One that was ended within a message leaves the pool waiting for the rest of it, for ever, as long
    as anybody could still write it: this process, too, holds that end of the pipe. There is no public way.
    """
    results = getattr(pool, "_result_queue", None)
    if results is not None:
        results._writer.close()


def available_cores() -> int:
    """The cores this process may use, which in a container are fewer than the machine has."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def fault(error: BaseException) -> str:
    """One line for an error that nobody foresaw: what it is, and where in this package it rose."""
    package = Path(__file__).parent
    frames = [
        f"{Path(frame.filename).relative_to(package)}:{frame.lineno}"
        for frame in traceback.extract_tb(error.__traceback__)
        if Path(frame.filename).is_relative_to(package)
    ]
    place = f" @ {frames[-1]}" if frames else ""
    return f"{type(error).__name__}: {error}{place} (a fault of taylor-verify: please report it)"


def _run_or_recall(job: Job) -> list[Judgement]:
    """One of several: kept as soon as it is finished, and not run again if it is kept."""
    found = kept(job)
    if found is None:
        found = _run(job)
        keep(job, found)
    return found


def _run(job: Job) -> list[Judgement]:
    from verify.run import run
    from verify.scenes.faults import Refused

    found = []
    for rung in job.rungs:
        try:
            found.append(run(job.scene, job.solver, rung))
        except Exception as error:
            # Only text is sure to pass from process to process.
            reason = str(error) if isinstance(error, Refused) else fault(error)
            raise Failed(f"{job.scene} on {rung}: {reason}") from error
    return found


def _expense(job: Job) -> float:
    """The longest first, so that no core is left with one at the end.

    What is tracked tells, and whether the truth, or the flow between two samples of a loaded body, is
    a closed form or a recursion, which is many times as dear; of long runs the radians. The scene is
    read again for it, which costs a millisecond.
    """
    from verify.scenes.bodies import RigidBody
    from verify.scenes.motion import Spin
    from verify.scenes.reader import load

    scene = load(job.scene)
    body, start = scene.body, scene.initial
    has_closed_form = body.is_free and (isinstance(body, RigidBody) or body.axis_of_symmetry)
    states = {"euler": 3, "kirchhoff": 6}[scene.model] * (1 + 3 * len(scene.track))
    spin = max(map(abs, start.omega)) if isinstance(start, Spin) else 0
    radians = float(spin * abs(scene.clock.elapsed[-1]))
    return -states * (1 if has_closed_form else _RECURSION) - radians / _RADIANS_PER_STATE


def _begin_worker() -> None:
    """A worker leaves an interrupt to its parent, and does not outlive it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


@contextmanager
def _interrupts_held() -> Iterator[None]:
    """Keep an interrupt until the workers are started.

    They inherit the mask, and so are deaf from their first instruction, before `_begin_worker`.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
