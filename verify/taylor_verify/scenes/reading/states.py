"""The ``[states]`` table of a scene: states of its own, with a rate or with a value that is held."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any, Final, NamedTuple, cast

from taylor_verify.numbers.tensors import Vector
from taylor_verify.records.faults import shown
from taylor_verify.records.quantities import RESERVED
from taylor_verify.scenes.loads.states import Continuous, Held, State
from taylor_verify.scenes.reading.hints import advice
from taylor_verify.scenes.reading.loads import ENTRY, is_name
from taylor_verify.scenes.reading.table import Number, Table, complete, exact_number

MOST_COMPONENTS: Final = 100
_ZERO: Final = Fraction(0)
_START: Final = Number(exact_number, _ZERO)


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
    rate, start = _entries(table, "rate", ENTRY), _entries(table, "start", _START)
    if rate is None:
        return None
    return Continuous(name, _start(table, start, rate), rate.each, rate.is_vector)


def _sampled(table: Table, name: str) -> Held | None:
    value = _entries(table, "value", ENTRY)
    every = _right(table, "every", "a positive time from instant to instant", lambda n: n > 0)
    offset = _right(table, "offset", "an offset that is not negative", lambda n: n >= 0, _ZERO)
    has_start = table.has("start")
    start = _entries(table, "start", _START) if has_start else None
    if value is None:
        return None
    # Where the first instant is not known, no start is missed either.
    needs_none = not has_start and offset is not None
    first = None if needs_none else _start(table, start, value)
    return Held(name, first, value.each, every or Fraction(1), offset or _ZERO, value.is_vector)


class _Entries(NamedTuple):
    """The entry, or the entries of an array."""

    each: Any
    is_vector: bool


def _entries(table: Table, key: str, reader: Number) -> _Entries | None:
    """Return one entry or an array of some; None after a fault."""
    if not table.is_array(key):
        single = table.number(key, reader=reader)
        return None if single is None else _Entries((single,), is_vector=False)
    length = len(table.peek(key))
    if not 1 <= length <= MOST_COMPONENTS:
        table.take(key, "an array")
        table.fault(f"from 1 to {MOST_COMPONENTS} entries", str(length), key)
        return None
    entries = table.vector(key, length=length, reader=reader)
    return None if entries is None else _Entries(entries, is_vector=True)


def _start(table: Table, start: _Entries | None, entries: _Entries) -> Vector:
    """Return the start, which has the shape of the rate or value; zeros of that shape after a fault."""
    zeros = (_ZERO,) * len(entries.each)
    if start is None:
        return zeros
    if len(start.each) == len(entries.each) and start.is_vector is entries.is_vector:
        return cast("Vector", start.each)
    table.fault(_shape(entries), _shape(start), "start")
    return zeros


def _shape(entries: _Entries) -> str:
    return f"an array of {len(entries.each)}" if entries.is_vector else "one number"


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
