"""An executor of somebody else, which begins with the last call."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Executor, Future
from typing import Any


class Backwards(Executor):
    """An executor of somebody's own: it waits until ``count`` are submitted and begins with the last."""

    def __init__(self, count: int) -> None:
        self.count = count
        self.calls: list[tuple[Future[Any], Callable[[], Any]]] = []

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        self.calls.append((future, lambda: fn(*args, **kwargs)))
        if len(self.calls) == self.count:
            threading.Thread(target=self._run).start()
        return future

    def _run(self) -> None:
        for future, call in reversed(self.calls):
            if future.set_running_or_notify_cancel():
                try:
                    future.set_result(call())
                except BaseException as error:
                    future.set_exception(error)
