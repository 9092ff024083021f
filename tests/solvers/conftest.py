"""What the tests of engines share: scripts as modules, and one script in place of those shipped."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

from taylor_verify.solvers.engines import engine
from taylor_verify.solvers.engines.engine import SCRIPTS, engines


@pytest.fixture
def sibling(monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[str], Any]]:
    """Imports a script, or a file that scripts share, as they do: from their own folder."""
    monkeypatch.syspath_prepend(str(SCRIPTS))
    loaded = set(sys.modules)
    yield import_module
    for name in set(sys.modules) - loaded:
        if str(getattr(sys.modules[name], "__file__", "")).startswith(str(SCRIPTS)):
            del sys.modules[name]


@pytest.fixture
def users_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The user's cache folder, empty, and no environment remembered."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setattr(engine, "_commands", {})
    return tmp_path / "cache"


@pytest.fixture
def only_script(
    users_cache: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Callable[[str, str], Path]]:
    """Writes the one script there is, by its name and text."""
    folder = tmp_path / "scripts"
    folder.mkdir()
    monkeypatch.setattr(engine, "SCRIPTS", folder)

    def write(name: str, text: str) -> Path:
        (folder / name).write_text(text)
        engines.cache_clear()
        return folder / name

    yield write
    engines.cache_clear()
