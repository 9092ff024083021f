"""Ctrl-C at the command line: the first one is heard, and what it ends is not disturbed by a second."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import NoReturn


@contextmanager
def heard_once(to_the_end: bool) -> Iterator[None]:
    """Raise KeyboardInterrupt for the first Ctrl-C within the block, and for none that follows.

    With ``to_the_end`` the process ends with the block, and hears none after it either. A program that
    hears interrupts in a way of its own goes on to do so.
    """
    is_main = threading.current_thread() is threading.main_thread()
    if not is_main or signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        yield
        return
    signal.signal(signal.SIGINT, _hear)
    try:
        yield
    finally:
        if not to_the_end:
            signal.signal(signal.SIGINT, signal.default_int_handler)


def _hear(number: int, frame: FrameType | None) -> NoReturn:
    del number, frame
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    raise KeyboardInterrupt
