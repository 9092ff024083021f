"""Executors by their names on the command line; only this module imports dask."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from importlib import import_module
from typing import Any, Final, NamedTuple

LOCAL: Final = "local"
DASK: Final = "dask:"
# Seconds in which a scheduler answers.
_PATIENCE: Final = 5
# Chunks under way for every thread of the workers, so that none waits for the next.
_AHEAD: Final = 3
_LEAST_AHEAD: Final = 64
# Number of workers that a chunk may crash before it is reported as lost.
_RETRIES: Final = 3


class Unreachable(ConnectionError):  # noqa: N818 (it names what happened to the address)
    """The error for an executor that cannot be reached; the text says what was expected and what came."""


class Placed(NamedTuple):
    """An executor, and how many chunks to have under way; None is the processes of this machine.

    ``workers`` counts the workers of a cluster at the start; None for this machine.
    """

    executor: Executor | None
    ahead: int
    workers: int | None = None


@contextmanager
def executor_named(name: str) -> Iterator[Placed]:
    """Yield the executor ``local``, or ``dask:ADDRESS`` of a scheduler, such as dask:tcp://host:8786.

    The scheduler and its workers are left as they are. Raises ValueError for another name, Unreachable
    where nobody answers, and where dask is not installed.
    """
    if name == LOCAL:
        yield Placed(None, _LEAST_AHEAD)
        return
    address = name.removeprefix(DASK)
    if not name.startswith(DASK) or not address:
        raise ValueError(
            f"expected local or dask:ADDRESS, such as dask:tcp://HOST:8786, got {name!r} @ executor"
        )
    try:
        # It has types for a part of itself only.
        distributed: Any = import_module("distributed")
    except ImportError:
        raise Unreachable("expected dask (pip install 'taylor-verify[dask]'), got none") from None
    try:
        client = distributed.Client(address, timeout=_PATIENCE)
    except (OSError, TimeoutError, ValueError) as error:
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise Unreachable(
            f"expected the address of a dask scheduler that answers within {_PATIENCE} s, such as "
            f"dask:tcp://HOST:8786, got {name!r}: {reason}"
        ) from None
    with client:
        threads = client.nthreads()
        executor = client.get_executor(pure=False, retries=_RETRIES)
        ahead = max(_AHEAD * sum(threads.values()), _LEAST_AHEAD)
        yield Placed(executor, ahead, workers=len(threads))
