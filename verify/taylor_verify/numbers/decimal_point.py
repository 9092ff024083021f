"""Numbers in text with a point, whatever the locale of the process.

heyoka writes constants of four times a double's digits as text, through libraries that take the decimal
mark of the locale. With a comma its import ends the process, and its compiled code computes something else.
"""

from __future__ import annotations

import locale
from collections.abc import Iterator
from contextlib import contextmanager
from threading import RLock

_lock = RLock()
# The locale of numbers before the first block that is under way, and the number of such blocks.
_before, _blocks = "C", 0


@contextmanager
def decimal_point() -> Iterator[None]:
    """Have all threads write numbers in the C locale within the block, and as before after the last."""
    _begin()
    try:
        yield
    finally:
        _end()


def _begin() -> None:
    global _before, _blocks
    with _lock:
        if not _blocks:
            _before = locale.setlocale(locale.LC_NUMERIC)
        _blocks += 1
        # In every block: somebody may have set another one since.
        locale.setlocale(locale.LC_NUMERIC, "C")


def _end() -> None:
    global _blocks
    with _lock:
        _blocks -= 1
        if not _blocks:
            locale.setlocale(locale.LC_NUMERIC, _before)
