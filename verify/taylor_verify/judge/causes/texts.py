"""The places at which a scene's loads have a number or a text, and the loads with another one there."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from typing import Any, Final

from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.loads.states import Continuous
from taylor_verify.scenes.loads.vocabulary import Entry

_HANGING: Final = ("weight", "buoyancy")


@dataclass(frozen=True)
class Place:
    """An ``entry`` of a scene, its key, its name in a sentence, and the loads with another entry there."""

    key: str
    name: str
    entry: Entry
    put: Callable[[Entry], Loads]


def places(loads: Loads) -> Iterator[Place]:
    """Yield the places of all numbers and texts: loads, definitions, [space], [tables] and [states]."""
    yield from _of_lists(loads, "vectors", "", "")
    for k, (name, entry) in enumerate(loads.definitions):
        yield Place(f"define.{name}", name, entry, partial(_defined, loads, k))
    yield from _of_lists(loads, "space", "space.", " of [space]")
    for i, entry in enumerate(loads.rotor):
        key, put = f"rotor[{i}]", partial(_in_field, loads, "rotor", i)
        yield Place(key, f"rotor {i + 1}", entry, put)
    yield from _of_states(loads)
    yield from _of_hung(loads)
    for k, (name, table) in enumerate(loads.tables):
        for i, (time, value) in enumerate(zip(table.times, table.values, strict=True)):
            put = partial(_in_table, loads, k, i)
            yield Place(f"tables.{name}.values[{i}]", f"{name} at t = {float(time):g}", value, put)


def with_entry(entries: tuple[Any, ...], k: int, entry: Any) -> tuple[Any, ...]:
    """Return a tuple with another entry at one place."""
    return (*entries[:k], entry, *entries[k + 1 :])


def _of_lists(loads: Loads, field: str, table: str, of: str) -> Iterator[Place]:
    for k, (name, entries) in enumerate(getattr(loads, field)):
        for i, entry in enumerate(entries):
            put = partial(_in_list, loads, field, k, i)
            yield Place(f"{table}{name}[{i}]", f"{name} {i + 1}{of}", entry, put)


def _of_states(loads: Loads) -> Iterator[Place]:
    for k, state in enumerate(loads.states):
        field, noun = (
            ("rate", "rate of") if isinstance(state, Continuous) else ("value", "value of")
        )
        groups: list[tuple[str, str, Any]] = [(field, noun, state.entries)]
        groups.append(("start", "start of", state.start or ()))
        for own, words, entries in groups:
            for i, entry in enumerate(entries):
                place = f"[{i}]" if state.is_vector else ""
                key, put = f"states.{state.name}.{own}{place}", partial(_in_state, loads, k, own, i)
                yield Place(key, f"{words} {state.components[i]}", entry, put)


def _of_hung(loads: Loads) -> Iterator[Place]:
    for k, hung in enumerate(loads.hung):
        for field, words in (
            ("force", "force {} fixed in space"),
            ("at", "component {} of its point"),
        ):
            for i, entry in enumerate(getattr(hung, field)):
                put = partial(_in_hung, loads, k, field, i)
                force = f"({', '.join(f'{float(f):g}' for f in hung.force)})"
                name = words.format(i + 1) + (f", of the force {force}" if field == "at" else "")
                yield Place(f"{_HANGING[k]}.{field}[{i}]", name, entry, put)


def _defined(loads: Loads, k: int, entry: Entry) -> Loads:
    name, _ = loads.definitions[k]
    return replace(loads, definitions=with_entry(loads.definitions, k, (name, entry)))


def _in_field(loads: Loads, field: str, i: int, entry: Entry) -> Loads:
    changes: Any = {field: with_entry(getattr(loads, field), i, entry)}
    return replace(loads, **changes)


def _in_list(loads: Loads, field: str, k: int, i: int, entry: Entry) -> Loads:
    name, entries = getattr(loads, field)[k]
    return _in_field(loads, field, k, (name, with_entry(entries, i, entry)))  # type: ignore[arg-type]


def _in_state(loads: Loads, k: int, field: str, i: int, entry: Entry) -> Loads:
    state: Any = loads.states[k]
    changed = replace(state, **{field: with_entry(getattr(state, field), i, entry)})
    return replace(loads, states=with_entry(loads.states, k, changed))


def _in_hung(loads: Loads, k: int, field: str, i: int, entry: Entry) -> Loads:
    hung = loads.hung[k]
    changes: Any = {field: with_entry(getattr(hung, field), i, Fraction(entry))}
    return replace(loads, hung=with_entry(loads.hung, k, hung._replace(**changes)))


def _in_table(loads: Loads, k: int, i: int, entry: Entry) -> Loads:
    name, table = loads.tables[k]
    values = with_entry(table.values, i, Fraction(entry))
    return replace(loads, tables=with_entry(loads.tables, k, (name, replace(table, values=values))))
