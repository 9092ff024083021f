"""The loads of a scene: texts, forces that hang on the body, and what texts may name.

``[define]`` has numbers and expressions by name, ``[space]`` vectors by their space components, and
``[tables]`` functions of time from data. Nothing in a text is evaluated but by scenes.loads.grammar.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from itertools import chain, pairwise
from pathlib import Path
from typing import Any, Final

from taylor_verify.numbers.tensors import ZERO_VECTOR, Vector
from taylor_verify.records.faults import Faults, shown
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.loads.loads import TAKEN, Entries, Entry, Hung, Loads
from taylor_verify.scenes.loads.steps import NoStep
from taylor_verify.scenes.loads.tables import Kind
from taylor_verify.scenes.loads.tables import Table as Data
from taylor_verify.scenes.reading.measured import columns
from taylor_verify.scenes.reading.table import Table, complete, exact_number, is_numeral, quantity

HANGING: Final = ("weight", "buoyancy")
_NAME: Final = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_WORD: Final = re.compile(r"[^\W\d_]+|[%°]")
_UNITS: Final = frozenset(
    ("deg", "rad", "rpm", "rev", "s", "ms", "min", "h", "m", "mm", "cm", "km", "g", "kg", "N", "mN", "kN",
     "Nm", "mNm", "kNm", "Hz", "%", "°")
)  # fmt: skip
MOST_ROWS: Final = 10_000


def entry(value: object) -> Any:
    """Return a number, or a text that is no number as it is.

    Raises ValueError for anything else, and for a number with a unit.
    """
    if isinstance(value, str) and not is_numeral(value.strip()) and not _has_unit(value):
        return value
    return exact_number(value)


def _has_unit(text: str) -> bool:
    """Return True for a number and a unit, such as "3 N m", which no product without `*` is."""
    parts = quantity(text)
    return parts is not None and set(_WORD.findall(parts[1])) <= _UNITS


def hanging(table: Table) -> tuple[Hung, ...] | None:
    """Return the forces that are constant in space; None after a fault."""
    return complete([_hung(table, name) for name in HANGING if table.has(name)])


def _hung(table: Table, name: str) -> Hung | None:
    inner = table.table(name)
    if inner is None:
        return None
    force, at = inner.vector("force"), inner.vector("at", default=ZERO_VECTOR)
    inner.close()
    return None if force is None or at is None else Hung(force, at)


class Vocabulary:
    """Words that the texts of a scene may use: its tables [define], [space] and [tables]."""

    def __init__(self, top: Table, folder: Path | None) -> None:
        self._folder = folder
        self.is_complete = True
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
            if not _NAME.fullmatch(name):
                table.fault("a name of letters, digits and _", f"`{name[:40]}`", name[:40])
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

    @staticmethod
    def _definition(table: Table, name: str) -> Entry | None:
        return table.number(name, number=entry)

    @staticmethod
    def _direction(table: Table, name: str) -> Entries | None:
        return table.vector(name, number=entry)

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


def loaded(
    body: Body | None, top: Table, folder: Path | None, start: Fraction | None
) -> Body | None:
    """Return the body under its texts, with what these name, from this start; None after a fault."""
    words = Vocabulary(top, folder)
    if body is None:
        return None
    # What no load names is read all the same.
    loads = replace(
        body.loads or Loads(body.MODEL, ()),
        definitions=words.definitions,
        space=words.space,
        tables=words.tables,
        origin=start or Fraction(0),
    )
    if words.is_complete:
        for place, column, expected, got in loads.faults():
            top.faults.add(expected, got, f"{place}, column {column}")
    if top.faults.lines or body.loads is None:
        return body
    try:
        _ = loads.switches
    except NoStep as fault:
        top.fault(fault.expected, fault.got, "body")
        return None
    return body.with_loads(loads)


def texts(
    model: str,
    vectors: Mapping[str, Entries],
    hung: tuple[Hung, ...],
    current: Vector = ZERO_VECTOR,
) -> Loads | None:
    """Return the loads of these vectors; None if all are numbers, nothing hangs and the fluid rests."""
    entries = chain.from_iterable(vectors.values())
    if hung or any(current) or any(isinstance(each, str) for each in entries):
        return Loads(model, tuple(vectors.items()), hung, current=current)
    return None
