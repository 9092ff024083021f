"""A limit of processor time for what is made beside; what takes longer is left out.

It is measured by a signal, which Python gives to its main thread alone: elsewhere there is no limit.
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable
from types import FrameType
from typing import TypeVar

Made = TypeVar("Made")


class _Spent(BaseException):
    """The time is over. No handler of errors on the way may take it for an error."""


class Patience:
    """A number of seconds of processor time, for all that is made with it together."""

    def __init__(self, seconds: float) -> None:
        self._left = seconds

    def made(self, make: Callable[[], Made], instead: Made) -> Made:
        """Return what is made; ``instead`` if the time is over before."""
        if self._left <= 0:
            return instead
        if not _has_timer():
            return make()
        earlier = signal.signal(signal.SIGPROF, _stop)
        try:
            signal.setitimer(signal.ITIMER_PROF, self._left)
            made = make()
            self._left, _ = signal.setitimer(signal.ITIMER_PROF, 0)
        except _Spent:
            self._left = 0
            return instead
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0)
            signal.signal(signal.SIGPROF, earlier)
        return made


def _has_timer() -> bool:
    """Return True if a timer may be set; a profiler has its own."""
    is_main = threading.current_thread() is threading.main_thread()
    return is_main and hasattr(signal, "setitimer") and signal.getitimer(signal.ITIMER_PROF)[0] == 0


def _stop(number: int, frame: FrameType | None) -> None:
    raise _Spent
