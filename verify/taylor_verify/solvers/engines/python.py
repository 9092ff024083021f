"""Environments of scripts in Python, as `uv run --script` makes them.

uv makes an environment, stores it in its own cache, shares it between processes, and repairs incomplete
ones. This file calls uv, first without a network, which suffices for packages that were downloaded before.
Only packages that the block names under `[tool.uv]` are built from source.
"""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import sys
from pathlib import Path
from typing import Final, final

from taylor_verify.records.replacement import replace_files
from taylor_verify.solvers.engines.launcher import Launcher, NotMade, Tell, cache_folder, output
from taylor_verify.solvers.solver import Lack
from taylor_verify.solvers.trajectory import Outcome

INSTALL: Final = "pip install 'taylor-verify[engines]'"


@final
class Python(Launcher):
    """Scripts with_NAME.py, their packages from wheels."""

    comment = "#"
    pin = "=="
    pinned = re.compile(r"([A-Za-z0-9_.-]+)(==\d+(\.\d+)*((a|b|rc)\d+)?| @ \S+)")
    version = re.compile(r"\d+(\.\d+)*((a|b|rc)\d+)?(\.(post|dev)\d+)*")

    def unavailable(self) -> str:
        return "" if _uv() else Lack(f"uv is not installed: {INSTALL}", Outcome.NO_PACKAGE)

    def command(self, name: str, script: Path, block: str, tell: Tell) -> list[str]:
        # Without what the user has set for another Python, and leaving no files beside the script.
        return [interpreter(name, block, tell), "-B", "-E", "-s", str(script)]


def interpreter(name: str, block: str, tell: Tell) -> str:
    """Return the Python of an environment, which is made if it is not there; NotMade if it cannot be."""
    script = _script(name, block)
    sync = ["sync", "--quiet", "--no-build", "--script", script]
    try:
        _uv_says([*sync, "--offline"])
    except NotMade:
        tell(f"making the environment of {name}, once: a download")
        _uv_says(sync)
    return _uv_says(["python", "find", "--script", script]).strip()


def _script(name: str, block: str) -> str:
    """Return the path of a script of nothing but the block: uv has one environment for each path."""
    digest = hashlib.sha256(block.encode()).hexdigest()[:12]
    place = cache_folder() / f"{name}-{digest}.py"
    lines = ["# /// script", *(f"# {line}".rstrip() for line in block.splitlines()), "# ///", ""]
    try:
        if not place.exists():
            replace_files(place.parent, {place.name: "\n".join(lines)})
    except OSError as error:
        raise NotMade(f"{error.filename or place.parent}: {error.strerror or error}") from None
    return str(place)


def _uv() -> str | None:
    """Return the program uv: that on the PATH, or that of the package beside this interpreter."""
    if program := shutil.which("uv"):
        return program
    try:
        from uv import find_uv_bin

        return str(find_uv_bin())
    except (ImportError, FileNotFoundError):
        return None


def _uv_says(arguments: list[str]) -> str:
    # uv looks for an interpreter on the PATH, and ours is one that is there.
    path = os.pathsep.join([os.environ.get("PATH", os.defpath), str(Path(sys.executable).parent)])
    return output([_uv() or "uv", *arguments], settings={"PATH": path})
