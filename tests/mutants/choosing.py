"""A plugin of pytest that runs the tests of a list alone, in its order, each for so much processor time.

The name of the test that runs is written before it starts: after a failure, or an end by force, it is the
one that noticed.
"""

from __future__ import annotations

import json
import os
import resource
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest

_PLACE = Path(os.environ["MUTANTS_CHOSEN"])
_LIMITS: dict[str, float] = json.loads(_PLACE.read_text(encoding="utf-8"))
_RANK = {name: k for k, name in enumerate(_LIMITS)}
# A change can make an import endless, or ask for all the memory there is.
signal.setitimer(signal.ITIMER_PROF, 60)
resource.setrlimit(resource.RLIMIT_AS, (8 * 2**30, 8 * 2**30))


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Leave the tests of the list."""
    chosen = [item for item in items if item.nodeid in _RANK]
    items[:] = sorted(chosen, key=lambda item: _RANK[item.nodeid])


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    """End the process if the test takes more of the processor than its limit: nobody handles the signal."""
    _PLACE.with_suffix(".running").write_text(item.nodeid, encoding="utf-8")
    signal.setitimer(signal.ITIMER_PROF, _LIMITS[item.nodeid])
    try:
        return (yield)
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
