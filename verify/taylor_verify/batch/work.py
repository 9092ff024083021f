"""Pieces of work on any executor: results in the order asked for, one clear end for all of them."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Sequence
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    wait,
)
from contextlib import ExitStack, closing
from functools import partial
from itertools import islice
from typing import Any, TypeVar

from taylor_verify.batch.failure import Failed
from taylor_verify.batch.pool import LocalPool, WorkerLost, available_cores
from taylor_verify.numbers.working_precision import ONE_AT_A_TIME

Asked = TypeVar("Asked")
Result = TypeVar("Result")


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
    """Call ``work`` for each item ``asked``, and return the results in the order of the items.

    ``executor`` is any `concurrent.futures.Executor`; only its ``submit`` is called, and it is left
    open. Without one, ``workers`` processes of this machine are used (as many as cores, unless given); an
    error or an interrupt ends them. Work begins in the order of ``expense``, and ``ended(item, result)``
    is called in this thread as each piece of work ends. An error, or an interrupt, cancels the work that
    has not begun.

    Raises Failed if a process was lost, and whatever the work or ``ended`` raises. If the work ``raises``
    errors of one type only, any other error becomes Failed: the executor made it.
    """
    if not asked:
        return []
    places = sorted(range(len(asked)), key=lambda k: expense(asked[k]) if expense else k)
    workers = min(workers or available_cores(), len(asked))
    results: dict[int, Result] = {}
    numbered = ((place, asked[place]) for place in places)
    with closing(_ended(work, numbered, executor, workers, len(asked), raises)) as all_ended:
        for place, result in all_ended:
            results[place] = result
            if ended is not None:
                ended(asked[place], result)
    return [results[place] for place in range(len(asked))]


def run_stream(
    work: Callable[[Asked], Result],
    asked: Iterable[Asked],
    executor: Executor | None = None,
    *,
    workers: int | None = None,
    ahead: int = 256,
    raises: type[Exception] = Exception,
) -> Generator[Result]:
    """Call ``work`` for each item ``asked``, and yield each result when its work ends.

    No more than ``ahead`` items are under way at a time, so that memory is bounded for any number of items.
    ``executor``, ``workers`` and ``raises`` are those of `run_all`, and so are the errors. Whoever does not
    take all results closes the generator.
    """
    numbered = enumerate(asked)
    for _, result in _ended(work, numbered, executor, workers or available_cores(), ahead, raises):
        yield result


def _ended(
    work: Callable[[Asked], Result],
    numbered: Iterable[tuple[int, Asked]],
    executor: Executor | None,
    workers: int,
    ahead: int,
    raises: type[Exception],
) -> Generator[tuple[int, Result]]:
    """Yield the number and the result of each piece of work as it ends."""
    waiting: dict[Future[Result], tuple[int, Asked]] = {}
    left = iter(numbered)
    with ExitStack() as stack:
        if executor is None:
            pool = LocalPool(workers)
            executor = stack.enter_context(pool)
            # Nobody waits for the rest of what ends early, and the pool would.
            stack.push(lambda kind, *_: pool.terminate() if kind else None)
        try:
            while True:
                for place, one in islice(left, ahead - len(waiting)):
                    waiting[_submitted(executor, work, one)] = place, one
                if not waiting:
                    return
                for future in wait(waiting, return_when=FIRST_COMPLETED).done:
                    place, one = waiting.pop(future)
                    yield place, _result(future, one, raises)
        except BaseException:
            for future in waiting:
                future.cancel()
            raise


def _take_turn(work: Callable[[Asked], Result], one: Asked) -> Result:
    with ONE_AT_A_TIME:
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
        raise Failed(f"{one}: {error}") from None
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
