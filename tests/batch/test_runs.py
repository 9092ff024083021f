"""Many pieces of work on any executor: the order asked for, one end for all, one thread at a time."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from concurrent.futures import (
    BrokenExecutor,
    Executor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
)
from multiprocessing import get_context
from typing import Any

import pytest
from builders.executor import Backwards
from builders.processes import PATIENCE

from taylor_verify.batch.failure import Failed
from taylor_verify.batch.work import run_all


def square(number: int) -> int:
    return number * number


ASKED = [3, 1, 4, 1, 5]
EXECUTORS: dict[str, Callable[[], Executor]] = {
    "threads": lambda: ThreadPoolExecutor(3),
    "processes": lambda: ProcessPoolExecutor(2, get_context("spawn")),
    "backwards": lambda: Backwards(len(ASKED)),
}


@pytest.mark.parametrize("make", EXECUTORS.values(), ids=EXECUTORS)
def test_any_executor_gives_the_order_asked_for(make: Callable[[], Executor]) -> None:
    """Equal pieces too are each answered and each told of, and the executor is left open."""
    ended: list[tuple[int, int]] = []
    executor = make()
    results = run_all(
        square, ASKED, executor, ended=lambda one, result: ended.append((one, result))
    )
    assert results == [9, 1, 16, 1, 25]
    assert sorted(ended) == sorted(zip(ASKED, results, strict=True))
    if not isinstance(executor, Backwards):
        assert executor.submit(square, 7).result() == 49
        executor.shutdown()


def test_the_dearest_begins_first() -> None:
    """Work is submitted by expense, and the results keep their order."""
    started: list[int] = []
    with ThreadPoolExecutor(1) as executor:

        def work(one: int) -> int:
            started.append(one)
            return one

        assert run_all(work, ASKED, executor, expense=lambda one: -one) == ASKED
    assert started == sorted(ASKED, reverse=True)


def test_threads_of_one_process_take_turns() -> None:
    """mpmath and FLINT have one precision for a process: two runs at once would compute wrong numbers."""
    inside = 0
    most = 0

    def work(one: int) -> int:
        nonlocal inside, most
        inside += 1
        most = max(most, inside)
        time.sleep(0.01)
        inside -= 1
        return one

    with ThreadPoolExecutor(4) as one, ThreadPoolExecutor(4) as other:
        callers = [
            threading.Thread(target=run_all, args=(work, range(8), executor))
            for executor in (one, other)
        ]
        for caller in callers:
            caller.start()
        for caller in callers:
            caller.join()
    assert most == 1


@pytest.mark.parametrize("error", [ValueError("broken"), KeyboardInterrupt()])
@pytest.mark.parametrize("of_work", [True, False], ids=["in the work", "in this thread"])
def test_an_error_or_an_interrupt_cancels_what_has_not_begun(
    error: BaseException, of_work: bool
) -> None:
    """It is raised as it is, from the work or from the caller's own function."""
    started: list[int] = []
    first_has_ended = threading.Event()

    def work(one: int) -> int:
        started.append(one)
        if one:
            first_has_ended.wait(PATIENCE)
        elif of_work:
            raise error
        return one

    def ended(one: int, _: object) -> None:
        if not of_work:
            raise error

    with ThreadPoolExecutor(1) as executor:
        with pytest.raises(type(error)):
            run_all(work, range(50), executor, ended=ended)
        first_has_ended.set()
    # The second may have begun meanwhile.
    assert started in ([0], [0, 1])


class Losing(Executor):
    """An executor that loses each piece of work in one way."""

    def __init__(self, lose: Callable[[Future[Any]], Any]) -> None:
        self.lose = lose

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        self.lose(future)
        return future


def cancelled(future: Future[Any]) -> None:
    """Somebody else has shut the executor down."""
    future.cancel()
    future.set_running_or_notify_cancel()


def refused(future: Future[Any]) -> None:
    raise OSError(111, "connection refused")


REFUSED = r"3: .* an error of the executor: ConnectionRefusedError: .*refused"


@pytest.mark.parametrize(
    ("lose", "text"),
    [
        (lambda future: future.set_exception(BrokenExecutor("a process has gone")), "3: a process"),
        (cancelled, "3: expected a result, got .*cancelled"),
        (refused, REFUSED),
        (lambda future: future.set_exception(OSError(111, "connection refused")), REFUSED),
    ],
)
def test_an_executor_that_breaks_names_the_work(lose: Any, text: str) -> None:
    """Work raises Failed alone: another error is the executor's, and is told as Failed of its piece."""
    with pytest.raises(Failed, match=text):
        run_all(square, [3], Losing(lose), raises=Failed)
