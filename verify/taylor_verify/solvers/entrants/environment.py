"""An environment of its own for a script with inline metadata (PEP 723), made once and kept.

It stands with the user's other caches, under a name with a digest of the script's metadata and of the
interpreter: another pin, or another Python, is another environment. It is made with uv where that is
on the PATH, else with venv and pip, from wheels but for what the maker names: nothing is compiled by
surprise. The mark that it is whole is written last, and one without it is made anew.
"""

from __future__ import annotations

import hashlib
import os
import platform
import re
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final

_BLOCK: Final = re.compile(r"^# /// script\n((?:#(?: .*)?\n)+)# ///$", re.MULTILINE)
_BOUND: Final = re.compile(r"(>=|<)\s*(\d+(?:\.\d+)*)")
_MARK: Final = ".whole"
# Seconds. The largest of them is some 600 MB, which at a megabyte a second take ten minutes.
_LONGEST_INSTALL: Final = 3600.0
_LONGEST_REASON: Final = 300

Tell = Callable[[str], object]


class NotMade(Exception):
    """The environment could not be made; the text is the reason, in one line."""


@dataclass(frozen=True)
class Metadata:
    """What a script says of itself: the interpreters it fits, its pins, and tables of tools."""

    text: str
    requires_python: str
    requirements: tuple[str, ...]
    tools: Mapping[str, Any]

    def unfit(self, version: tuple[int, int, int] = sys.version_info[:3]) -> str:
        """Why an interpreter does not fit; empty where it does."""
        for bound in filter(None, self.requires_python.split(",")):
            match = _BOUND.fullmatch(bound.strip())
            if match is None:
                return f"expected >= or < in requires-python, got {bound!r}"
            limit = tuple(map(int, match[2].split(".")))
            if (version >= limit) is (match[1] == "<"):
                got = ".".join(map(str, version))
                return f"needs Python {self.requires_python}, this is {got}"
        return ""


def metadata(script: Path) -> Metadata:
    """The inline metadata of a script. Raises ValueError where there is none or it is no TOML."""
    blocks = _BLOCK.findall(script.read_text(encoding="utf-8"))
    if len(blocks) != 1:
        raise ValueError(
            f"expected one block of script metadata, got {len(blocks)} @ {script.name}"
        )
    text = re.sub("^# ?", "", blocks[0], flags=re.MULTILINE)
    try:
        found = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ValueError(f"expected TOML in the metadata, got {error} @ {script.name}") from error
    return Metadata(
        text=text,
        requires_python=found.get("requires-python", ""),
        requirements=tuple(found.get("dependencies", ())),
        tools=found.get("tool", {}),
    )


@dataclass(frozen=True)
class Environment:
    """The environment of a script, made or not; ``name`` is for whoever looks into the cache.

    ``from_source`` are the requirements that have no wheels and may be built.
    """

    name: str
    metadata: Metadata
    from_source: tuple[str, ...] = ()

    @property
    def folder(self) -> Path:
        from platformdirs import user_cache_path

        return user_cache_path("taylor-verify") / "outside" / f"{self.name}-{self._digest}"

    @property
    def _digest(self) -> str:
        """Of all that decides what is in it: the metadata, the interpreter, the machine."""
        place = os.path.realpath(sys.base_prefix)
        parts = (self.metadata.text, sys.version, place, platform.machine())
        return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:12]

    @property
    def python(self) -> Path:
        return self.folder / "bin" / "python"

    @property
    def is_made(self) -> bool:
        """Whether it is whole, and the interpreter that it was made with is still there."""
        return (self.folder / _MARK).exists() and self.python.exists()

    def make(self, tell: Tell) -> None:
        """Make it if it is not there, one process at a time; ``tell`` hears what is being done.

        Raises NotMade.
        """
        if self.is_made:
            return
        if reason := self.metadata.unfit():
            raise NotMade(reason)
        try:
            self.folder.parent.mkdir(parents=True, exist_ok=True)
            with _alone(self.folder.with_name(f"{self.folder.name}.lock"), tell):
                # Another process may have made it while this one waited.
                if not self.is_made:
                    self._build(tell)
        except OSError as error:
            raise NotMade(f"{error.filename or self.folder}: {error.strerror or error}") from error

    def _build(self, tell: Tell) -> None:
        pins = ", ".join(self.metadata.requirements) or "nothing"
        tell(f"making the environment of {self.name}, once: {pins}")
        reasons = []
        for install in (_with_uv, _with_pip):
            shutil.rmtree(self.folder, ignore_errors=True)
            try:
                install(self)
            except NotMade as reason:
                reasons.append(str(reason))
                continue
            (self.folder / _MARK).touch()
            return
        shutil.rmtree(self.folder, ignore_errors=True)
        raise NotMade("; ".join(reason for reason in reasons if reason))


