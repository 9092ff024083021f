"""A sign of life on stderr for whatever takes longer than a second."""

from __future__ import annotations

import logging
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from time import monotonic
from typing import TYPE_CHECKING, Final

from taylor_verify.cli.streams import MANNER, say
from taylor_verify.records.escapes import one_line

if TYPE_CHECKING:
    from taylor_verify.batch.job import Job
    from taylor_verify.batch.judging import Progress

# Work that takes less than this, in seconds, shows no progress.
_PATIENCE = 1.0
# Every room reports the progress of long work to this logger. A message says how much is done, from 0 to 1,
# by an attribute ``share`` of its record.
PROGRESS: Final = logging.getLogger("taylor_verify.progress")


@contextmanager
def advancing() -> Iterator[Progress]:
    """Show a bar that advances as jobs end; a line for each where stderr is no terminal."""
    has_bar = sys.stderr.isatty() and not MANNER.quiet

    def show(finished: int, total: int, job: Job | None) -> None:
        if job is not None and has_bar:
            PROGRESS.info(f"{finished}/{total} {job.name}", extra={"share": finished / total})
        elif job is not None:
            say(f"{finished}/{total} {job}")

    with _bar("compiling and solving") if has_bar else nullcontext():
        yield show


@contextmanager
def working(what: str) -> Iterator[None]:
    """Show the latest news while one long thing is computed, and a bar of its share.

    Where stderr is no terminal, lines with the news, each after twice the time of the one before.
    """
    with _bar(what) if sys.stderr.isatty() and not MANNER.quiet else _lines(what):
        yield


@contextmanager
def _bar(what: str) -> Iterator[None]:
    """Show a line on a terminal: what is done, the latest news, a bar and the time so far."""
    from rich import progress as bars

    from taylor_verify.cli.console import EscapingConsole

    columns = (
        bars.SpinnerColumn(),
        bars.TextColumn("{task.description}", markup=False),
        bars.BarColumn(),
        bars.TimeElapsedColumn(),
    )
    with bars.Progress(*columns, console=EscapingConsole(stderr=True), transient=True) as bar:
        # Without a total the bar moves to and fro.
        task = bar.add_task(f"{one_line(what)}: computing", total=None)

        def show(news: str, share: float | None) -> None:
            total = None if share is None else 1.0
            description = one_line(f"{what}: {news}")
            bar.update(task, description=description, total=total, completed=share or 0.0)

        with _hearing(show):
            yield


@contextmanager
def _lines(what: str) -> Iterator[None]:
    """Print a line with the latest news again and again, each after twice the time of the one before."""
    latest = "computing"
    began, ended = monotonic(), threading.Event()

    def hear(news: str, _: float | None) -> None:
        nonlocal latest
        latest = news

    def repeat() -> None:
        while not ended.wait(max(_PATIENCE, monotonic() - began)):
            say(f"{what}: {latest}")

    # A thread, because most code computes for long without any news.
    thread = threading.Thread(target=repeat, daemon=True)
    thread.start()
    try:
        with _hearing(hear):
            yield
    finally:
        ended.set()
        thread.join()


@contextmanager
def _hearing(hear: Callable[[str, float | None], None]) -> Iterator[None]:
    """Call ``hear`` with the words and the share of each message about long work."""

    class Hearing(logging.Handler):
        def emit(self, record: logging.LogRecord) -> None:
            hear(record.getMessage(), getattr(record, "share", None))

    handler, level = Hearing(logging.INFO), PROGRESS.level
    PROGRESS.addHandler(handler)
    PROGRESS.setLevel(logging.INFO)
    try:
        yield
    finally:
        PROGRESS.removeHandler(handler)
        PROGRESS.setLevel(level)
