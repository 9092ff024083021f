"""The loads of a scene: texts, forces that hang on the body, and what texts may name.

``[define]`` has numbers and expressions by name, ``[space]`` vectors by their space components, and
``[tables]`` functions of time from data. Nothing in a text is evaluated but by scenes.loads.grammar.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

from taylor_verify.numbers.tensors import ZERO_VECTOR, Vector
from taylor_verify.records.faults import Faults, shown
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.loads.grammar import ALL_FUNCTIONS
from taylor_verify.scenes.loads.loads import TAKEN, Entries, Entry, Hung, Loads
from taylor_verify.scenes.loads.states import MOST_INSTANTS, State
from taylor_verify.scenes.loads.steps import NoStep
from taylor_verify.scenes.loads.tables import Kind
from taylor_verify.scenes.loads.tables import Table as Data
from taylor_verify.scenes.loads.vocabulary import INERTIA, NO_DOUBTS, Doubts, names
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.reading.csv_columns import columns
from taylor_verify.scenes.reading.table import (
    Number,
    Table,
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


def _hanging(table: Table) -> tuple[Hung, ...]:
    """Return the forces that are constant in space, but for those with a fault."""
    hung = [_hung(table, name) for name in _HANGING if table.has(name)]
    return tuple(each for each in hung if each is not None)


def _hung(table: Table, name: str) -> Hung | None:
    inner = table.table(name, f"write {name} = {{ force = [0, 0, -2], at = [0, 0, 0] }}")
    if inner is None:
        return None
    force, at = inner.vector("force"), inner.vector("at", default=ZERO_VECTOR)
    inner.close()
    return None if force is None or at is None else Hung(force, at)


class Vocabulary:
    """Words that the texts of a scene may use: [define], [space], [tables], and its states.

    All that could be read is here, so that its texts are examined; ``doubts`` are what could not.
    """

    def __init__(self, top: Table, folder: Path | None, states: Sequence[State]) -> None:
        self._folder = folder
        self.doubts = NO_DOUBTS
        # All names that are made, with their places.
        self._names: list[tuple[str, str]] = []
        self.definitions = self._named(top, "define", self._definition)
        self.space = self._named(top, "space", self._direction)
        self.tables = self._named(top, "tables", self._data)
        self._names += [(f"states.{s.name}", name) for s in states for name in s.components]
        self._check_names(top.faults)

    def _named(
        self, top: Table, key: str, read: Callable[[Table, str], Any]
    ) -> tuple[tuple[str, Any], ...]:
        table = top.table(key) if top.has(key) else top.empty(key)
        if table is None:
            self.doubts |= Doubts(are_names_lost=True, are_values_lost=True)
            return ()
        pairs = []
        for name in table.left():
            made, before = _made_by(key, name), len(top.faults.lines)
            pairs.append((name, read(table, name)))
            if len(top.faults.lines) > before:
                self.doubts |= Doubts(frozenset(made) - TAKEN)
            is_name(table, name)
            self._names += [(f"{key}.{name}", each) for each in made]
        return tuple((name, value) for name, value in pairs if value is not None)

    def _check_names(self, faults: Faults) -> None:
        known: set[str] = set()
        for place, name in self._names:
            # A table is a function of time, and may have the name of one: `log(log)` is clear.
            is_function = name in ALL_FUNCTIONS and not place.startswith("tables.")
            if name in TAKEN or name in known or is_function:
                faults.add("a name that is free", f"`{name}`", place)
            known.add(name)

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


def _made_by(key: str, name: str) -> tuple[str, ...]:
    """Return the names in texts that an entry of a table makes."""
    return tuple(f"{name}{i}" for i in (1, 2, 3)) if key == "space" else (name,)


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


def rigid_loads(table: Table) -> Loads:
    """Return what acts on a rigid body, numbers and texts alike, as far as it could be read."""
    moment = table.vector("moment", default=ZERO_VECTOR, reader=ENTRY)
    rotor = table.vector("rotor", default=ZERO_VECTOR, reader=ENTRY)
    return Loads("euler", (("moment", moment or ()),), _hanging(table), rotor=rotor or ())


def immersed_loads(table: Table) -> Loads:
    """Return what acts on a solid in a fluid, numbers and texts alike, as far as it could be read."""
    force = table.vector("force", default=ZERO_VECTOR, reader=ENTRY)
    couple = table.vector("couple", default=ZERO_VECTOR, reader=ENTRY)
    hung = _hanging(table)
    current = table.vector("current", default=ZERO_VECTOR)
    vectors = (("force", force or ()), ("couple", couple or ()))
    return Loads("kirchhoff", vectors, hung, current=current or ZERO_VECTOR)


def loaded(
    body: Body | None,
    loads: Loads,
    doubts: Doubts,
    top: Table,
    folder: Path | None,
    time: Clock | None,
) -> Body | None:
    """Return the body under its texts, with what these name; None after a fault.

    ``loads`` are what was read of them, also where there is no body. Texts are examined all the same, but
    for what depends on a fault: ``doubts`` are those that the scene has so far.
    """
    words = Vocabulary(top, folder, loads.states)
    last = Fraction(0) if time is None else time.elapsed[-1]
    loads = replace(
        (body.loads if body is not None else None) or loads,
        inertia=None if body is None else body.parts().get("inertia"),
        definitions=words.definitions,
        space=words.space,
        tables=words.tables,
        origin=Fraction(0) if time is None else time.start,
        reach=(min(last, Fraction(0)), max(last, Fraction(0))),
    )
    if body is None:
        doubts |= Doubts(frozenset(INERTIA) & names(loads.model))
    doubts |= words.doubts
    for place, column, expected, got in (*loads.faults(doubts), *loads.faults_of_space(doubts)):
        where = f"{place}, column {column}" if column else place
        top.faults.add(expected, got, where)
    if time is not None:
        _check_instants(loads, top, time)
    if not top.faults.lines:
        _check_switches(loads, top)
    if top.faults.lines or body is None or body.loads is None:
        return body
    return body.with_loads(loads)


def _check_switches(loads: Loads, top: Table) -> None:
    """Note a fault if the switches of the loads cannot be listed."""
    try:
        _ = loads.switches
    except NoStep as fault:
        top.fault(fault.expected, fault.got, "body")


def _check_instants(loads: Loads, top: Table, time: Clock) -> None:
    """Note a fault if the held states cannot be taken at all their instants."""
    if loads.held_values and time.elapsed[-1] < 0:
        top.fault("an end after the start, as held states run forward", "one before it", "time")
        return
    try:
        loads.instants(time.elapsed[-1])
    except ValueError:
        top.fault(f"at most {MOST_INSTANTS} instants of held states", "more", "states")
