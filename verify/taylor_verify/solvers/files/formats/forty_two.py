"""42's reports (.42): a quantity in each file, a row for each time, and no header.

`time.42` has the times, `qbn.42` the attitude with its scalar last, `wbn.42` the angular velocity in body
axes: Source/42report.c, Include/42types.h. The files of one folder are read together.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Final

from taylor_verify.records.faults import cut, refusal
from taylor_verify.records.regular_file import regular_file
from taylor_verify.solvers.files.formats import delimited
from taylor_verify.solvers.files.formats.column import BYTES, Column, Table
from taylor_verify.solvers.files.formats.content import Content

_TIME: Final = "time"
_OMEGA: Final = ("w1", "w2", "w3")
_QUATERNION: Final = ("q1", "q2", "q3", "q0")
_COLUMNS: Final = {
    _TIME: ("t",),
    **dict.fromkeys(("qbn", "qn"), _QUATERNION),
    **dict.fromkeys(("wbn", "wn"), _OMEGA),
}


def read(file: Content, path: Path) -> Table:
    """Return the times, the attitude and the angular velocity of a folder."""
    del file
    if path.stem not in _COLUMNS:
        named = ", ".join(f"{stem}.42" for stem in _COLUMNS)
        raise refusal(f"one of {named}", cut(path.name), path)
    there = [each for stem in _COLUMNS if (each := path.with_stem(stem)).exists()]
    if there[0].stem != _TIME:
        raise refusal("its times in time.42 beside it", "none", path)
    read = [column for each in there for column in _of(each)]
    if len({column.name for column in read}) < len(read):
        raise refusal("one file of each quantity", ", ".join(each.name for each in there), path)
    names = " ".join(f"`{each.name}`" for each in there)
    return Table(read, (f"{names} read together, the scalar of q last, the habit of 42",))


def _of(path: Path) -> Iterator[Column]:
    names = _COLUMNS[path.stem]
    with regular_file(path, "a report of 42", BYTES) as opened:
        content = Content(opened, path)
        columns = delimited.read(content, path).columns
    if len(columns) != len(names):
        raise refusal(f"{len(names)} numbers in a line", str(len(columns)), path)
    yield from (Column(name, column.values) for name, column in zip(names, columns, strict=True))
