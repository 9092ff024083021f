"""The ``[states]`` table of a scene: states of its own, with a rate or with a value that is held."""

from __future__ import annotations

from fractions import Fraction
from typing import Any, Final, NamedTuple, cast

from taylor_verify.numbers.tensors import Vector
from taylor_verify.records.quantities import RESERVED
from taylor_verify.scenes.loads.states import Continuous, Held, State
from taylor_verify.scenes.loads.vocabulary import TAKEN, Doubts
from taylor_verify.scenes.reading.hints import advice
from taylor_verify.scenes.reading.loads import ENTRY, is_name
from taylor_verify.scenes.reading.table import LARGEST_EXPONENT, Number, Table, exact_number, right

MOST_COMPONENTS: Final = 100
_ZERO: Final = Fraction(0)
# An interval with a fault stands as this one, so that its instants are not too many.
_NEVER: Final = Fraction(10**LARGEST_EXPONENT)
_START: Final = Number(exact_number, _ZERO)
_EVERY: Final = right("a positive time from instant to instant", lambda number: number > 0)
_OFFSET: Final = right("an offset that is not negative", lambda number: number >= 0)


class OwnStates(NamedTuple):
    """The names of all states of a scene's own, and the states that could be read.

    ``faulty`` are the names of those that have faults, read or not. ``is_table`` is False where [states] is
    no table, so that no name is known.
    """

    names: frozenset[str]
    states: tuple[State, ...]
    faulty: frozenset[str] = frozenset()
    is_table: bool = True

    @property
    def doubts(self) -> Doubts:
        """Names that states with faults may lend to texts: the number of their components is open."""
        numbers = ("", *range(1, MOST_COMPONENTS + 1))
        names = frozenset(f"{name}{number}" for name in self.faulty for number in numbers)
        known = TAKEN.union(*(state.components for state in self.states))
        return Doubts(names - known, not self.is_table, len(self.states) < len(self.names))


def own_states(top: Table) -> OwnStates:
    """Return the states of the scene's own, as far as they could be read."""
    table = top.table("states") if top.has("states") else top.empty("states")
    if table is None:
        # Whatever is tracked may be a state.
        tracked = (word for word in top.peek("track") if isinstance(word, str))
        return OwnStates(frozenset(tracked), (), frozenset(), is_table=False)
    names = table.left()
    for name in names:
        if is_name(table, name) and name in RESERVED:
            table.fault("a name that is no quantity of the motion", f"`{name}`", name)
    states, faulty = [], set()
    for name in names:
        before = len(top.faults.lines)
        state = _state(table, name)
        if len(top.faults.lines) > before:
            faulty.add(name)
        states.append(state)
    read = tuple(state for state in states if state is not None)
    return OwnStates(frozenset(names), read, frozenset(faulty))


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
    every = table.number("every", reader=_EVERY)
    offset = table.number("offset", default=_ZERO, reader=_OFFSET)
    has_start = table.has("start")
    start = _entries(table, "start", _START) if has_start else None
    if value is None:
        return None
    # Where the first instant is not known, no start is missed either.
    needs_none = not has_start and offset is not None
    first = None if needs_none else _start(table, start, value)
    return Held(name, first, value.each, every or _NEVER, offset or _ZERO, value.is_vector)


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
