"""Columns in text: a line that names them and rows, separated by comma, semicolon, tab, bar or blanks."""

from __future__ import annotations

import csv
import re
from collections import deque
from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path
from typing import Any, Final

import numpy as np

from taylor_verify.records.faults import Faults, refusal
from taylor_verify.solvers.files.formats.column import (
    ROWS,
    Column,
    Ragged,
    Table,
    alike,
    check_size,
)
from taylor_verify.solvers.files.formats.content import Content
from taylor_verify.solvers.files.formats.header import (
    MARKS,
    MOST_CHARACTERS,
    MOST_LINES,
    Head,
    Line,
    head,
    is_comment,
    is_rule,
    rows,
)

_ROWS_AT_ONCE: Final = 1000
_DECIMAL_COMMA: Final = re.compile(r"\s*[+-]?\d*(?:,\d+)?(?:[eE][+-]?\d+)?\s*")


def read(file: Content, path: Path, first: int = 1, marks: Sequence[str] = MARKS) -> Table:
    """Return the columns of the table from the ``first`` line on; # and % begin a comment line."""
    try:
        top = head(_first_lines(file, first), marks)
        if top is None:
            raise refusal("a header line and rows", "an empty file", path)
        names, columns, faults = _columns(file, top, path)
    except csv.Error as error:
        raise refusal("a CSV file", f"a fault in it: {error}", path) from None
    columns, notes = _with_points(names, columns, top)
    table = Table(list(map(Column, names, columns)), (*top.notes, *notes))
    if faults:
        raise Ragged(faults, table)
    return table


def _lines(file: Content, first: int = 1, with_comments: bool = False) -> Iterator[Line]:
    """Yield the lines that are not blank, from the ``first`` one on."""
    for number, text in enumerate(file.lines(), start=1):
        if number >= first and text.strip() and (with_comments or not is_comment(text)):
            yield Line(number, text)


def _first_lines(file: Content, first: int) -> list[Line]:
    """Return the lines among which the header stands: the first ones, and the last comments before."""
    comments, others, size = deque[Line](maxlen=MOST_LINES), list[Line](), 0
    for line in _lines(file, first, with_comments=True):
        if line.is_comment and len(line.text) < MOST_CHARACTERS:
            comments.append(line)
        elif not line.is_comment:
            others.append(line)
            size += len(line.text)
        if len(others) == MOST_LINES or (len(others) > 1 and size > MOST_CHARACTERS):
            break
    return sorted([*comments, *others])


def _numbered_rows(file: Content, top: Head) -> Iterator[tuple[int, list[str]]]:
    """Yield the cells of each row below the head, and the number of its last line."""
    number = 0

    def texts() -> Iterator[str]:
        nonlocal number
        for line in _lines(file, top.first):
            number = line.number
            if not is_rule(line.text):
                yield line.text

    for cells in rows(texts(), top.mark):
        yield number, cells


def _columns(file: Content, top: Head, path: Path) -> tuple[list[str], list[Any], list[str]]:
    """Return the names of the columns, a number where there is none, the texts of each, and faults.

    A row that is too long is cut, and one that is too short has NaN at its end.
    """
    width = len(top.names) or len(next(_numbered_rows(file, top))[1])
    faults, count, parts = Faults(), 0, list[Any]()
    with alike(faults, f"{path}, more lines") as ragged:

        def of_one_length() -> Iterator[list[str]]:
            for number, row in _numbered_rows(file, top):
                if not any(row) or not any(map(str.strip, row)):
                    # Spreadsheets end in rows of nothing.
                    continue
                if len(row) == width + 1 and not row[-1].strip():
                    row.pop()
                if len(row) != width:
                    of = "in the header" if top.names else "in the first row"
                    ragged(f"{width} values as {of}", str(len(row)), f"{path}, line {number}")
                yield row[:width] + ["nan"] * (width - len(row))

        whole = of_one_length()
        while batch := list(islice(whole, _ROWS_AT_ONCE)):
            count += len(batch)
            if count > ROWS.most:
                raise ROWS.refusal("more", path)
            check_size(width, count, path)
            # As a string of Python each text takes 50 bytes more.
            parts.append(np.array(batch, dtype=np.dtypes.StringDType()).T)
    empty = np.empty((width, 0), dtype=np.dtypes.StringDType())
    columns = [*map(np.concatenate, zip(empty, *parts, strict=True))]
    return _numbered(top.names, width), columns, faults.lines


def _numbered(names: Sequence[str], width: int) -> list[str]:
    """Return the names; a column without one has its number from 1."""
    numbers = range(1, width + 1)
    if not names:
        return [str(k) for k in numbers]
    return [name or f"column {k}" for k, name in zip(numbers, names, strict=True)]


def _with_points(
    names: Sequence[str], columns: Sequence[Any], top: Head
) -> tuple[list[Any], list[str]]:
    """Return the columns with decimal points, and a note where decimal commas were written."""
    read, changed = [], []
    for name, column in zip(names, columns, strict=True):
        has_commas = top.mark != "," and bool((np.strings.find(column, ",") >= 0).any())
        if has_commas and all(map(_DECIMAL_COMMA.fullmatch, column.tolist())):
            column = np.strings.replace(column, ",", ".")
            changed.append(name)
        read.append(column)
    return read, [f"decimal commas are read in {' '.join(changed)}"] if changed else []
