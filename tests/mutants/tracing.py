"""A plugin of pytest that notes which lines each test runs, and how long it takes.

The coverage of a line is filed under the test, whose fixtures count to it. What a file of tests has for
all its tests, and what is cached, counts to the test of that file that asked first. A file is stored when
its last test has passed: a stop loses no more than the file at which it comes.
"""

from __future__ import annotations

import functools
import gc
import json
import os
import time
from collections.abc import Iterator

import coverage
import pytest

from mutants.mutant import PACKAGE
from mutants.trace import Part

_PARTS = {file: Part(key) for file, key in json.loads(os.environ["MUTANTS_PARTS"]).items()}
_ROOMS = [str(PACKAGE / room) for room in os.environ["MUTANTS_ROOMS"].split()]
_SECONDS: dict[str, float] = {}
_FAILED: set[str] = set()


def _traced() -> coverage.Coverage:
    traced = coverage.Coverage(data_file=None, source=_ROOMS, config_file=False)
    traced.start()
    return traced


# From here on, so that it sees the imports.
_TRACED = [_traced()]


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_runtest_protocol(item: pytest.Item, nextitem: pytest.Item | None) -> Iterator[None]:
    """File what runs from here on under the test, and store the file of tests at its end."""
    _TRACED[0].switch_context(item.nodeid)
    before = time.process_time()
    try:
        return (yield)
    finally:
        _SECONDS[item.nodeid] = time.process_time() - before
        file = _file(item.nodeid)
        if nextitem is None or _file(nextitem.nodeid) != file:
            _end(file)


def pytest_runtest_logreport(report: pytest.TestReport) -> None:
    """Note the file of a test that fails, of which nothing is stored."""
    if report.failed:
        _FAILED.add(_file(report.nodeid))


def _end(file: str) -> None:
    """Store what one file of tests ran, and forget what its tests have left in caches."""
    _TRACED[0].stop()
    if file not in _FAILED:
        _PARTS[file].store(_TRACED[0].get_data(), _SECONDS)
    _SECONDS.clear()
    for cached in gc.get_objects():
        if isinstance(cached, functools._lru_cache_wrapper) and (
            getattr(cached, "__module__", None) or ""
        ).startswith("taylor_verify."):
            cached.cache_clear()
    _TRACED[0] = _traced()


def _file(name: str) -> str:
    return name.partition("::")[0]
