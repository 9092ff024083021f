"""A small family to sweep, as a file."""

from __future__ import annotations

from pathlib import Path

import pytest
from builders.sweeps import TEMPLATE


@pytest.fixture
def template(tmp_path: Path) -> str:
    file = tmp_path / "small.toml"
    file.write_text(TEMPLATE)
    return str(file)
