"""The ``[states]`` table of a scene: states of its own, with a rate or with a value that is held."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any, Final, NamedTuple

from taylor_verify.records.faults import shown
from taylor_verify.records.quantities import RESERVED
from taylor_verify.scenes.loads.states import Continuous, Held, State
from taylor_verify.scenes.reading.hints import advice
from taylor_verify.scenes.reading.loads import entry, is_name
from taylor_verify.scenes.reading.table import Table, complete, exact_number

MOST_COMPONENTS: Final = 100
_ZERO: Final = Fraction(0)


def own_states(top: Table) -> tuple[frozenset[str], tuple[State, ...] | None]:
    """Return the names of all states of the scene's own, and the states; None after a fault."""
    table = top.table("states") if top.has("states") else top.empty("states")
    if table is None:
        return frozenset(), None
    names = table.left()
    for name in names:
        if is_name(table, name) and name in RESERVED:
            table.fault("a name that is no quantity of the motion", f"`{name}`", name)
    return frozenset(names), complete([_state(table, name) for name in names])


def _state(table: Table, name: str) -> State | None:
    inner = table.table(name)
    if inner is None:
        return None
    is_held = inner.has("every") or inner.has("value")
    state = _sampled(inner, name) if is_held else _continuous(inner, name)
    inner.close(advice("held" if is_held else "continuous"))
    return state


def _continuous(table: Table, name: str) -> Continuous | None:
    rate, start = _entries(table, "rate", entry), _entries(table, "start", exact_number)
    if rate is None or start is None or not _agree(table, start, rate):
        return None
    return Continuous(name, start.each, rate.each, rate.is_vector)


def _sampled(table: Table, name: str) -> Held | None:
    value = _entries(table, "value", entry)
    every = _right(table, "every", "a positive time from instant to instant", lambda n: n > 0)
    offset = _right(table, "offset", "an offset that is not negative", lambda n: n >= 0, _ZERO)
    start = _entries(table, "start", exact_number) if table.has("start") else None
    if value is None or every is None or offset is None:
        return None
    if start is not None and not _agree(table, start, value):
        return None
    return Held(
        name, None if start is None else start.each, value.each, every, offset, value.is_vector
    )


class _Entries(NamedTuple):
    """The entry, or the entries of an array."""

    each: Any
    is_vector: bool


def _entries(table: Table, key: str, number: Any) -> _Entries | None:
    """Return one entry or an array of some; None after a fault."""
    if not table.is_array(key):
        single = table.number(key, number=number)
        return None if single is None else _Entries((single,), is_vector=False)
    length = len(table.peek(key))
    if not 1 <= length <= MOST_COMPONENTS:
        table.take(key, "an array")
        table.fault(f"from 1 to {MOST_COMPONENTS} entries", str(length), key)
        return None
    entries = table.vector(key, length=length, number=number)
    return None if entries is None else _Entries(entries, is_vector=True)


def _agree(table: Table, start: _Entries, entries: _Entries) -> bool:
    """Return True if the start has the shape of the rate or value."""
    are_alike = len(start.each) == len(entries.each) and start.is_vector is entries.is_vector
    if not are_alike:
        expected = f"an array of {len(entries.each)} numbers" if entries.is_vector else "one number"
        got = shown(list(start.each) if start.is_vector else start.each[0])
        table.fault(expected, got, "start")
    return are_alike


def _right(
    table: Table,
    key: str,
    expected: str,
    is_right: Callable[[Fraction], bool],
    default: Fraction | None = None,
) -> Fraction | None:
    """Return a number that is right; None after a fault."""
    number = table.number(key, default=default)
    if number is None or is_right(number):
        return number
    table.fault(expected, shown(number), key)
    return None
