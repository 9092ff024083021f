"""Pieces of work on any executor: results in the order asked for, one clear end for all of them."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future, as_completed
from contextlib import ExitStack
from functools import partial
from typing import Any, Final, TypeVar

from taylor_verify.batch.failure import Failed
from taylor_verify.batch.pool import LocalPool, WorkerLost, available_cores

Asked = TypeVar("Asked")
Result = TypeVar("Result")

# mpmath and FLINT have one working precision for a whole process. Two threads that both set it compute
# wrong numbers, so that threads of one process take turns, whatever executor they belong to.
_ONE_AT_A_TIME: Final = threading.RLock()


def run_all(
    work: Callable[[Asked], Result],
    asked: Sequence[Asked],
    executor: Executor | None = None,
    *,
    workers: int | None = None,
    expense: Callable[[Asked], Any] | None = None,
    ended: Callable[[Asked, Result], None] | None = None,
    raises: type[Exception] = Exception,
) -> list[Result]:
    """Return ``work(one)`` for each one asked, in the order asked for.

    ``executor`` is any `concurrent.futures.Executor`; only its ``submit`` is called, and it is left
    open. Without one, ``workers`` processes of this machine are used (as many as cores, unless given), and
    whatever ends this early, an interrupt too, ends them first. Work begins in the order of
    ``expense``, and ``ended(one, result)`` is called in this thread as each ends. An error, or an
    interrupt, cancels what has not begun.

    Raises Failed where a process was lost, and whatever the work or ``ended`` raises. Work that ``raises``
    errors of one type alone has any other error told as Failed: the executor made it.
    """
    if not asked:
        return []
    places = sorted(range(len(asked)), key=lambda k: expense(asked[k]) if expense else k)
    futures: dict[Future[Result], int] = {}
    results: dict[int, Result] = {}
    with ExitStack() as stack:
        if executor is None:
            pool = LocalPool(min(workers or available_cores(), len(asked)))
            executor = stack.enter_context(pool)
            # Nobody waits for the rest of what ends early, and the pool would.
            stack.push(lambda kind, *_: pool.terminate() if kind else None)
        try:
            for place in places:
                futures[_submitted(executor, work, asked[place])] = place
            for future in as_completed(futures):
                place = futures[future]
                results[place] = _result(future, asked[place], raises)
                if ended is not None:
                    ended(asked[place], results[place])
        except BaseException:
            for future in futures:
                future.cancel()
            raise
    return [results[place] for place in range(len(asked))]


def _take_turn(work: Callable[[Asked], Result], one: Asked) -> Result:
    with _ONE_AT_A_TIME:
        return work(one)


def _submitted(executor: Executor, work: Callable[[Asked], Result], one: Asked) -> Future[Result]:
    try:
        return executor.submit(partial(_take_turn, work), one)
    except Exception as error:
        raise Failed(f"{one}: {_of_executor(error)}") from error


def _result(future: Future[Result], one: object, raises: type[Exception]) -> Result:
    try:
        return future.result()
    except (WorkerLost, BrokenExecutor) as error:
        raise Failed(f"{one}: {error}") from error
    except CancelledError as error:
        raise Failed(
            f"{one}: expected a result, got the executor's word that it was cancelled"
        ) from error
    except raises:
        raise
    except Exception as error:
        raise Failed(f"{one}: {_of_executor(error)}") from error


def _of_executor(error: Exception) -> str:
    return f"expected a result, got an error of the executor: {type(error).__name__}: {error}"
