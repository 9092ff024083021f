"""The places at which a scene's loads have a number or a text, and the loads with another one there."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Final

from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.loads.states import Continuous
from taylor_verify.scenes.loads.vocabulary import Entry

HANGING: Final = ("weight", "buoyancy")
# The names of fields and the places in tuples that lead to an entry.
_Path = tuple[Any, ...]


@dataclass(frozen=True)
class Place:
    """A place of a scene's ``loads``, its key, and its name in a sentence."""

    loads: Loads
    path: _Path
    key: str
    name: str

    @property
    def entry(self) -> Entry:
        """The number or the text at this place."""
        node: Any = self.loads
        for step in self.path:
            node = getattr(node, step) if isinstance(step, str) else node[step]
        entry: Entry = node
        return entry

    def put(self, entry: Entry) -> Loads:
        """Return the loads with another entry at this place."""
        changed: Loads = _with(self.loads, self.path, entry)
        return changed


def places(loads: Loads) -> Iterator[Place]:
    """Yield the places of all numbers and texts: loads, definitions, [space], [tables] and [states]."""
    return (Place(loads, *each) for each in _paths(loads))


def texts_of_vectors(loads: Loads) -> list[Place]:
    """Return the places of the texts of force, couple and moment, each with its axis last in its path."""
    return [p for p in places(loads) if p.path[0] == "vectors" and isinstance(p.entry, str)]


def rational(entry: Entry) -> Fraction | None:
    """Return the value of an entry that is a number; None of another text."""
    try:
        return Fraction(entry)
    except (ValueError, ZeroDivisionError):
        return None


def with_entry(entries: tuple[Any, ...], k: int, entry: Any) -> tuple[Any, ...]:
    """Return a tuple with another entry at one place."""
    return (*entries[:k], entry, *entries[k + 1 :])


def _with(node: Any, path: _Path, entry: Entry) -> Any:
    if not path:
        return entry
    step, *rest = path
    if not isinstance(step, str):
        return with_entry(node, step, _with(node[step], tuple(rest), entry))
    changed = {step: _with(getattr(node, step), tuple(rest), entry)}
    return node._replace(**changed) if hasattr(node, "_replace") else replace(node, **changed)


def _paths(loads: Loads) -> Iterator[tuple[_Path, str, str]]:
    """Yield the path to each place, its key and its name."""
    yield from _of_lists(loads, "vectors", "", "")
    for k, (name, _) in enumerate(loads.definitions):
        yield ("definitions", k, 1), f"define.{name}", name
    yield from _of_lists(loads, "space", "space.", " of [space]")
    for i in range(len(loads.rotor)):
        yield ("rotor", i), f"rotor[{i}]", f"rotor {i + 1}"
    yield from _of_states(loads)
    yield from _of_hung(loads)
    for k, (name, table) in enumerate(loads.tables):
        for i, time in enumerate(table.times):
            key = f"tables.{name}.values[{i}]"
            yield ("tables", k, 1, "values", i), key, f"{name} at t = {float(time):g}"


def _of_lists(loads: Loads, field: str, table: str, of: str) -> Iterator[tuple[_Path, str, str]]:
    for k, (name, entries) in enumerate(getattr(loads, field)):
        for i in range(len(entries)):
            yield (field, k, 1, i), f"{table}{name}[{i}]", f"{name} {i + 1}{of}"


def _of_states(loads: Loads) -> Iterator[tuple[_Path, str, str]]:
    for k, state in enumerate(loads.states):
        own = "rate" if isinstance(state, Continuous) else "value"
        for field, entries in ((own, state.entries), ("start", state.start or ())):
            for i in range(len(entries)):
                key = f"states.{state.name}.{field}" + (f"[{i}]" if state.is_vector else "")
                yield ("states", k, field, i), key, f"{field} of {state.components[i]}"


def _of_hung(loads: Loads) -> Iterator[tuple[_Path, str, str]]:
    for k in range(len(loads.hung)):
        for i in range(3):
            key = f"{HANGING[k]}.force[{i}]"
            yield ("hung", k, "force", i), key, f"force {i + 1} fixed in space"
        for i in range(3):
            name = f"component {i + 1} of the point of {HANGING[k]}"
            yield ("hung", k, "at", i), f"{HANGING[k]}.at[{i}]", name


def decimal(entry: Entry) -> str:
    """Return a number as a decimal if it or its double is one; a name stays."""
    if isinstance(entry, str):
        return entry
    text = str(entry) if entry.denominator == 1 else repr(float(entry))
    return text if entry in (Fraction(text), float(text)) else str(entry)


def each_named(loads: Loads, change: Callable[[str], str]) -> Iterator[tuple[str, Loads]]:
    """Yield loads with a change of a definition by a text, or of a vector of [space], if it is one."""
    for k, (name, entry) in enumerate(loads.definitions):
        text = change(str(entry))
        if rational(entry) is None and text != entry:
            yield name, replace(loads, definitions=with_entry(loads.definitions, k, (name, text)))
    for k, (name, entries) in enumerate(loads.space):
        texts = tuple(map(decimal, entries))
        vector = tuple(map(change, texts))
        if vector != texts:
            yield (
                f"{name} of [space]",
                replace(loads, space=with_entry(loads.space, k, (name, vector))),
            )
