"""Ctrl-C and SIGTERM at the command line: the first is heard, and no second disturbs what it ends."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from types import FrameType
from typing import Final

# Who asks a process to end: a person, and a system that stops a job. Each with the handler of Python.
_ENDING: Final = {
    signal.SIGINT: signal.default_int_handler,
    signal.SIGTERM: signal.SIG_DFL,
}


@contextmanager
def heard_once(to_the_end: bool) -> Iterator[None]:
    """Raise KeyboardInterrupt for the first Ctrl-C or SIGTERM within the block, and for none that follows.

    With ``to_the_end`` the process ends with the block, and hears none after it either. A program that
    hears one of them in a way of its own goes on to do so.
    """
    is_main = threading.current_thread() is threading.main_thread()
    usual = {n: h for n, h in _ENDING.items() if is_main and signal.getsignal(n) is h}
    for number in usual:
        signal.signal(number, partial(_hear, os.getpid(), tuple(usual)))
    try:
        yield
    finally:
        if not to_the_end:
            for number, handler in usual.items():
                signal.signal(number, handler)


def _hear(process: int, numbers: tuple[int, ...], number: int, frame: FrameType | None) -> None:
    del frame
    if os.getpid() != process and number == signal.SIGTERM:
        # In a process that was forked: it holds nothing that is to be left in order.
        signal.signal(number, signal.SIG_DFL)
        os.kill(os.getpid(), number)
    for each in numbers:
        signal.signal(each, signal.SIG_IGN)
    raise KeyboardInterrupt
