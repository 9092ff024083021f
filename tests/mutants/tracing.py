"""A plugin of pytest that notes which lines each test runs, and how long it takes.

The coverage of a line is filed under the test, whose fixtures count to it. Session and module fixtures,
and what is cached, count to the test that asked first.
"""

from __future__ import annotations

import json
import os
import time
from collections.abc import Iterator
from pathlib import Path

import coverage
import pytest

from mutants.mutant import PACKAGE

FOLDER = Path(os.environ["MUTANTS_TRACES"])
_SECONDS: dict[str, float] = {}
_TRACED = coverage.Coverage(
    data_file=str(FOLDER / "lines"),
    source=[str(PACKAGE / room) for room in os.environ["MUTANTS_ROOMS"].split()],
    config_file=False,
)
_TRACED.start()


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    """File what runs from here on under the test."""
    _TRACED.switch_context(item.nodeid)
    before = time.process_time()
    try:
        return (yield)
    finally:
        _SECONDS[item.nodeid] = time.process_time() - before


def pytest_sessionfinish() -> None:
    """Store the lines, and the seconds of each test."""
    _TRACED.stop()
    _TRACED.save()
    (FOLDER / "seconds.json").write_text(json.dumps(_SECONDS), encoding="utf-8")
