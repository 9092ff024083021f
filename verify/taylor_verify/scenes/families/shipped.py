"""The shipped families: their folder, their names, and the search for one of them."""

from __future__ import annotations

import difflib
from pathlib import Path
from typing import Final

from taylor_verify.records.faults import Refused
from taylor_verify.scenes.families.family import Family
from taylor_verify.scenes.families.template import load_family
from taylor_verify.scenes.library import cases_directory

FAMILIES: Final = "families"


def family_names() -> tuple[str, ...]:
    """Return the names of the shipped families, in alphabetical order."""
    return tuple(sorted(file.stem for file in _folder().glob("*.toml")))


def is_family(name: str) -> bool:
    """Return True for the name of a shipped family."""
    return name in family_names()


def family(name: str) -> Family:
    """Return the shipped family of this name. Raises Refused for a name that is none."""
    if is_family(name):
        return load_family(_folder() / f"{name}.toml")
    close = difflib.get_close_matches(name, family_names(), n=1)
    mend = f"did you mean {close[0]}?" if close else f"families: {', '.join(family_names())}"
    raise Refused([f"expected a family, a folder of scenes or a template, got {name} ({mend})"])


def _folder() -> Path:
    return cases_directory() / FAMILIES
