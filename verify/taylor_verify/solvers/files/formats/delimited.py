"""Columns in text: a header line and rows, separated by comma, semicolon, tab or blanks."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from io import TextIOWrapper
from itertools import chain, islice
from pathlib import Path
from typing import Any, BinaryIO, Final

import numpy as np

from taylor_verify.records.faults import Faults, Refused, refusal
from taylor_verify.records.limit import Limit
from taylor_verify.solvers.files.formats.column import (
    ROWS,
    Column,
    Table,
    alike,
    check_size,
    no_utf8,
    refuse_part,
)
from taylor_verify.solvers.values import is_number

_LINE: Final = Limit(2**20, "characters in a line", "a thousand columns of a thousand each")
_ROWS_AT_ONCE: Final = 1000


def read(file: BinaryIO, path: Path, part: str) -> Table:
    """Return the columns; # begins a comment line. The rows are counted before any of them is kept."""
    refuse_part(part, path)
    text = TextIOWrapper(file, encoding="utf-8-sig")
    try:
        for count, _ in enumerate(_Lines(text, path)):
            if count > ROWS.most:
                raise ROWS.refusal("more", path)
        text.seek(0)
        return Table(_columns(_Lines(text, path), path))
    except UnicodeDecodeError:
        file.seek(0)
        raise no_utf8(file.read(2), path) from None
    except csv.Error as error:
        raise refusal("a CSV file", f"a fault in it: {error}", path) from None
    finally:
        text.detach()  # else it would close the file, which is the caller's


class _Lines:
    """The lines that are neither blank nor a comment; ``number`` is that of the last one."""

    def __init__(self, text: TextIOWrapper, path: Path) -> None:
        self._text, self._path, self.number = text, path, 0

    def __iter__(self) -> Iterator[str]:
        while line := self._text.readline(_LINE.most + 1):
            self.number += 1
            if len(line) > _LINE.most:
                raise _LINE.refusal("more", f"{self._path}, line {self.number}")
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
