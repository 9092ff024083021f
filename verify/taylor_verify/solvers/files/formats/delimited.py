"""Columns in text: a header line and rows, separated by comma, semicolon, tab or blanks."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from io import TextIOWrapper
from pathlib import Path
from typing import Any, BinaryIO, Final

import numpy as np

from taylor_verify.scenes.reading.faults import Faults, Refused
from taylor_verify.scenes.reading.limit import Limit
from taylor_verify.solvers.files.formats.column import (
    MOST_ALIKE,
    ROWS,
    Column,
    add_more_alike,
    check_size,
    no_utf8,
)
from taylor_verify.solvers.values import is_number

_LINE: Final = Limit(2**20, "characters in a line", "a thousand columns of a thousand each")


def read(file: BinaryIO, path: Path) -> list[Column]:
    """Return the columns; # begins a comment line. The rows are counted before any of them is kept."""
    text = TextIOWrapper(file, encoding="utf-8-sig")
    try:
        _check_count(text, path)
        text.seek(0)
        return _columns(_Lines(text, path), path)
    except UnicodeDecodeError:
        file.seek(0)
        raise no_utf8(file.read(2), path) from None
    except csv.Error as error:
        raise Refused([f"expected a CSV file, got a fault in it: {error} @ {path}"]) from None
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


def _check_count(text: TextIOWrapper, path: Path) -> None:
    for count, _ in enumerate(_Lines(text, path)):
        if count > ROWS.most:
            raise ROWS.refusal("more", path)


def _columns(lines: _Lines, path: Path) -> list[Column]:
    rows = _rows(lines)
    header = [name.strip() for name in next(rows, [])]
    if not header:
        raise Refused([f"expected a header line and rows, got an empty file @ {path}"])
    if all(is_number(name) for name in header):
        raise Refused(
            [f"expected a header line that names the columns, got numbers @ {path}, line 1"]
        )
    cells: list[list[str]] = [[] for _ in header]
    packed: list[list[Any]] = [[] for _ in header]
    faults, ragged = Faults(), 0
    for count, row in enumerate(rows, start=1):
        if count % 1000 == 1:
            check_size(len(header), count, path)
            _pack(cells, packed)
        if len(row) == len(header):
            for column, cell in zip(cells, row, strict=True):
                column.append(cell)
            continue
        ragged += 1
        if ragged <= MOST_ALIKE:
            expected = f"{len(header)} values as in the header"
            faults.add(expected, str(len(row)), f"{path}, line {lines.number}")
    add_more_alike(faults, ragged, f"{path}, more lines")
    if faults.lines:
        raise Refused(faults.lines)
    _pack(cells, packed)
    columns: list[Any] = [np.concatenate(parts) for parts in packed]
    return [Column(name, column) for name, column in zip(header, columns, strict=True)]


def _pack(cells: list[list[str]], packed: list[list[Any]]) -> None:
    """Put the texts away in arrays: as a string of Python each takes 50 bytes more."""
    for column, parts in zip(cells, packed, strict=True):
        parts.append(np.array(column, dtype=np.dtypes.StringDType()))
        column.clear()


def _rows(lines: _Lines) -> Iterator[list[str]]:
    """The cells of each line, by the separator of the first one."""
    each = iter(lines)
    first = next(each, None)
    if first is None:
        return
    separator = next((mark for mark in ",;\t" if mark in first), None)
    if separator is None:
        yield first.split()
        yield from (line.split() for line in each)
        return
    yield from csv.reader(_behind(first, each), delimiter=separator)


def _behind(first: str, rest: Iterator[str]) -> Iterator[str]:
    yield first
    yield from rest
