"""The shipped scenes: where they lie, what they are called, and how one is found."""

from __future__ import annotations

import difflib
from pathlib import Path
from typing import Final

from verify.scenes.faults import Refused

STANDARD_SET: Final = ("euler", "kirchhoff", "manufactured")

_MOST_SUGGESTED = 3


def cases_directory() -> Path:
    """The folder of the shipped scenes: inside an installed package, beside it in a checkout.

    Raises FileNotFoundError where there is neither, so that no run passes for want of scenes.
    """
    package = Path(__file__).resolve().parents[1]
    for folder in (package / "cases", package.parent / "cases"):
        if folder.is_dir():
            return folder
    raise FileNotFoundError(
        f"expected the shipped scenes in a folder `cases` in or beside {package}"
    )


def names() -> tuple[str, ...]:
    """The standard set by name (``euler/generic``), in alphabetical order."""
    cases = cases_directory()
    return tuple(_name(file) for folder in STANDARD_SET for file in _scenes(cases / folder))


def find(scene: str) -> Path:
    """The file of a scene given by path or by the name of a shipped scene.

    A text that ends in ``.toml`` or names a file is a path. Raises Refused for an unknown name.
    """
    path = Path(scene)
    if path.suffix == ".toml" or path.is_file():
        return path
    shipped = cases_directory() / f"{scene}.toml"
    if shipped.is_file():
        return shipped
    raise Refused([f"expected a path or the name of a shipped scene, got {scene} ({_near(scene)})"])


def _scenes(folder: Path) -> list[Path]:
    return sorted(folder.glob("*.toml")) if folder.is_dir() else []


def _name(file: Path) -> str:
    return f"{file.parent.name}/{file.stem}"


def _near(scene: str) -> str:
    known = names()
    close = difflib.get_close_matches(scene, known, n=_MOST_SUGGESTED, cutoff=0.5)
    # The part after the slash is often all that somebody remembers.
    close += [name for name in known if scene and scene in name and name not in close]
    if not close:
        return "`list` names them all"
    return f"did you mean {', '.join(close[:_MOST_SUGGESTED])}?"
