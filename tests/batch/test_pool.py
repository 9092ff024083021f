"""The local executor: spawned processes that end at once, and whose loss is told in a sentence."""

from __future__ import annotations

import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from builders.processes import PATIENCE

from taylor_verify.batch.pool import LocalPool, WorkerLost, _interrupts_blocked


class TwoParts(Exception):
    """An error that cannot be read back from its pickle."""

    def __init__(self, first: str, second: str) -> None:
        super().__init__(f"{first} {second}")


def refuse(kind: str) -> None:
    if kind == "two parts":
        raise TwoParts("one", "two")
    raise ValueError("expected a number, got none")


def unpicklable() -> Any:
    return lambda: None


def environment() -> dict[str, str]:
    return dict(os.environ)


def threads() -> int:
    import numpy as np

    np.ones((300, 300)) @ np.ones((300, 300))
    return len(os.listdir("/proc/self/task"))


def end(number: int) -> None:
    os.kill(os.getpid(), number)


def leave(status: int) -> None:
    os._exit(status)


def long_result(size: int) -> bytes:
    return bytes(size)


@pytest.fixture(scope="module")
def pool() -> Iterator[LocalPool]:
    """A pool for the tests that leave it whole."""
    with LocalPool(2) as pool:
        yield pool


def test_an_error_of_the_work_is_raised_as_it_was(pool: LocalPool) -> None:
    """Its type, its text, and the place in the worker; the worker goes on."""
    error = pool.submit(refuse, "a number").exception()
    assert isinstance(error, ValueError)
    assert str(error) == "expected a number, got none"
    assert "in refuse" in error.__notes__[0]
    assert pool.submit(len, "abc").result() == 3


@pytest.mark.parametrize(
    ("work", "argument", "text"),
    [(refuse, ("two parts",), "TwoParts: one two"), (unpicklable, (), "lambda")],
)
def test_what_cannot_be_pickled_is_an_error_with_a_text(
    pool: LocalPool, work: Any, argument: tuple[str, ...], text: str
) -> None:
    """A result or an error that cannot come back neither loses the process nor hangs."""
    error = pool.submit(work, *argument).exception(timeout=PATIENCE)
    assert text in str(error)
    assert pool.submit(len, "abc").result() == 3


# A process of its own: in this one multiprocessing may have started its helper long ago.
_MASKS = """
import signal
from taylor_verify.batch.pool import LocalPool


def blocks_interrupts():
    return signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, [])


if __name__ == "__main__":
    with LocalPool(2) as pool:
        print(*(pool.submit(blocks_interrupts).result() for _ in range(2)), blocks_interrupts())
"""


@pytest.mark.skipif(not hasattr(signal, "pthread_sigmask"), reason="needs masks of signals")
def test_a_worker_is_deaf_to_interrupts_from_its_start(tmp_path: Path) -> None:
    """Workers inherit a mask of interrupts, which their parent has no more when they are started."""
    script = tmp_path / "masks.py"
    script.write_text(_MASKS)
    done = subprocess.run(
        [sys.executable, script], capture_output=True, text=True, timeout=PATIENCE
    )
    assert done.stdout.split() == ["True", "True", "False"], done.stderr


# A script without a main guard; its second call has a function that is written in it.
_BARE = """
import sys
from taylor_verify.batch import pickling
from taylor_verify.batch.pool import LocalPool

pickling._has_cloudpickle = lambda: sys.argv[1] == "cloudpickle"
print("begins")

def twice(number):
    return 2 * number

with LocalPool(1) as pool:
    print(pool.submit(len, "abc").result())
    print(pool.submit(twice, 3).exception() or pool.submit(twice, 3).result())
"""


