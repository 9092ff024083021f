"""A script in solvers/outside, and what its block of inline metadata (PEP 723) says.

In with_NAME.mjs the lines begin with // instead of #, packages are pinned as "cannon-es@0.20.0", and
requires-node = ">=20" says which node is needed; in with_NAME.cpp they are those of Debian,
"libode-dev=2:0.16.2-1". `cases/README.md`, *To add an engine*, explains the tables
`[tool.taylor-verify]`, its `methods` and its `settings`.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import inf
from pathlib import Path
from typing import Any, Final, Literal

import msgspec

from taylor_verify.records.faults import Refused
from taylor_verify.solvers.engines.launcher import Launcher
from taylor_verify.solvers.engines.native import Native
from taylor_verify.solvers.engines.node import Node
from taylor_verify.solvers.engines.python import Python

# The launcher of scripts by the ending of their names.
_LAUNCHERS: Final[Mapping[str, Launcher]] = {".py": Python(), ".mjs": Node(), ".cpp": Native()}
_PREFIX: Final = "with_"


class About(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """The table `[tool.taylor-verify]` of a script.

    A version that is asked for replaces the pin of ``package``, else of the first dependency, and of those
    ``alike``; ``flags`` are those of a compiler. A default of ``settings`` is a number, the name of
    another setting, or a list of words.
    """

    title: str
    package: str = ""
    alike: tuple[str, ...] = ()
    rungs: tuple[str, ...] = ("f64",)
    models: tuple[str, ...] = ("euler", "kirchhoff")
    loads: bool | Literal["written"] = True
    data: Literal["inverse", "tensor"] = "inverse"
    serves: bool = False
    flags: str = ""
    methods: Mapping[str, str] = {}
    settings: Mapping[str, float | str | list[str]] = {}


@dataclass(frozen=True)
class Script:
    """A script, its block of metadata as TOML, its requirements, and what it says of itself.

    ``origin`` says which other package brings it.
    """

    path: Path
    block: str
    requirements: tuple[str, ...]
    about: About
    origin: str = ""

    @property
    def launcher(self) -> Launcher:
        return _LAUNCHERS[self.path.suffix]

    @property
    def library(self) -> str:
        return self.path.stem.removeprefix(_PREFIX)

    @property
    def version(self) -> str:
        """The version of its package that it requires; empty if there is none."""
        start = f"{self.package}{self.launcher.pin}"
        pins = (pin for pin in self.requirements if pin.startswith(start))
        return next((pin.removeprefix(start) for pin in pins), "")

    @property
    def package(self) -> str:
        """The package whose version can be chosen; empty for a script that needs none."""
        first = self.launcher.pinned.match(self.requirements[0]) if self.requirements else None
        return self.about.package or (first[1] if first else "")

    def at_version(self, version: str) -> str:
        """Return the block with another version of the package; ValueError for text that is none."""
        pin = self.launcher.pin
        if not self.launcher.version.fullmatch(version):
            raise ValueError(f"expected a version such as 1.2.0, got {version!r:.60} @ version")
        if not self.package:
            raise ValueError(f"expected no version: {self.path.name} has no library @ version")
        packages = "|".join(re.escape(name + pin) for name in (self.package, *self.about.alike))
        return re.sub(rf'"({packages})[^"]*"', rf'"\g<1>{version}"', self.block)


def scripts(folder: Path) -> list[Script]:
    """Read the scripts of a folder that answer for a library, by name; Refused with the faults of all."""
    result, faults = list[Script](), list[str]()
    files = (file for file in folder.glob(f"{_PREFIX}*") if file.suffix in _LAUNCHERS)
    for path in sorted(files):
        try:
            result.append(read_script(path))
        except ValueError as error:
            faults += str(error).splitlines()
    if faults:
        raise Refused(faults)
    return result


def read_script(path: Path) -> Script:
    """Read the metadata of a script; ValueError where there is none or it is not as above."""
    mark = _LAUNCHERS[path.suffix].comment
    block_lines = rf"^{mark} /// script\n((?:{mark}(?: .*)?\n)+){mark} ///$"
    blocks = re.findall(block_lines, path.read_text(encoding="utf-8"), re.MULTILINE)
    if len(blocks) != 1:
        raise ValueError(f"expected one block of script metadata, got {len(blocks)} @ {path.name}")
    block = re.sub(f"^{mark} ?", "", blocks[0], flags=re.MULTILINE)
    try:
        metadata: dict[str, Any] = tomllib.loads(block)
        about = msgspec.convert(metadata.get("tool", {}).get("taylor-verify", {}), About)
        requirements = msgspec.convert(metadata.get("dependencies", []), tuple[str, ...])
    except tomllib.TOMLDecodeError as error:
        raise ValueError(f"expected TOML in the metadata, got {error} @ {path.name}") from error
    except msgspec.ValidationError as error:
        raise ValueError(f"expected other metadata, got: {error} @ {path.name}") from error
    script = Script(path, block, requirements, about)
    if faults := list(_faults(script)):
        raise ValueError("\n".join(f"{fault} @ {path.name}" for fault in faults))
    return script


def _faults(script: Script) -> Iterator[str]:
    """Yield a sentence for each requirement without its version and each default that is none."""
    pinned: set[str] = set()
    for requirement in script.requirements:
        if match := script.launcher.pinned.fullmatch(requirement):
            pinned.add(match[1])
        else:
            yield f"expected a dependency pinned with {script.launcher.pin}, got {requirement!r}"
    for package in filter(None, (script.about.package, *script.about.alike)):
        if package not in pinned:
            yield f"expected a package among the dependencies, got {package!r}"
    known: set[str] = set()
    for key, default in script.about.settings.items():
        if isinstance(default, int | float) and not 0 < default < inf:
            yield f"expected a positive number or words for the setting {key}, got {default!r}"
        if isinstance(default, str) and default not in known:
            yield f"expected an earlier setting for {key} to follow, got {default!r}"
        if isinstance(default, list) and not default:
            yield f"expected words for the setting {key}, got none"
        known.add(key)
