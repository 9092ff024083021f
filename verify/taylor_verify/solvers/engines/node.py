"""Environments of scripts in JavaScript: packages that npm installs, and node.

An environment is a folder of the user's cache, made apart and moved there when it is whole. The lock
beside a script, `with_NAME.lock.json`, pins the packages and all that they need, with their hashes; it
names no registry, so that npm asks the one that it is set to. Another version than the script pins is
not in the lock, and npm alone says what it is. No package runs a script of its own.

node looks for the packages of a script in the folders above it, and not where it is started. So the
scripts stand in the environment as copies, in a folder named for their text.
"""

from __future__ import annotations

import hashlib
import json
import re
import shutil
import tomllib
from collections.abc import Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final, final

from taylor_verify.records.replacement import replace_files
from taylor_verify.solvers.engines.launcher import (
    Launcher,
    NotMade,
    Tell,
    cache_folder,
    made_once,
    output,
)
from taylor_verify.solvers.solver import Lack
from taylor_verify.solvers.trajectory import Outcome

INSTALL: Final = "conda install -c conda-forge nodejs"
# engine-strict: a node that does not fit `requires-node` is an error.
_OPTIONS: Final = (
    "--ignore-scripts --engine-strict --no-audit --no-fund --no-update-notifier "
    "--loglevel=error --logs-max=0"
)
_PACKAGE: Final = "package.json"
_LOCK: Final = "package-lock.json"


@final
class Node(Launcher):
    """Scripts with_NAME.mjs, their packages from npm."""

    comment = "//"
    pin = "@"
    pinned = re.compile(r"((?:@[a-z0-9_.-]+/)?[a-z0-9_.-]+)@\d+\.\d+\.\d+(-[0-9A-Za-z.-]+)?")
    version = re.compile(r"\d+\.\d+\.\d+(-[0-9A-Za-z.-]+)?")

    def unavailable(self) -> str:
        for program in ("node", "npm"):
            if not shutil.which(program):
                return Lack(f"{program} is not installed: {INSTALL}", Outcome.NO_PACKAGE)
        return ""

    def command(self, name: str, script: Path, block: str, tell: Tell) -> list[str]:
        try:
            environment = _environment(name, _package_files(script, block), tell)
            return [_program("node"), str(_copied(script, environment))]
        except OSError as error:
            place = error.filename or cache_folder()
            raise NotMade(f"{place}: {error.strerror or error}") from None


def lock(script: Path, block: str) -> Path:
    """Write the lock of a script with this block of metadata, as the registry says; return its place."""
    with TemporaryDirectory() as apart:
        replace_files(Path(apart), {_PACKAGE: _package(block)})
        words = "install --package-lock-only --omit-lockfile-registry-resolved"
        output([_program("npm"), *words.split(), *_OPTIONS.split()], Path(apart))
        text = Path(apart, _LOCK).read_text(encoding="utf-8")
    (place,) = replace_files(script.parent, {_lock_file(script).name: text})
    return place


def _lock_file(script: Path) -> Path:
    return script.with_suffix(".lock.json")


def _package_files(script: Path, block: str) -> dict[str, str]:
    """Return package.json, and the lock if it is one of the versions that the block asks for."""
    files = {_PACKAGE: _package(block)}
    with suppress(FileNotFoundError):
        text = _lock_file(script).read_text(encoding="utf-8")
        if json.loads(text)["packages"][""].get("dependencies") == _dependencies(block):
            files[_LOCK] = text
    return files


def _package(block: str) -> str:
    engines = {"node": tomllib.loads(block).get("requires-node", "*")}
    package = {
        "name": "script",
        "private": True,
        "engines": engines,
        "dependencies": _dependencies(block),
    }
    return json.dumps(package)


def _dependencies(block: str) -> dict[str, str]:
    """Return the version of each package in a block of metadata."""
    pins = tomllib.loads(block).get("dependencies", [])
    return dict(pin.rsplit("@", 1) for pin in pins)


def _environment(name: str, files: Mapping[str, str], tell: Tell) -> Path:
    """Return the folder that has the packages of package.json, made if it is not there."""
    packages = json.loads(files[_PACKAGE])["dependencies"]

    def make(made: Path, _: Path) -> None:
        replace_files(made, files)
        if packages:
            _install(made, name, tell)

    return made_once(f"{name}-{_digest(files)}", lambda place: _is_whole(place, packages), make)


def _is_whole(place: Path, packages: Iterable[str]) -> bool:
    modules = place / "node_modules"
    needed = [place, *(modules / name for name in packages)]
    return all((folder / _PACKAGE).exists() for folder in needed)


def _install(folder: Path, name: str, tell: Tell) -> None:
    verb = ["ci"] if (folder / _LOCK).exists() else ["install", "--no-package-lock"]
    npm = [_program("npm"), *verb, *_OPTIONS.split()]
    try:
        output([*npm, "--offline"], folder)
    except NotMade:
        tell(f"making the environment of {name}, once: a download")
        output(npm, folder)


def _copied(script: Path, environment: Path) -> Path:
    """Return the place in the environment where the script stands beside the files that it imports."""
    shared = (file for file in script.parent.glob("*.mjs") if not file.name.startswith("with_"))
    files = {file.name: file.read_text(encoding="utf-8") for file in (script, *shared)}
    place = environment / _digest(files)
    if not all((place / name).exists() for name in files):
        replace_files(place, files)
    return place / script.name


def _digest(files: Mapping[str, str]) -> str:
    return hashlib.sha256(json.dumps(files, sort_keys=True).encode()).hexdigest()[:12]


def _program(name: str) -> str:
    return shutil.which(name) or name
