"""A sign of life on stderr for whatever takes longer than a second."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from verify.cli.streams import say

if TYPE_CHECKING:
    from verify.job import Job

# Nobody needs to be told that something takes less than this, in seconds.
_PATIENCE = 1.0


@contextmanager
def advancing(total: int) -> Iterator[Callable[[Job], None]]:
    """A bar that advances as jobs end; a line for each where stderr is no terminal."""
    if not sys.stderr.isatty():
        yield _counting(total)
        return
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn
    from rich.progress import TimeElapsedColumn as Elapsed

    from verify.cli.console import EscapingConsole

    columns = (TextColumn("{task.description}", markup=False), BarColumn(), MofNCompleteColumn())
    console = EscapingConsole(stderr=True)
    with Progress(*columns, Elapsed(), console=console, transient=True) as bar:
        task = bar.add_task("compiling and solving", total=total)

        def finished(job: Job) -> None:
            bar.update(task, advance=1, description=job.scene)

        yield finished


def _counting(total: int) -> Callable[[Job], None]:
    done = 0

    def finished(job: Job) -> None:
        nonlocal done
        done += 1
        say(f"{done}/{total} {job.scene} on {' '.join(job.rungs)}")

    return finished


@contextmanager
def working(what: str) -> Iterator[None]:
    """A spinner while one long thing is computed; one line where stderr is no terminal."""
    if sys.stderr.isatty():
        from rich.text import Text

        from verify.cli.console import EscapingConsole

        with EscapingConsole(stderr=True).status(Text(what)):
            yield
        return
    notice = threading.Timer(_PATIENCE, say, [f"{what}: computing"])
    notice.daemon = True
    notice.start()
    try:
        yield
    finally:
        notice.cancel()
