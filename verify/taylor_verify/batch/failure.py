"""A run that broke: the error, and a line with the reason."""

from __future__ import annotations

import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

NO_MEMORY: Final = (
    "expected more memory, got none left (raise the limit of the process, or ask for less: fewer samples, "
    "fewer digits)"
)
_PACKAGE: Final = Path(__file__).parents[1]


class Failed(RuntimeError):  # noqa: N818 (it names what happened to the run)
    """A run that came to no judgement, by no fault of its scene; the text says which and why."""


@contextmanager
def failing(place: str, *foreseen: type[Exception]) -> Iterator[None]:
    """Raise Failed with the place for an error, in its own words if it was foreseen.

    Only text is sure to pass from process to process.
    """
    try:
        yield
    except Exception as error:
        reason = str(error) if isinstance(error, foreseen) else fault(error)
        raise Failed(f"{place}: {reason}") from error


def fault(error: BaseException) -> str:
    """Return one line for an unforeseen error: its kind, and where in this package it was raised.

    Memory that runs out is the machine's or the question's, and a library that does not load is the
    machine's: neither is called a fault of this package.
    """
    if isinstance(error, MemoryError):
        return NO_MEMORY
    if isinstance(error, ImportError):
        return f"expected a library to load (installed whole, with memory for it), got {error}"
    frames = [
        f"{Path(frame.filename).relative_to(_PACKAGE)}:{frame.lineno}"
        for frame in traceback.extract_tb(error.__traceback__)
        if Path(frame.filename).is_relative_to(_PACKAGE)
    ]
    place = f" @ {frames[-1]}" if frames else ""
    return f"{type(error).__name__}: {error}{place} (a fault of taylor-verify: please report it)"
