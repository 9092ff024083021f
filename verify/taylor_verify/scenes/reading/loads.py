"""The loads of a scene: texts, forces that hang on the body, and what texts may name.

``[define]`` has numbers and expressions by name, ``[space]`` vectors by their space components, and
``[tables]`` functions of time from data. Nothing in a text is evaluated but by scenes.loads.grammar.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

from taylor_verify.numbers.tensors import ZERO_VECTOR, Vector
from taylor_verify.records.faults import Faults, shown
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.loads.loads import TAKEN, Entries, Entry, Hung, Loads
from taylor_verify.scenes.loads.states import MOST_INSTANTS, State
from taylor_verify.scenes.loads.steps import NoStep
from taylor_verify.scenes.loads.tables import Kind
from taylor_verify.scenes.loads.tables import Table as Data
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.reading.csv_columns import columns
from taylor_verify.scenes.reading.table import (
    Number,
    Table,
    complete,
    exact_number,
    is_numeral,
    quantity,
)

_HANGING: Final = ("weight", "buoyancy")
_NAME: Final = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_WORD: Final = re.compile(r"[^\W\d_]+|[%°]")
_UNITS: Final = frozenset(
    ("deg", "rad", "rpm", "rev", "s", "ms", "min", "h", "m", "mm", "cm", "km", "g", "kg", "N", "mN", "kN",
     "Nm", "mNm", "kNm", "Hz", "%", "°")
)  # fmt: skip
MOST_ROWS: Final = 10_000


def _entry(value: object) -> Any:
    """Return a number, or a text that is no number as it is.

    Raises ValueError for anything else, and for a number with a unit.
    """
    if isinstance(value, str) and not is_numeral(value.strip()) and not _has_unit(value):
        return value
    return exact_number(value)


# A faulty entry stands as 1, which divides, has a root and a logarithm, and is a whole power.
ENTRY: Final = Number(_entry, Fraction(1))


def _has_unit(text: str) -> bool:
    """Return True for a number and a unit, such as "3 N m", which no product without `*` is."""
    parts = quantity(text)
    return parts is not None and set(_WORD.findall(parts[1])) <= _UNITS


def is_name(table: Table, name: str) -> bool:
    """Return True if a key of a table may be a name in texts; else the reason is a fault."""
    if _NAME.fullmatch(name):
        return True
    table.fault("a name of letters, digits and _", f"`{name[:40]}`", name[:40])
    return False


def _hanging(table: Table) -> tuple[Hung, ...] | None:
    """Return the forces that are constant in space; None after a fault."""
    return complete([_hung(table, name) for name in _HANGING if table.has(name)])


def _hung(table: Table, name: str) -> Hung | None:
    inner = table.table(name, f"write {name} = {{ force = [0, 0, -2], at = [0, 0, 0] }}")
    if inner is None:
        return None
    force, at = inner.vector("force"), inner.vector("at", default=ZERO_VECTOR)
    inner.close()
    return None if force is None or at is None else Hung(force, at)


class Vocabulary:
    """Words that the texts of a scene may use: [define], [space], [tables], and its states."""

    def __init__(self, top: Table, folder: Path | None, states: Sequence[State] | None) -> None:
        self._folder, self._states = folder, states or ()
        self.is_complete = states is not None
        self.definitions = self._named(top, "define", self._definition)
        self.space = self._named(top, "space", self._direction)
        self.tables = self._named(top, "tables", self._data)
        self._check_names(top.faults)

    def _named(
        self, top: Table, key: str, read: Callable[[Table, str], Any]
    ) -> tuple[tuple[str, Any], ...]:
        table = top.table(key) if top.has(key) else None
        if table is None:
            return ()
        pairs = [(name, read(table, name)) for name in table.left()]
        for name, _ in pairs:
            is_name(table, name)
        known = tuple((name, value) for name, value in pairs if value is not None)
        self.is_complete &= len(known) == len(pairs)
        return known

    def _check_names(self, faults: Faults) -> None:
        known: set[str] = set()
        for place, name in self._names():
            if name in TAKEN or name in known:
                faults.add("a name that is free", f"`{name}`", place)
            known.add(name)

    def _names(self) -> Iterator[tuple[str, str]]:
        """Yield all names that the tables make, with their places."""
        for name, _ in self.definitions:
            yield f"define.{name}", name
        for name, _ in self.tables:
            yield f"tables.{name}", name
        for name, _ in self.space:
            yield from ((f"space.{name}", f"{name}{i}") for i in (1, 2, 3))
        for state in self._states:
            yield from ((f"states.{state.name}", name) for name in state.components)

    @staticmethod
    def _definition(table: Table, name: str) -> Entry | None:
        return table.number(name, reader=ENTRY)

    @staticmethod
    def _direction(table: Table, name: str) -> Entries | None:
        return table.vector(name, reader=ENTRY)

    def _data(self, table: Table, name: str) -> Data | None:
        inner = table.table(name)
        if inner is None:
            return None
        kind = _kind(inner)
        read = self._from_file(inner) if inner.has("file") else self._written(inner)
        inner.close()
        if kind is None or read is None:
            return None
        return Data(*read, kind) if _rises(inner, read[0]) else None

    @staticmethod
    def _written(table: Table) -> tuple[Vector, Vector] | None:
        times, values = (table.numbers(key, most=MOST_ROWS) for key in ("times", "values"))
        if times is None or values is None:
            return None
        if len(times) != len(values) or not times:
            table.fault("as many values as times, one at least", f"{len(times)} and {len(values)}")
            return None
        return times, values

    def _from_file(self, table: Table) -> tuple[Vector, Vector] | None:
        names = [table.text(key) for key in ("file", "time", "column")]
        file, time, column = names
        if file is None or time is None or column is None:
            return None
        return columns(table, self._folder, file, time, column, MOST_ROWS)


def _kind(table: Table) -> Kind | None:
    word = table.text("kind", default=Kind.LINEAR.value)
    if word is None:
        return None
    if word not in list(Kind):
        table.fault(f"one of {', '.join(Kind)}", shown(word), "kind")
        return None
    return Kind(word)


def _rises(table: Table, times: Vector) -> bool:
    for k, (time, following) in enumerate(pairwise(times), 1):
        if following <= time:
            table.fault("times that rise", f"{shown(following)} after {shown(time)}", f"times[{k}]")
            return False
    return True


def rigid_loads(table: Table) -> Loads | None:
    """Return what acts on a rigid body, numbers and texts alike; None after a fault."""
    moment = table.vector("moment", default=ZERO_VECTOR, reader=ENTRY)
    rotor = table.vector("rotor", default=ZERO_VECTOR, reader=ENTRY)
    hung = _hanging(table)
    if moment is None or rotor is None or hung is None:
        return None
    return Loads("euler", (("moment", moment),), hung, rotor=rotor)


def immersed_loads(table: Table) -> Loads | None:
    """Return what acts on a solid in a fluid, numbers and texts alike; None after a fault."""
    force = table.vector("force", default=ZERO_VECTOR, reader=ENTRY)
    couple = table.vector("couple", default=ZERO_VECTOR, reader=ENTRY)
    hung = _hanging(table)
    current = table.vector("current", default=ZERO_VECTOR)
    if force is None or couple is None or hung is None or current is None:
        return None
    return Loads("kirchhoff", (("force", force), ("couple", couple)), hung, current=current)


def loaded(
    body: Body | None,
    loads: Loads,
    states: Sequence[State] | None,
    top: Table,
    folder: Path | None,
    time: Clock | None,
) -> Body | None:
    """Return the body under its texts, with what these name; None after a fault.

    ``loads`` are those of a body that has faults: its texts, and what no load names, are read all the same,
    if the names of all ``states`` are known.
    """
    words = Vocabulary(top, folder, states)
    last = Fraction(0) if time is None else time.elapsed[-1]
    loads = replace(
        (body.loads if body is not None else None) or loads,
        definitions=words.definitions,
        space=words.space,
        tables=words.tables,
        origin=Fraction(0) if time is None else time.start,
        reach=(min(last, Fraction(0)), max(last, Fraction(0))),
    )
    if words.is_complete:
        for place, column, expected, got in loads.faults():
            where = f"{place}, column {column}" if column else place
            top.faults.add(expected, got, where)
    if top.faults.lines or body is None or body.loads is None:
        return body
    return body.with_loads(loads) if _fits(loads, top, time) else None


def _fits(loads: Loads, top: Table, time: Clock | None) -> bool:
    """Return True if switches and instants of the loads can be listed; else the reason is a fault."""
    try:
        _ = loads.switches
    except NoStep as fault:
        top.fault(fault.expected, fault.got, "body")
        return False
    if time is None or not loads.held_values:
        return True
    if time.elapsed[-1] < 0:
        top.fault("an end after the start, as held states run forward", "one before it", "time")
        return False
    try:
        loads.instants(time.elapsed[-1])
    except ValueError:
        top.fault(f"at most {MOST_INSTANTS} instants of held states", "more", "states")
        return False
    return True
