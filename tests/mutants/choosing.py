"""A plugin of pytest that runs the tests of a list alone, in the order of the list."""

from __future__ import annotations

import os
from pathlib import Path

import pytest


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Leave the tests that the file of MUTANTS_CHOSEN names, one in a line."""
    chosen = Path(os.environ["MUTANTS_CHOSEN"]).read_text(encoding="utf-8").splitlines()
    place = {name: k for k, name in enumerate(chosen)}
    items[:] = sorted(
        (item for item in items if item.nodeid in place), key=lambda item: place[item.nodeid]
    )
