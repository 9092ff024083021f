"""OpenSim's tables (.sto, .mot): lines `key=value` down to `endheader`, then columns in text.

The elements of a vector or a quaternion stand in one cell, separated by commas, the scalar first.
"""

from __future__ import annotations

from itertools import islice
from pathlib import Path
from typing import Any, Final

from taylor_verify.records.faults import cut, refusal
from taylor_verify.solvers.files.columns.column_units import DIMENSION, OWN
from taylor_verify.solvers.files.columns.readings import Name
from taylor_verify.solvers.files.formats import delimited
from taylor_verify.solvers.files.formats.column import Column, Table, check_size
from taylor_verify.solvers.files.formats.content import Content

_MOST_LINES: Final = 1000
_MARKS: Final = ("\t", "")
_END: Final = "endheader"
_ELEMENTS: Final = {
    "double": (),
    "vec3": (".x", ".y", ".z"),
    "quaternion": (".qw", ".qx", ".qy", ".qz"),
}


def read(file: Content, path: Path) -> Table:
    """Return the columns; what the header says of rows, columns and degrees is checked."""
    top = [line.strip() for line in islice(file.lines(), _MOST_LINES)]
    below = next((k for k, line in enumerate(top, start=1) if line.lower() == _END), None)
    if below is None:
        raise refusal(f"a line `{_END}`", "none", path)
    stated = {key.strip().lower(): text.strip() for key, _, text in (x.partition("=") for x in top)}
    table = delimited.read(file, path, first=below + 1, marks=_MARKS)
    rows = len(table.columns[0].values) if table.columns else 0
    for key, count, what in (("nrows", rows, "rows"), ("ncolumns", len(table.columns), "columns")):
        if stated.get(key, str(count)) != str(count):
            raise refusal(f"{cut(stated[key])} {what} as the header says", str(count), path)
    elements = _ELEMENTS.get(stated.get("datatype", "double").lower())
    if elements is None:
        expected = f"DataType {', '.join(_ELEMENTS)}"
        raise refusal(expected, cut(stated["datatype"]), path)
    if not elements:
        is_in_degrees = stated.get("indegrees", "no").lower() == "yes"
        return _in_degrees(table) if is_in_degrees else table
    clock, *others = table.columns
    check_size(len(others) * len(elements) + 1, rows, path)
    columns = [column for each in others for column in _apart(each, elements, path)]
    return table._replace(columns=[clock, *columns])


def _in_degrees(table: Table) -> Table:
    """Return the angles and their rates with the unit that the header states of all of them."""
    named = [column._replace(name=column.name + _degrees(column)) for column in table.columns]
    note = "inDegrees=yes: angles are in degrees, rates in degrees a second"
    return Table(named, (*table.notes, note))


def _degrees(column: Column) -> str:
    """Return the unit of an angle or a rate of which the name says no unit; empty for other columns."""
    readings = [reading for reading in Name(column).readings if reading.unit is OWN]
    units = {"angle": " [deg]", "rate": " [deg/s]"}
    return next((units.get(DIMENSION[r.spelling.group], "") for r in readings), "")


def _apart(column: Column, ends: tuple[str, ...], path: Path) -> list[Column]:
    """Return the columns of the elements in the cells of one."""
    rows: list[list[Any]] = []
    for row, cell in enumerate(column.values, start=1):
        cells = str(cell).split(",")
        if len(cells) != len(ends):
            place = f"{path}, row {row}, column {cut(column.name)}"
            raise refusal(f"{len(ends)} numbers between commas", cut(str(cell)), place)
        rows.append(cells)
    return [
        Column(f"{column.name}{end}", [cells[i] for cells in rows]) for i, end in enumerate(ends)
    ]
