"""Plug-ins: what other packages add, by entry points of the groups `taylor_verify.KIND`.

    solvers   a callable solve(problem), or a Solver: `--solver NAME`
    readers   read(path), which returns columns by name, and suffixes, such as (".log",)
    scenes    the path of a folder of *.toml, whose scenes are called NAME/stem
    engines   the path of an engine's script, as those in solvers/outside: `outside:LIBRARY-METHOD`
    causes    candidates(scene, answer), which yields changed scenes
    verbs     add(parser) and run(arguments)

A plug-in is imported when it is asked for. One that cannot be imported, breaks its contract or repeats a
name is named in one line of the log, and everything else goes on.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from taylor_verify.records.escapes import one_line

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

_GROUP: Final = "taylor_verify."
_SCRIPTS: Final = (".py", ".mjs", ".cpp")


class BrokenPlugin(ValueError):  # noqa: N818 (it names what it is)
    """A plug-in that cannot be imported or breaks its contract; the text names it and its package."""


class Plugin(NamedTuple):
    """A plug-in that keeps its contract, and the distribution that brings it."""

    name: str
    package: str
    content: Any

    @property
    def origin(self) -> str:
        return f"of the package {self.package}"


@cache
def plugins(kind: str) -> tuple[Plugin, ...]:
    """Return the plug-ins of a kind, by name; each that is left out is named once in the log."""
    sound: dict[str, Plugin] = {}
    for entry in entries(kind):
        try:
            content = load(kind, entry)
        except BrokenPlugin as broken:
            say_once(str(broken))
            continue
        plugin = Plugin(entry.name, package_of(entry), content)
        if sound.setdefault(entry.name, plugin) is not plugin:
            say_once(taken(kind, entry.name, plugin.package))
    return tuple(sound.values())


def free(kind: str, names: Callable[[Plugin], Iterator[str]], own: Iterator[str]) -> list[Plugin]:
    """Return the plug-ins none of whose names is one of ours, or of an earlier one."""
    known, sound = set(own), []
    for plugin in plugins(kind):
        wanted = set(names(plugin))
        if repeated := sorted(wanted & known):
            say_once(taken(kind, repeated[0], plugin.package))
        else:
            known |= wanted
            sound.append(plugin)
    return sound


@cache
def say_once(sentence: str) -> None:
    """Log why a plug-in is left out."""
    import logging

    logging.getLogger(__name__).warning("taylor-verify: warning: %s", sentence)


def taken(kind: str, name: str, package: str) -> str:
    """Return the sentence for a name that there is already."""
    return (
        f"the {kind.removesuffix('s')} {name} of {package} is left out: there is one of this name"
    )


def entries(kind: str) -> list[EntryPoint]:
    """Return the entry points of a kind, by name; nothing of them is imported."""
    from importlib.metadata import entry_points

    group = _GROUP + kind
    try:
        every = [*entry_points(group=group)]
    except Exception:  # the file of one package is enough
        every = [*_readable(group)]
    return sorted(every, key=lambda e: (e.name, package_of(e)))


def _readable(group: str) -> Iterator[EntryPoint]:
    """Yield the entry points of all packages whose own can be read; each other package is named."""
    from importlib.metadata import distributions

    known: set[str] = set()
    for package in distributions():
        name = str(package.name)
        if name in known:
            continue
        known.add(name)
        try:
            yield from package.entry_points.select(group=group)
        except Exception as error:  # other people's file
            say_once(f"the entry points of {name} cannot be read: {in_one_line(error)}")


def in_one_line(error: BaseException) -> str:
    """Return the kind and the text of an error."""
    return f"{type(error).__name__}: {one_line(str(error))}"


def package_of(entry: EntryPoint) -> str:
    """Return the distribution that brings an entry point."""
    return entry.dist.name if entry.dist is not None else "an unknown package"


def load(kind: str, entry: EntryPoint) -> Any:
    """Return the object behind an entry point. Raises BrokenPlugin."""
    expected = f"expected the {kind.removesuffix('s')} {entry.name} of {package_of(entry)}"
    if not entry.pattern.match(entry.value):
        raise BrokenPlugin(f"{expected} to be module:object, got {entry.value!r:.60}")
    try:
        content = entry.load()
    except (Exception, SystemExit) as error:
        raise BrokenPlugin(f"{expected}, got {in_one_line(error)}") from error
    if lack := _LACKS[kind](content):
        raise BrokenPlugin(f"{expected} {lack}")
    return content


def _lacks_parts(*parts: str) -> Callable[[Any], str]:
    def lack(content: Any) -> str:
        missing = [part for part in parts if not callable(getattr(content, part, None))]
        return f"to have {' and '.join(missing)}, got none" if missing else ""

    return lack


def _lacks_of_reader(content: Any) -> str:
    suffixes = getattr(content, "suffixes", ())
    are_suffixes = isinstance(suffixes, tuple | list) and all(
        isinstance(suffix, str) and suffix.startswith(".") for suffix in suffixes
    )
    if not suffixes or not are_suffixes:
        return f'to have suffixes such as (".log",), got {suffixes!r:.60}'
    return _lacks_parts("read")(content)


def _lacks_of_solver(content: Any) -> str:
    is_solver = callable(content) or callable(getattr(content, "solve", None))
    return "" if is_solver else f"to be callable, got a {type(content).__name__}"


def _lacks_of_folder(content: Any) -> str:
    if not isinstance(content, str | os.PathLike) or not os.path.isdir(content):
        return f"to be the path of a folder, got {content!r:.200}"
    has_scenes = any(os.fspath(name).endswith(".toml") for name in os.listdir(content))
    return "" if has_scenes else f"to have scenes *.toml, got none in {content}"


def _lacks_of_script(content: Any) -> str:
    is_path = isinstance(content, str | os.PathLike)
    if is_path and os.path.isfile(content) and str(content).endswith(_SCRIPTS):
        return ""
    return f"to be the path of a script ({', '.join(_SCRIPTS)}), got {content!r:.200}"


# What a plug-in of each kind lacks of its contract, as the end of a sentence; empty where it keeps it.
_LACKS: Final[Mapping[str, Callable[[Any], str]]] = {
    "solvers": _lacks_of_solver,
    "readers": _lacks_of_reader,
    "scenes": _lacks_of_folder,
    "engines": _lacks_of_script,
    "causes": _lacks_parts("candidates"),
    "verbs": _lacks_parts("add", "run"),
}
KINDS: Final = tuple(_LACKS)
