"""A script in solvers/outside, and what its block of inline metadata (PEP 723) says.

requires-python = ">=3.11,<3.15"
dependencies = ["scikit-sundae==1.2.0", "numpy==2.4.6"]
[tool.taylor-verify]
title = "SUNDIALS CVODE, by scikit-sundae"
package = "scikit-sundae"              optional: whose pin `version` replaces; else the first
rungs = ["f64"]                        optional
models = ["euler", "kirchhoff"]        optional
unavailable = "..."                    optional: why nothing can install it
[tool.taylor-verify.methods]           optional: each method is a solver, with its title
bdf = "BDF, order 1 to 5"
[tool.taylor-verify.settings]          optional: each with its default
rtol = 1e-9                            a positive number
atol = "rtol"                          the value of another setting
integrator = ["RK4", "Euler"]          one of these words, the first unless another is set
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import msgspec

_BLOCK: Final = re.compile(r"^# /// script\n((?:#(?: .*)?\n)+)# ///$", re.MULTILINE)
_VERSION: Final = re.compile(r"\d+(\.\d+)*((a|b|rc)\d+)?(\.(post|dev)\d+)*")
_PREFIX: Final = "with_"


class About(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """The table `[tool.taylor-verify]` of a script."""

    title: str
    package: str = ""
    rungs: tuple[str, ...] = ("f64",)
    models: tuple[str, ...] = ("euler", "kirchhoff")
    unavailable: str = ""
    methods: Mapping[str, str] = {}
    settings: Mapping[str, float | str | list[str]] = {}


@dataclass(frozen=True)
class Script:
    """A script, its block of metadata as TOML, its requirements, and what it says of itself."""

    path: Path
    block: str
    requirements: tuple[str, ...]
    about: About

    @property
    def library(self) -> str:
        return self.path.stem.removeprefix(_PREFIX)

    def at_version(self, version: str) -> str:
        """Return the block with another version of the package; ValueError for text that is none."""
        if not _VERSION.fullmatch(version):
            raise ValueError(f"expected a version such as 1.2.0, got {version!r:.60} @ version")
        package = self.about.package or self.requirements[0].partition("==")[0]
        return re.sub(rf'"{re.escape(package)}==[^"]*"', f'"{package}=={version}"', self.block)


def scripts(folder: Path) -> list[Script]:
    """Read the scripts of a folder that answer for a library, by name."""
    return [read_script(path) for path in sorted(folder.glob(f"{_PREFIX}*.py"))]


def read_script(path: Path) -> Script:
    """Read the metadata of a script; ValueError where there is none or it is not as above."""
    blocks = _BLOCK.findall(path.read_text(encoding="utf-8"))
    if len(blocks) != 1:
        raise ValueError(f"expected one block of script metadata, got {len(blocks)} @ {path.name}")
    block = re.sub("^# ?", "", blocks[0], flags=re.MULTILINE)
    try:
        metadata: dict[str, Any] = tomllib.loads(block)
        about = msgspec.convert(metadata.get("tool", {}).get("taylor-verify", {}), About)
        requirements = msgspec.convert(metadata.get("dependencies", []), tuple[str, ...])
    except tomllib.TOMLDecodeError as error:
        raise ValueError(f"expected TOML in the metadata, got {error} @ {path.name}") from error
    except msgspec.ValidationError as error:
        raise ValueError(f"expected other metadata, got: {error} @ {path.name}") from error
    return Script(path, block, requirements, about)
