"""Two threads that ask for the same at the same moment."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path


def both(make: Callable[[], Path], seconds: float) -> list[Path]:
    """Return what each of two threads has made, of those that ended within the time."""
    made: list[Path] = []
    start = threading.Barrier(2)

    def one() -> None:
        start.wait()
        made.append(make())

    threads = [threading.Thread(target=one) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(seconds)
    return made
