"""The contract of launchers, which run the scripts of one language in separate environments."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import ClassVar, Final

from platformdirs import user_cache_path

# Seconds. The largest of them is some 600 MB, which at a megabyte a second take ten minutes.
_LONGEST_INSTALL: Final = 3600.0
_LONGEST_REASON: Final = 300
# The prefixes of error lines of uv and npm, and the last line of npm.
_MARKS: Final = re.compile(r"^(error: |npm error Log files .*|npm (error|ERR!) ?)", re.MULTILINE)

Tell = Callable[[str], object]


class NotMade(Exception):
    """The environment could not be made; the text is the reason, in one line."""


class Launcher(ABC):
    """Maker of environments for scripts in one language.

    ``comment`` begins a line of their metadata, and ``pin`` stands between a package and its version.
    ``pinned`` matches a requirement with a version, and its first group is the package; ``version``
    matches a version that may take the place of the pinned one.
    """

    comment: ClassVar[str]
    pin: ClassVar[str]
    pinned: ClassVar[re.Pattern[str]]
    version: ClassVar[re.Pattern[str]]

    @abstractmethod
    def unavailable(self) -> str:
        """Return the reason why no environment can be made here; empty where one can."""

    @abstractmethod
    def command(self, name: str, script: Path, block: str, tell: Tell) -> list[str]:
        """Return the words that start a script in the environment that its block of metadata asks for.

        The environment is made if it is not there; ``tell`` hears of a download, which may take
        minutes. Raises NotMade.
        """


def cache_folder() -> Path:
    """Return the folder of the user's cache that environments are made in, or made from."""
    return user_cache_path("taylor-verify") / "outside"


def made_once(
    name: str, is_whole: Callable[[Path], bool], make: Callable[[Path, Path], object]
) -> Path:
    """Return a folder of the cache, made if it is not whole: apart, and put in its place at the end.

    ``make`` gets the folder apart, which is empty, and its last place.
    """
    place = cache_folder() / name
    if is_whole(place):
        return place
    shutil.rmtree(place, ignore_errors=True)
    cache_folder().mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory(dir=cache_folder(), prefix=".unfinished-") as apart:
        made = Path(apart, name)
        made.mkdir()
        make(made, place)
        try:
            made.rename(place)
        except OSError:
            # Another process may have made it meanwhile.
            if not is_whole(place):
                raise
    return place


def output(
    words: Sequence[str], folder: Path | None = None, settings: Mapping[str, str] | None = None
) -> str:
    """Return the standard output of an installing program. Raises NotMade with its error message."""
    name = Path(words[0]).name
    try:
        done = subprocess.run(
            words,
            check=False,
            cwd=folder,
            env={**os.environ, **(settings or {})},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=_LONGEST_INSTALL,
        )
    except OSError as error:
        raise NotMade(f"{name}: {error.strerror or error}") from None
    except subprocess.TimeoutExpired:
        raise NotMade(f"{name}: no end after {_LONGEST_INSTALL:g} s") from None
    if done.returncode:
        message = _one_line(done.stderr.decode(errors="replace"))
        raise NotMade(f"{name}: {message or f'exit status {done.returncode}'}")
    return done.stdout.decode()


def _one_line(message: str) -> str:
    """Return the words of an error and of its causes, each of which uv and npm give a line."""
    message = _MARKS.sub("", message)
    words = "".join(c if c.isascii() and c.isprintable() else " " for c in message).split()
    return " ".join(words).replace(" cause: ", ": ")[:_LONGEST_REASON]
