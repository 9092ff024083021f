"""A plugin of pytest that collects tests once, and runs some of them for each of many jobs.

A job is a fork of this process. It swaps the code of the functions that a mutant changes, runs its tests
until one fails, and ends. So nothing is imported twice, and no job sees what another one has left.
"""

from __future__ import annotations

import gc
import importlib
import json
import os
import resource
import signal
from collections.abc import Iterator
from pathlib import Path
from types import CodeType, FunctionType
from typing import Final

import pytest

from mutants.mutant import changed, module_name

PLACE: Final = Path(os.environ["MUTANTS_PLACE"])
PACKAGE: Final = PLACE / "verify/taylor_verify"
# Seconds of an import, and of a job that waits without end and takes no time of the processor.
IMPORT, WAIT = 60, 3600
# A change can make an import endless, or ask for all the memory there is.
resource.setrlimit(resource.RLIMIT_AS, (8 * 2**30, 8 * 2**30))
signal.setitimer(signal.ITIMER_PROF, IMPORT)


def pytest_runtestloop(session: pytest.Session) -> bool:
    """Write the test that ends each job, or null, as a line of its own."""
    signal.setitimer(signal.ITIMER_PROF, 0)
    if session.testsfailed:
        return False
    jobs = json.loads((PLACE / "jobs.json").read_text(encoding="utf-8"))
    for path in {path for path, _ in (job["mutant"] for job in jobs if job["mutant"])}:
        importlib.import_module(module_name(path))
    # The conftest of the tests has put them where they are not listed.
    gc.unfreeze()
    for job in jobs:
        if not (child := os.fork()):
            status = 2
            try:
                status = _failing(session, **job)
            finally:
                os._exit(status)
        status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        name = None if status in (0, -signal.SIGALRM) else _running().read_text(encoding="utf-8")
        os.write(int(os.environ["MUTANTS_PIPE"]), f"{json.dumps(name)}\n".encode())
    return True


def _failing(
    session: pytest.Session, mutant: tuple[str, int] | None, limits: dict[str, float]
) -> int:
    """Return 1 after the first test that fails; be ended by a signal if one takes too long."""
    signal.alarm(WAIT)
    if mutant:
        _swap(*mutant)
    _running().write_text(next(iter(limits)), encoding="utf-8")
    by_name = {item.nodeid: item for item in session.items}
    items = [by_name[name] for name in limits]
    for item, after in zip(items, [*items[1:], None], strict=True):
        _running().write_text(item.nodeid, encoding="utf-8")
        signal.setitimer(signal.ITIMER_PROF, limits[item.nodeid])
        item.config.hook.pytest_runtest_protocol(item=item, nextitem=after)
        if session.testsfailed:
            return 1
    return 0


def _running() -> Path:
    return PLACE / "running"


def _swap(path: str, place: int) -> None:
    """Give the functions of a module the code of a mutant, wherever they are referred to."""
    file = PACKAGE / path
    source = file.read_text(encoding="utf-8")
    before = compile(source, str(file), "exec", dont_inherit=True)
    after = compile(changed(source, place), str(file), "exec", dont_inherit=True)
    pairs = list(_pairs(before, after))
    functions = [
        thing
        for thing in gc.get_objects()
        if isinstance(thing, FunctionType) and thing.__code__.co_filename == str(file)
    ]
    for function in functions:
        for old, new in pairs:
            if function.__code__ == old:
                function.__code__ = new
                break


def _pairs(before: CodeType, after: CodeType) -> Iterator[tuple[CodeType, CodeType]]:
    """Yield the codes that differ, each before and after."""
    if before != after:
        yield before, after
        inner = ([c for c in code.co_consts if isinstance(c, CodeType)] for code in (before, after))
        for old, new in zip(*inner, strict=True):
            yield from _pairs(old, new)
