"""The same work for many, on all cores: results in the order asked for, one clear end for all of it."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
import traceback
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeVar

if TYPE_CHECKING:
    from taylor_verify.scenes.scene import Scene

Asked = TypeVar("Asked")
Result = TypeVar("Result")


NO_MEMORY: Final = (
    "expected more memory, got none left (raise the limit of the process, or ask for less: fewer samples, "
    "fewer digits)"
)


class Failed(RuntimeError):  # noqa: N818 (it names what happened to the run)
    """A run that came to no judgement, by no fault of its scene; the text says which and why."""


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
    from taylor_verify.exact.solution import Unsettled
    from taylor_verify.scenes.reader import load

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
    """One line for an error that nobody foresaw: what it is, and where in this package it rose.

    Memory that runs out is the machine's or the question's, and a library that does not load is the
    machine's: neither is called a fault of this package.
    """
    if isinstance(error, MemoryError):
        return NO_MEMORY
    if isinstance(error, ImportError):
        return f"expected a library to load (installed whole, with memory for it), got {error}"
    package = Path(__file__).parent
    frames = [
        f"{Path(frame.filename).relative_to(package)}:{frame.lineno}"
        for frame in traceback.extract_tb(error.__traceback__)
        if Path(frame.filename).is_relative_to(package)
    ]
    place = f" @ {frames[-1]}" if frames else ""
    return f"{type(error).__name__}: {error}{place} (a fault of taylor-verify: please report it)"


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
