"""Columns in text: a header line and rows, separated by comma, semicolon, tab or blanks."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from itertools import chain, islice
from pathlib import Path
from typing import Any, Final

import numpy as np

from taylor_verify.records.faults import Faults, Refused, refusal
from taylor_verify.solvers.files.formats.column import (
    ROWS,
    Column,
    Table,
    alike,
    check_size,
    refuse_part,
)
from taylor_verify.solvers.files.formats.content import Content
from taylor_verify.solvers.values import is_number

_ROWS_AT_ONCE: Final = 1000


def read(file: Content, path: Path, part: str) -> Table:
    """Return the columns; # begins a comment line. The rows are counted before any of them is kept."""
    refuse_part(part, path)
    for count, _ in enumerate(_Lines(file)):
        if count > ROWS.most:
            raise ROWS.refusal("more", path)
    try:
        return Table(_columns(_Lines(file), path))
    except csv.Error as error:
        raise refusal("a CSV file", f"a fault in it: {error}", path) from None


class _Lines:
    """The lines that are neither blank nor a comment; ``number`` is that of the last one."""

    def __init__(self, file: Content) -> None:
        self._file, self.number = file, 0

    def __iter__(self) -> Iterator[str]:
        for number, line in enumerate(self._file.lines(), start=1):
            self.number = number
            if line.strip() and not line.lstrip().startswith("#"):
                yield line


def _columns(lines: _Lines, path: Path) -> list[Column]:
    rows = _rows(lines)
    header = [name.strip() for name in next(rows, [])]
    if not header:
        raise refusal("a header line and rows", "an empty file", path)
    if all(is_number(name) for name in header):
        raise refusal("a header line that names the columns", "numbers", f"{path}, line 1")
    faults, count, parts = Faults(), 0, list[Any]()
    with alike(faults, f"{path}, more lines") as ragged:

        def sound() -> Iterator[list[str]]:
            for row in rows:
                if len(row) == len(header):
                    yield row
                else:
                    expected = f"{len(header)} values as in the header"
                    ragged(expected, str(len(row)), f"{path}, line {lines.number}")

        whole = sound()
        while batch := list(islice(whole, _ROWS_AT_ONCE)):
            count += len(batch)
            check_size(len(header), count, path)
            # As a string of Python each text takes 50 bytes more.
            parts.append(np.array(batch, dtype=np.dtypes.StringDType()).T)
    if faults.lines:
        raise Refused(faults.lines)
    empty = np.empty((len(header), 0), dtype=np.dtypes.StringDType())
    columns: Iterator[Any] = map(np.concatenate, zip(empty, *parts, strict=True))
    return [Column(name, column) for name, column in zip(header, columns, strict=True)]


def _rows(lines: _Lines) -> Iterator[list[str]]:
    """Return the cells of each line, by the separator of the first one."""
    remaining = iter(lines)
    first = next(remaining, "")
    separator = next((mark for mark in ",;\t" if mark in first), None)
    every = chain([first] if first else [], remaining)
    return csv.reader(every, delimiter=separator) if separator else (line.split() for line in every)
