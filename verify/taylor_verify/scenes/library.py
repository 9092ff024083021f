"""The shipped scenes: their folder, their names, and the search for one of them."""

from __future__ import annotations

import difflib
import os
from collections.abc import Mapping
from fnmatch import fnmatchcase
from glob import glob
from pathlib import Path
from types import MappingProxyType
from typing import Final

from taylor_verify.records.faults import Refused, brief
from taylor_verify.records.plugins import free

STANDARD_SET: Final = ("euler", "kirchhoff", "loads", "manufactured")
EXTREMES: Final = "extremes"
# Scenes with the worst errors that searches came upon; they run with the extremes.
WORST: Final = "extremes/worst"
# Scenes for the comparison of physics engines: each sample time is a multiple of every step there.
ENGINES: Final = "engines"
# The few scenes to begin with, and the purpose of each.
GUIDE: Final[Mapping[str, str]] = MappingProxyType(
    {
        "euler/oblique-start": "begin here: axes, signs of products, order and direction of quaternions",
        "euler/satellite-degrees": "rates in deg/s, a slow satellite",
        "euler/tennis-racket": "how soon small errors flip a body spun about its middle axis",
        "euler/constant-moment": "a torque that is constant in body axes",
        "euler/separatrix": "the hardest orbit of a free body: an infinite period",
        "loads/gravity-gradient": "a satellite under a torque that the scene writes down",
        "loads/vehicle-drag-thrust": "an underwater vehicle with weight, thrust, drag and lift",
        "kirchhoff/auv-turn": "begin here with a vehicle: mass matrix with added mass, velocities, path",
        "kirchhoff/whole-motion": "a body of revolution in a fluid: impulses, attitude and path",
        "extremes": "what breaks integrators: tiny distances, huge spans, extreme scales",
    }
)

_MOST_SUGGESTED = 3
_PATTERN: Final = frozenset("*?[")
_ENDING: Final = ".toml"


def cases_directory() -> Path:
    """Return the folder of the shipped scenes: inside an installed package, beside `verify` in a checkout.

    Raises FileNotFoundError where there is neither, so that no run passes for want of scenes.
    """
    package = Path(__file__).resolve().parents[1]
    for folder in (package / "cases", package.parents[1] / "cases"):
        if folder.is_dir():
            return folder
    raise FileNotFoundError(
        f"expected the shipped scenes in a folder `cases` in {package} or {package.parents[1]}"
    )


def names(*folders: str) -> tuple[str, ...]:
    """Return the names of the scenes in these folders (``euler/generic``), sorted within each folder.

    Without a folder, the names are those of the standard set.
    """
    cases = cases_directory()
    files = (
        file
        for folder in folders or STANDARD_SET
        for file in sorted((cases / folder).glob("*.toml"))
    )
    # A file whose name is in capitals, such as EXPECTED.toml, is no scene.
    return tuple(
        file.relative_to(cases).with_suffix("").as_posix()
        for file in files
        if not file.stem.isupper()
    )


def folders_of_plugins() -> dict[str, Path]:
    """Return the folders of scenes that other packages add, by name."""
    own = (folder.name for folder in cases_directory().iterdir())
    sound = free("scenes", lambda plugin: iter((plugin.name,)), own)
    return {plugin.name: Path(plugin.content) for plugin in sound}


def added_names() -> tuple[str, ...]:
    """Return the names of the scenes that other packages add."""
    folders = folders_of_plugins().items()
    return tuple(
        f"{name}/{f.stem}" for name, folder in folders for f in sorted(folder.glob("*.toml"))
    )


def named(scene: str) -> tuple[str, ...]:
    """Return the scenes that a word of the command line stands for.

    A folder (``extremes``) stands for all its scenes. A pattern (``euler/*``) stands for the shipped scenes
    that match, where a star matches slashes too, or for the files that match if it ends in ``.toml``. Any
    other word, and a pattern that nothing matches, is returned as it is.
    """
    if _is_pattern(scene):
        if scene.endswith(_ENDING):
            return tuple(sorted(glob(scene))) or (scene,)
        return tuple(name for name in _all_names() if fnmatchcase(name, scene)) or (scene,)
    if scene in folders_of_plugins():
        return tuple(name for name in added_names() if name.startswith(f"{scene}/"))
    folders = (EXTREMES, WORST) if scene == EXTREMES else (scene,)
    is_folder = scene in (*STANDARD_SET, EXTREMES, WORST, ENGINES)
    return (names(*folders) if is_folder else ()) or (scene,)


def find(scene: str | os.PathLike[str]) -> Path:
    """Return the file of a scene given by path or by the name of a shipped scene.

    A text that ends in ``.toml``, or that names an existing file, is a path. Raises Refused for an unknown
    name, and for an argument that is neither text nor a path.
    """
    expected = "a path or the name of a shipped scene"
    if not isinstance(scene, str | os.PathLike):
        raise Refused([f"expected {expected}, got the {type(scene).__name__} {brief(scene)}"])
    path = Path(scene)
    name = str(scene)
    try:
        if path.suffix == _ENDING or path.is_file():
            return path
        shipped = cases_directory() / f"{name}.toml"
        if name and shipped.is_file():
            return shipped
        folder, _, stem = name.partition("/")
        if (
            stem
            and (added := folders_of_plugins().get(folder))
            and (added / f"{stem}.toml").is_file()
        ):
            return added / f"{stem}.toml"
    except OSError as error:  # a name longer than any file's
        raise Refused([f"expected {expected}, got {name:.60} ({error.strerror})"]) from None
    raise Refused([f"expected {expected}, got {name} ({_near(name)})"])


def _is_pattern(scene: str) -> bool:
    """Return True for a text with ``*``, ``?`` or ``[`` that is not the name of a file."""
    return not _PATTERN.isdisjoint(scene) and not os.path.exists(scene)


def _all_names() -> tuple[str, ...]:
    return (*names(*STANDARD_SET, EXTREMES, WORST, ENGINES), *added_names())


def _near(scene: str) -> str:
    if _is_pattern(scene):
        return "no scene fits the pattern; `list` names them all"
    if os.path.isdir(scene):
        return f"it is a folder: name the scenes in it, '{os.path.join(scene, f'*{_ENDING}')}'"
    known = _all_names()
    close = difflib.get_close_matches(scene, known, n=_MOST_SUGGESTED, cutoff=0.5)
    # The part after the slash is often all that somebody remembers.
    close += [name for name in known if scene and scene in name and name not in close]
    if not close:
        return "`list` names them all"
    return f"did you mean {', '.join(close[:_MOST_SUGGESTED])}?"
