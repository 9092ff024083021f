"""A sign of life on stderr for whatever takes longer than a second."""

from __future__ import annotations

import logging
import sys
import threading
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import monotonic
from typing import TYPE_CHECKING, Final, NamedTuple

from taylor_verify.cli.streams import say
from taylor_verify.scenes.names import escaped

if TYPE_CHECKING:
    from taylor_verify.batch.job import Job
    from taylor_verify.batch.judging import Progress

# Work that takes less than this, in seconds, shows no progress.
_PATIENCE = 1.0
# The length of a bar, in characters.
_BAR: Final = 30
# Every room reports the progress of long work to this logger.
PROGRESS: Final = logging.getLogger("taylor_verify.progress")


@contextmanager
def advancing() -> Iterator[Progress]:
    """Show a bar that advances as jobs end; a line for each where stderr is no terminal."""
    if not sys.stderr.isatty():
        yield _say_progress
        return
    from rich import progress as bars

    from taylor_verify.cli.console import EscapingConsole

    columns = (
        bars.TextColumn("{task.description}", markup=False),
        bars.BarColumn(),
        bars.MofNCompleteColumn(),
        bars.TimeElapsedColumn(),
    )
    with bars.Progress(*columns, console=EscapingConsole(stderr=True), transient=True) as bar:
        task = bar.add_task("compiling and solving")

        def advance(finished: int, total: int, job: Job | None) -> None:
            name = None if job is None else escaped(job.name)
            bar.update(task, completed=finished, total=total, description=name)

        yield advance


def _say_progress(finished: int, total: int, job: Job | None) -> None:
    if job is not None:
        say(f"{finished}/{total} {job}")


@contextmanager
def working(what: str) -> Iterator[None]:
    """Show a spinner with the latest news while one long thing is computed, and a bar of its share.

    Where stderr is no terminal, lines with the news, each after twice the time of the one before.
    """
    with _news() as latest:
        if sys.stderr.isatty():
            from rich.console import Console
            from rich.text import Text

            def text() -> Text:
                news = latest()
                return Text(escaped(f"{what}: {news.bar}{news.words}"))

            with (
                Console(stderr=True).status(text()) as spinner,
                _repeated(lambda: _PATIENCE, lambda: spinner.update(text())),
            ):
                yield
            return
        began = monotonic()
        with _repeated(
            lambda: max(_PATIENCE, monotonic() - began), lambda: say(f"{what}: {latest().words}")
        ):
            yield


class _News(NamedTuple):
    """Present work, and the share of it that is done, from 0 to 1, where that is known."""

    words: str
    share: float | None = None

    @property
    def bar(self) -> str:
        if self.share is None:
            return ""
        done = round(_BAR * self.share)
        return f"[{'#' * done}{'.' * (_BAR - done)}] "


@contextmanager
def _news() -> Iterator[Callable[[], _News]]:
    """Yield a function that returns the latest message of whatever room computes.

    A message says how much is done by an attribute ``share`` of its record.
    """
    messages = deque([_News("computing")], maxlen=1)

    class Latest(logging.Handler):
        def emit(self, record: logging.LogRecord) -> None:
            messages.append(_News(record.getMessage(), getattr(record, "share", None)))

    handler = Latest(logging.INFO)
    level = PROGRESS.level
    PROGRESS.addHandler(handler)
    PROGRESS.setLevel(logging.INFO)
    try:
        yield lambda: messages[-1]
    finally:
        PROGRESS.removeHandler(handler)
        PROGRESS.setLevel(level)


@contextmanager
def _repeated(wait: Callable[[], float], tell: Callable[[], None]) -> Iterator[None]:
    """Call ``tell`` again and again, after ``wait()`` seconds each time, until the block ends."""
    ended = threading.Event()

    def repeat() -> None:
        while not ended.wait(wait()):
            tell()

    thread = threading.Thread(target=repeat, daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()
