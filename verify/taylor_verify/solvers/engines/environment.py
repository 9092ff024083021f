"""The environment that a block of inline metadata asks for, as `uv run --script` makes it.

uv makes it, keeps it in its own cache, shares it between processes, and mends what is half made. Here
stands what calls uv: first without a network, which is enough for all that was ever downloaded.
Nothing is built but what the block names under `[tool.uv]`: nothing is compiled by surprise.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Final

from platformdirs import user_cache_path

from taylor_verify.records.replacement import replace_files
from taylor_verify.solvers.solver import Lack
from taylor_verify.solvers.trajectory import Outcome

INSTALL: Final = "pip install 'taylor-verify[engines]'"
# Seconds. The largest of them is some 600 MB, which at a megabyte a second take ten minutes.
_LONGEST_INSTALL: Final = 3600.0
_LONGEST_REASON: Final = 300

Tell = Callable[[str], object]


class NotMade(Exception):
    """The environment could not be made; the text is the reason, in one line."""


def unavailable() -> str:
    """Return the reason why no environment can be made here; empty where uv is there."""
    return "" if _uv() else Lack(f"uv is not installed: {INSTALL}", Outcome.NO_PACKAGE)


def interpreter(name: str, block: str, tell: Tell) -> str:
    """Return the Python of an environment, which is made if it is not there.

    ``tell`` hears of a download, which may take minutes. Raises NotMade.
    """
    if reason := unavailable():
        raise NotMade(reason)
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
    folder = user_cache_path("taylor-verify") / "outside"
    place = folder / f"{name}-{digest}.py"
    lines = ["# /// script", *(f"# {line}".rstrip() for line in block.splitlines()), "# ///", ""]
    try:
        if not place.exists():
            replace_files(folder, {place.name: "\n".join(lines)})
    except OSError as error:
        raise NotMade(f"{error.filename or folder}: {error.strerror or error}") from None
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
    try:
        done = subprocess.run(
            [_uv() or "uv", *arguments],
            check=False,
            env={**os.environ, "PATH": path},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=_LONGEST_INSTALL,
        )
    except OSError as error:
        raise NotMade(f"uv: {error.strerror or error}") from None
    except subprocess.TimeoutExpired:
        raise NotMade(f"uv: no end after {_LONGEST_INSTALL:g} s") from None
    if done.returncode:
        said = _one_line(done.stderr.decode(errors="replace"))
        raise NotMade(f"uv: {said or f'exit status {done.returncode}'}")
    return done.stdout.decode()


def _one_line(said: str) -> str:
    """Return the words of an error and of its causes, each of which uv gives a line."""
    words = "".join(c if c.isascii() and c.isprintable() else " " for c in said).split()
    text = " ".join(words).removeprefix("error: ").replace(" cause: ", ": ")
    return text[:_LONGEST_REASON]
