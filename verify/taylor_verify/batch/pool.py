"""An executor of worker processes on this machine that can be ended at once, at any moment.

A thread waits for each process, on a pipe of their own. A process that is lost, or ended in the middle of
a result, is the end of its pipe and blocks nobody, and its work alone is lost. The executors of
`concurrent.futures` and loky have one pipe for all: a lost process fails all work, without a word on which
was its own. Their workers print tracebacks if Ctrl-C comes while they start, and go on with their work when
their parent is killed.
"""

from __future__ import annotations

import multiprocessing
import os
import pickle
import signal
import sys
import threading
import traceback
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from importlib import import_module
from multiprocessing import resource_tracker, spawn
from multiprocessing.connection import Connection
from multiprocessing.context import SpawnContext
from queue import SimpleQueue
from types import FrameType, ModuleType
from typing import Any, Final, TypeVar

from taylor_verify.batch.pickling import dumps, needs_script

Result = TypeVar("Result")
# A function and its arguments.
Task = tuple[Callable[..., Any], tuple[Any, ...], dict[str, Any]]

# Each worker has one core: a library of linear algebra that reads these starts no threads for the others.
_ONE_THREAD: Final = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
# Set in a worker.
_is_worker: Final = threading.Event()
# Seconds that a worker has to end before it is killed.
_GRACE: Final = 2.0


class WorkerLost(RuntimeError):  # noqa: N818 (it names what happened to the process)
    """A worker process ended before its work did; the text says how."""


class LocalPool(Executor):
    """A `concurrent.futures.Executor` of spawned processes.

    Processes are spawned and not forked: heyoka's threads and locks do not survive a fork. They ignore
    Ctrl-C, which is their parent's affair, and end when the parent does, however that ends. Submitted
    functions, arguments and results are pickled. A future raises WorkerLost if its process was lost; the
    worker's place is then empty, and work that comes to it raises WorkerLost too.
    """

    def __init__(self, workers: int) -> None:
        if _is_worker.is_set():
            expected = 'the call under `if __name__ == "__main__":`'
            reason = "the script has a function that each process imports it for (or install cloudpickle)"
            raise WorkerLost(f"expected {expected}, got it at the top of the script: {reason}")
        context = multiprocessing.get_context("spawn")
        self._threads = ThreadPoolExecutor(workers, "taylor-verify-worker")
        self._workers: list[_Worker] = []
        self._idle: SimpleQueue[_Worker] = SimpleQueue()
        try:
            with _interrupts_blocked():
                for _ in range(workers):
                    self._workers.append(_Worker(context))
                    self._idle.put(self._workers[-1])
        except BaseException:
            self.terminate()
            raise

    def submit(self, fn: Callable[..., Result], /, *args: Any, **kwargs: Any) -> Future[Result]:
        """Schedule ``fn(*args, **kwargs)`` in a worker process and return its future."""
        return self._threads.submit(self._call, (fn, args, kwargs))

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """End the workers after their work; with ``cancel_futures`` after the work that has begun."""
        self._threads.shutdown(wait, cancel_futures=cancel_futures)
        if wait:
            for worker in self._workers:
                worker.close()

    def terminate(self) -> None:
        """End the workers at once, in the middle of whatever they do; return when they have ended."""
        # A second interrupt does not end the end of the workers, which takes some seconds at most.
        with _interrupts_handled(signal.SIG_IGN):
            self._threads.shutdown(wait=False, cancel_futures=True)
            for worker in self._workers:
                worker.process.terminate()
            for worker in self._workers:
                worker.exit_status()
            self.shutdown()

    def _call(self, task: Task) -> Any:
        worker = self._idle.get()
        try:
            return worker.call(task)
        finally:
            self._idle.put(worker)