@pytest.mark.parametrize(
    ("package", "answer"),
    [("cloudpickle", "6"), ("pickle", 'expected the call under `if __name__ == "__main__":`')],
)
def test_a_script_without_a_guard_works_or_is_told_in_one_sentence(
    package: str, answer: str, tmp_path: Path
) -> None:
    """No process runs the script again; only a function in it needs that, where cloudpickle is missing."""
    script = tmp_path / "bare.py"
    script.write_text(_BARE)
    command = [sys.executable, str(script), package]
    done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE)
    begins, three, *rest = done.stdout.splitlines()
    assert (begins, three) == ("begins", "3")
    assert rest[-1].startswith(answer)
    assert done.stderr == ""


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="needs Linux's list of threads")
def test_a_worker_computes_with_one_thread(monkeypatch: pytest.MonkeyPatch) -> None:
    """Beside it is the one that watches the parent; a solver's program inherits nothing of it."""
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        monkeypatch.delenv(name, raising=False)
    with LocalPool(1) as pool:
        assert pool.submit(threads).result() == 2
        assert not {name for name in pool.submit(environment).result() if "THREADS" in name}


@pytest.mark.parametrize(
    ("work", "argument", "text"),
    [
        (end, signal.SIGKILL, "a worker process was ended by signal 9 (short of memory?)"),
        (leave, 7, "a worker process ended early, with status 7"),
    ],
)
def test_a_lost_process_is_told_in_a_sentence(work: Any, argument: int, text: str) -> None:
    """Its own future has the reason; nobody waits for an answer that cannot come."""
    with LocalPool(1) as pool:
        for _ in range(2):
            error = pool.submit(work, argument).exception(timeout=PATIENCE)
            assert isinstance(error, WorkerLost)
            assert text in str(error)


def test_a_lost_process_costs_its_own_work_alone() -> None:
    """Another worker's result arrives; executors with one pipe for all would fail both."""
    with LocalPool(2) as pool:
        # Long enough for both to be under way.
        other = pool.submit(time.sleep, 1)
        lost = pool.submit(end, signal.SIGKILL)
        assert isinstance(lost.exception(timeout=PATIENCE), WorkerLost)
        assert other.result(timeout=PATIENCE) is None


def test_terminate_ends_workers_in_the_middle(tmp_path: Any) -> None:
    """Work, and a result half handed over, are cut off; what waits is cancelled; no process is left."""
    before = set(multiprocessing.active_children())
    pool = LocalPool(2)
    futures = [pool.submit(long_result, 400_000_000), pool.submit(time.sleep, 60)]
    waiting = [pool.submit(time.sleep, 60) for _ in range(3)]
    time.sleep(0.8)
    began = time.monotonic()
    pool.terminate()
    # Half the time of the work.
    assert time.monotonic() - began < 30
    assert isinstance(futures[1].exception(timeout=0), WorkerLost)
    assert all(future.cancelled() for future in waiting)
    assert set(multiprocessing.active_children()) <= before


def test_a_second_interrupt_does_not_end_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    """Ctrl-C while workers are ended leaves none of them, no traceback, and the handler as it was."""
    pool = LocalPool(1)
    worker = pool._workers[0]
    exit_status = worker.exit_status

    def interrupted() -> int | None:
        signal.raise_signal(signal.SIGINT)
        return exit_status()

    monkeypatch.setattr(worker, "exit_status", interrupted)
    before = signal.getsignal(signal.SIGINT)
    pool.terminate()
    assert not worker.process.is_alive()
    assert signal.getsignal(signal.SIGINT) is before


def test_an_interrupt_that_a_thread_takes_waits_for_the_start_of_the_workers() -> None:
    """A thread of a library has no mask of signals: the handler is called at the end all the same."""
    steps = []

    def take() -> None:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
        signal.raise_signal(signal.SIGINT)

    def start() -> None:
        with _interrupts_blocked():
            for thread in (threading.Thread(target=take) for _ in range(2)):
                thread.start()
                thread.join()
                steps.append(thread)

    # Whoever started this process in the background may have it ignored.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            start()
    finally:
        signal.signal(signal.SIGINT, before)
    assert len(steps) == 2


def test_shutdown_waits_for_the_work() -> None:
    """Leaving the `with` block ends the processes after what was submitted."""
    before = set(multiprocessing.active_children())
    with LocalPool(1) as pool:
        futures = [pool.submit(pow, 2, k) for k in range(5)]
    assert [future.result(timeout=0) for future in futures] == [1, 2, 4, 8, 16]
    assert set(multiprocessing.active_children()) <= before