def _with_uv(environment: Environment) -> None:
    """Raises NotMade; with an empty reason where there is no uv."""
    uv = shutil.which("uv")
    if uv is None:
        raise NotMade("")
    _run([uv, "venv", "--quiet", "--python", sys.executable, str(environment.folder)])
    install = [uv, "pip", "install", "--quiet", "--python", str(environment.python)]
    _install(install, environment)


def _with_pip(environment: Environment) -> None:
    """With the pip that stands beside us; to put another one into the environment takes its time."""
    has_pip = find_spec("pip") is not None
    bare = ["--without-pip"] if has_pip else []
    _run([sys.executable, "-m", "venv", *bare, str(environment.folder)])
    quiet = ["--quiet", "--disable-pip-version-check", "--no-input"]
    if has_pip:
        pip = [sys.executable, "-m", "pip", *quiet, "--python", str(environment.python)]
    else:
        pip = [str(environment.python), "-m", "pip", *quiet]
    _install([*pip, "install"], environment)


def _install(command: list[str], environment: Environment) -> None:
    if not environment.metadata.requirements:
        return
    built = [word for name in environment.from_source for word in ("--no-binary", name)]
    _run([*command, "--only-binary", ":all:", *built, *environment.metadata.requirements])


def _run(command: list[str]) -> None:
    # Whoever runs us may have set up an interpreter of his own by these.
    ours = {"PYTHONPATH", "PYTHONHOME", "VIRTUAL_ENV"}
    environ = {key: value for key, value in os.environ.items() if key not in ours}
    try:
        subprocess.run(
            command,
            check=True,
            env=environ,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            timeout=_LONGEST_INSTALL,
        )
    except OSError as error:
        raise NotMade(f"{_tool(command)}: {error.strerror or error}") from None
    except subprocess.TimeoutExpired:
        raise NotMade(f"{_tool(command)}: no end after {_LONGEST_INSTALL:g} s") from None
    except subprocess.CalledProcessError as error:
        said = _reason(error.stdout.decode(errors="replace"))
        raise NotMade(f"{_tool(command)}: {said or f'exit status {error.returncode}'}") from None


def _tool(command: list[str]) -> str:
    return command[command.index("-m") + 1] if "-m" in command else Path(command[0]).name


def _reason(said: str) -> str:
    """The line that says why: the last error where one is called so, else the last line."""
    lines = [
        "".join(c if c.isprintable() else " " for c in line).strip() for line in said.split("\n")
    ]
    lines = [line for line in lines if line]
    errors = [line for line in lines if line.lower().startswith("error")]
    found = (errors or lines or [""])[-1]
    return re.sub(r"^error:\s*", "", found, flags=re.IGNORECASE)[:_LONGEST_REASON]


@contextmanager
def _alone(lock: Path, tell: Tell) -> Iterator[None]:
    """Hold a lock that ends with the process, whatever ends it; a system without locks has none."""
    try:
        import fcntl
    except ImportError:
        yield
        return
    with lock.open("w") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            tell("waiting for another process that is making the same environment")
            fcntl.flock(file, fcntl.LOCK_EX)
        yield