class _Worker:
    """A worker process and this side of its pipe."""

    def __init__(self, context: SpawnContext) -> None:
        self._pipe, theirs = context.Pipe()
        self._waiting = threading.Lock()
        self.process = context.Process(target=_serve, args=(theirs,))
        with _script_hidden():
            self.process.start()
        # Theirs alone now: when the process ends, the pipe does.
        theirs.close()

    def call(self, task: Task) -> Any:
        content = dumps(task)
        request = pickle.dumps((_script() if needs_script(content) else {}, content))
        try:
            self._pipe.send_bytes(request)
            answer = self._pipe.recv_bytes()
        except (EOFError, OSError):
            raise WorkerLost(_ending(self.exit_status())) from None
        value, error = pickle.loads(answer)
        if error is not None:
            raise error
        return value

    def close(self) -> None:
        self._pipe.close()
        self.exit_status()

    def exit_status(self) -> int | None:
        """Wait for the end of the process, kill it if it does not come, and return its status."""
        # Two threads that wait for one process at once may both miss its status.
        with self._waiting:
            self.process.join(_GRACE)
            if self.process.is_alive():
                self.process.kill()
                self.process.join()
            return self.process.exitcode


def _ending(status: int | None) -> str:
    """Return a sentence on how a process ended: by a signal, or with a status of its own."""
    if status is not None and status < 0:
        return f"a worker process was ended by signal {-status} (short of memory?)"
    return f"a worker process ended early, with status {status}"


def available_cores() -> int:
    """Return the number of cores that this process may use; a container may have fewer than the machine."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


# In the worker.


def _serve(pipe: Connection) -> None:
    """Run the tasks that come through the pipe, until it is closed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _is_worker.set()
    threading.Thread(target=_end_with_parent, daemon=True).start()
    _load_numpy_with_one_thread()
    with suppress(EOFError, OSError):
        while True:
            pipe.send_bytes(_answer(pipe.recv_bytes()))


def _load_numpy_with_one_thread() -> None:
    """Import numpy so that its library starts no threads; the environment stays as it was for programs."""
    added = [name for name in _ONE_THREAD if name not in os.environ]
    os.environ.update(dict.fromkeys(added, "1"))
    import_module("numpy")
    for name in added:
        del os.environ[name]


def _answer(request: bytes) -> bytes:
    """Run a task; return the pickled pair of its value and its error."""
    try:
        script, task = pickle.loads(request)
        if script:
            spawn.prepare(script)
        function, args, kwargs = pickle.loads(task)
        return pickle.dumps((function(*args, **kwargs), None))
    except BaseException as error:
        error.add_note(f"in a worker process:\n{traceback.format_exc()}")
        return _failure(error)


def _failure(error: BaseException) -> bytes:
    """Return the pickled error, or its text where it cannot be pickled or read back."""
    try:
        failure = pickle.dumps((None, error))
        pickle.loads(failure)
        return failure
    except Exception:
        return pickle.dumps((None, RuntimeError(f"{type(error).__name__}: {error}")))


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def _script() -> dict[str, Any]:
    """Return what a process needs to import the script of this one, as multiprocessing has it."""
    data = spawn.get_preparation_data("")
    return {key: value for key, value in data.items() if key.startswith("init_main")}


@contextmanager
def _script_hidden() -> Iterator[None]:
    """Keep the script of this process from a new one, which would run it for nothing."""
    script = sys.modules["__main__"]
    sys.modules["__main__"] = ModuleType("__main__")
    try:
        yield
    finally:
        sys.modules["__main__"] = script


@contextmanager
def _interrupts_handled(handler: Any) -> Iterator[None]:
    """Handle interrupts so within the block, in the main thread; a handler that is not Python's stays."""
    before = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or before is None:
        yield
        return
    signal.signal(signal.SIGINT, handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


@contextmanager
def _interrupts_blocked() -> Iterator[None]:
    """Keep an interrupt waiting until the workers are started.

    They inherit the mask, and so are deaf from their first instruction, before `_serve`. A thread of a
    library has no mask: an interrupt that it takes is noted, and heard at the end.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    # The first worker would start it, and that lifts the mask in Python 3.13.0 and before.
    resource_tracker.ensure_running()
    noted: list[tuple[int, FrameType | None]] = []
    handler = signal.getsignal(signal.SIGINT)
    try:
        with _interrupts_handled(lambda number, frame: noted.append((number, frame))):
            before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
            try:
                yield
            finally:
                signal.pthread_sigmask(signal.SIG_SETMASK, before)
    finally:
        if noted and callable(handler):
            handler(*noted[0])
