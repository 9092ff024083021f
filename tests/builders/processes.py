"""Processes of tests, and programs of other people: interrupts, waiting, imports."""

from __future__ import annotations

import ast
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

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
