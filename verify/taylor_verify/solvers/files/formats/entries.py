"""Columns of the entries of objects, one object a row.

protobuf leaves fields that are zero out of its JSON. A field that an object lacks is zero where others
beside it are there: the fields of the same inner object, or components of the same vector. A vector of
which nothing is there has no row.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any, Final, NamedTuple

from taylor_verify.records.faults import cut, refusal
from taylor_verify.records.limit import Limit
from taylor_verify.solvers.files.columns.readings import Name
from taylor_verify.solvers.files.formats.column import Column, Table, check_size, listed

_DEEPEST: Final = 10
_COMPONENT: Final = re.compile(r"(.*\D)?(?:[0-9]+|[wxyz])")
_NOTHING: Final = ""
_SHAPES: Final = Limit(1000, "different sets of fields", "messages of one type have some tens")


class Shape(NamedTuple):
    """The paths of the numbers of an object, those of its inner objects, and the names of its vectors."""

    names: frozenset[str]
    inner: frozenset[str]
    vectors: frozenset[str]

    def lacks_zero(self, name: str) -> bool:
        """Return True if an object without this field has left it out because it is zero."""
        parent = name.rpartition(".")[0]
        if name in self.names or name.endswith("]"):
            return False
        if parent:
            return parent in self.inner
        stem = _stem(name)
        return stem in self.vectors if stem else Name.of(name).is_time


@dataclass
class Entries:
    """The numbers in an object by their paths, ``imu.omega[0]``, and the paths of its inner objects."""

    values: dict[str, Any] = field(default_factory=dict)
    inner: set[str] = field(default_factory=set)

    @classmethod
    def of(cls, value: Any, name: str = "") -> Entries:
        """Return the entries of an object, or of a value with this name."""
        entries = cls()
        entries._take(value, name, 0)
        return entries

    def _take(self, value: Any, name: str, depth: int) -> None:
        if isinstance(value, dict | list) and depth == _DEEPEST:
            return
        if isinstance(value, dict):
            self.inner.add(name)
            for key, each in value.items():
                self._take(each, f"{name}.{key}" if name else str(key), depth + 1)
        elif isinstance(value, list):
            for index, each in enumerate(value):
                self._take(each, f"{name}[{index}]", depth + 1)
        else:
            self.values[name] = value

    @property
    def shape(self) -> Shape:
        """The paths of what is there."""
        vectors = frozenset(filter(None, map(_stem, self.values)))
        return Shape(frozenset(self.values), frozenset(self.inner), vectors)


def table(rows: Iterable[Entries], path: Path) -> Table:
    """Return a column for each path in any of the objects, and a note on fields that were left out."""
    columns: dict[str, list[Any]] = {}
    shapes: dict[Shape, Shape] = {}
    of_rows: list[Shape] = []
    for count, row in enumerate(rows):
        check_size(max(len(columns), 1), count + 1, path)
        for name, value in row.values.items():
            columns.setdefault(name, [_NOTHING] * count).append(
                _NOTHING if value is None else value
            )
        for name, values in columns.items() if len(row.values) < len(columns) else ():
            if name not in row.values:
                values.append(_NOTHING)
        shape = row.shape
        of_rows.append(shapes.setdefault(shape, shape))
        _SHAPES.check(len(shapes), path)
    if not columns:
        raise refusal('objects {"t": ..., "w1": ...}', "none with a number", path)
    zero = [name for name in columns if _fill(columns[name], name, of_rows, shapes)]
    named = listed([f"`{cut(name)}`" for name in zero])
    notes = (f"read as 0 where it is left out: {named}",) if zero else ()
    return Table([Column(name, values) for name, values in columns.items()], notes)


def _fill(values: list[Any], name: str, of_rows: Sequence[Shape], shapes: Iterable[Shape]) -> bool:
    """Write a zero where a field was left out because it is one; return True if it was anywhere."""
    lacking = {shape for shape in shapes if shape.lacks_zero(name)}
    for k, shape in enumerate(of_rows) if lacking else ():
        if shape in lacking:
            values[k] = "0"
    return bool(lacking)


@lru_cache(4096)
def _stem(name: str) -> str:
    """Return the name of a vector without its component; empty for what is no component."""
    match = _COMPONENT.fullmatch(name)
    return (match[1] or "") if match else ""
