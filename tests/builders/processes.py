"""Processes of tests, programs of other people, and an executor of somebody else."""

from __future__ import annotations

import ast
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

# Seconds after which a test gives up; only a fault takes so long, however busy the machine is.
PATIENCE: Final = 120.0


@contextmanager
def interruptible() -> Iterator[None]:
    """Let this process and those that it starts hear an interrupt.

    Whoever runs the tests in the background, or some runners, ignore it, and a child inherits that.
    """
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


@contextmanager
def on_one_core() -> Iterator[None]:
    """Let this process and those that it starts use one core: a run then starts no others."""
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(before)})
    try:
        yield
    finally:
        os.sched_setaffinity(0, before)


def printed_by(script: str, *arguments: str, **environment: str) -> str:
    """What this Python prints, in a process of its own that runs the script without an error."""
    done = subprocess.run(
        [sys.executable, "-c", script, *arguments],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path)), **environment},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def wait_until(condition: Callable[[], object], seconds: float = PATIENCE) -> None:
    """Wait until a condition holds; an error if that takes longer."""
    deadline = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > deadline:
            raise TimeoutError(f"expected the condition to hold within {seconds:g} seconds")
        time.sleep(0.01)


# Programs


def imported_tops(source: str) -> set[str]:
    """The top names of all modules that a source imports."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names.add(node.module or "")
    return {name.partition(".")[0] for name in names}


def is_alive(pid: int | str) -> bool:
    """Return True for a process that runs; one that has ended and waits for its parent does not."""
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except (FileNotFoundError, ProcessLookupError):
        return False
    return state not in {"Z", "X"}


# An executor


class Backwards(Executor):
    """An executor of somebody's own: it waits until ``count`` are submitted and begins with the last."""

    def __init__(self, count: int) -> None:
        self.count = count
        self.calls: list[tuple[Future[Any], Callable[[], Any]]] = []

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        self.calls.append((future, lambda: fn(*args, **kwargs)))
        if len(self.calls) == self.count:
            threading.Thread(target=self._run).start()
        return future

    def _run(self) -> None:
        for future, call in reversed(self.calls):
            if future.set_running_or_notify_cancel():
                try:
                    future.set_result(call())
                except BaseException as error:
                    future.set_exception(error)
