"""The head of a table in text: the line that names its columns, and the mark between their cells.

The first line of numbers tells the mark and the number of cells. Of the lines above it that have as many,
comments too, the header is the one with the most known names. A line of units below it belongs to its
names. What stands above the header is no part of the table.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final, NamedTuple

from taylor_verify.solvers.files.columns.column_units import DIMENSION, in_brackets
from taylor_verify.solvers.files.columns.readings import Name
from taylor_verify.solvers.files.formats.column import COLUMNS
from taylor_verify.solvers.files.formats.epochs import is_epoch
from taylor_verify.solvers.values import is_number

# A header stands among the first lines of its file, which have no more characters than this.
MOST_LINES: Final = 100
MOST_CHARACTERS: Final = 2**18
COMMENTS: Final = ("#", "%")
_BLANKS: Final = ""
MARKS: Final = (";", "\t", "|", ",", _BLANKS)
_WIDE_BLANKS: Final = re.compile(r"\s{2,}|\t")
# A name with its unit in brackets, between blanks.
_WITH_UNIT: Final = re.compile(r"[^\s\[(]+(?:\s{0,3}[\[(][^\[\]()]{0,40}[\])])?")
# A cell between blanks; the day of GMAT's dates has blanks in it.
_CELL: Final = re.compile(r"\d{1,2} [A-Za-z]{3} \d{4} \d{1,2}:\S+|\S+")
_OUTSIDE_BRACKETS: Final = re.compile(r",(?![^\[(,]{0,20}[\])])")
_OF_RULES: Final = frozenset("-=+|:_ \t\r\n")
_DECIMAL_COMMA: Final = re.compile(r"[+-]?\d*,\d+(?:[eE][+-]?\d+)?")
_MOSTLY: Final = 0.5


class Line(NamedTuple):
    """A line of a file that is not blank, and its number from 1."""

    number: int
    text: str

    @property
    def is_comment(self) -> bool:
        return is_comment(self.text)

    @property
    def bare(self) -> str:
        """The text without the mark of a comment."""
        return self.text.strip().lstrip("".join(COMMENTS))


@dataclass(frozen=True)
class Head:
    """The names of the columns, the mark between cells, and the number of the first line below.

    ``names`` is empty where nothing names the columns.
    """

    names: tuple[str, ...]
    mark: str
    first: int
    notes: tuple[str, ...] = ()


def rows(lines: Iterable[str], mark: str) -> Iterator[list[str]]:
    """Yield the cells of each line."""
    if mark == _BLANKS:
        return (_apart_by_blanks(line) for line in lines)
    if mark == "|":
        return ([cell.strip() for cell in line.strip().strip("|").split("|")] for line in lines)
    return csv.reader(lines, delimiter=mark)


def _apart_by_blanks(line: str) -> list[str]:
    if '"' not in line:
        return _CELL.findall(line) if ":" in line else line.split()
    return next(csv.reader([line.strip()], delimiter=" ", skipinitialspace=True))


def _cells(text: str, mark: str) -> list[str]:
    return [cell.strip() for cell in next(iter(rows([text.rstrip("\r\n")], mark)), [])]


def is_value(cell: str) -> bool:
    """Return True for a number, with a decimal comma too, and for a time of a calendar or a clock."""
    return is_number(cell) or _DECIMAL_COMMA.fullmatch(cell) is not None or is_epoch(cell)


def is_rule(line: str) -> bool:
    """Return True for a line of dashes, such as stands below a header."""
    return ("--" in line or "==" in line) and _OF_RULES.issuperset(line)


def is_comment(text: str) -> bool:
    """Return True for a line that begins with the mark of a comment."""
    return text.lstrip().startswith(COMMENTS)


def head(lines: Sequence[Line], marks: Sequence[str] = MARKS) -> Head | None:
    """Return the head of a table whose first lines these are; None where there is no line at all."""
    shown = [line for line in lines if not line.is_comment and not is_rule(line.text)]
    if not shown:
        return None
    first = _first_of_numbers(shown, marks)
    if first is None:
        # Nothing but the first line can be the header; faults are found below it.
        mark = next((mark for mark in marks if mark in shown[0].text), _BLANKS)
        return Head(tuple(_cells(shown[0].text, mark)), mark, shown[0].number + 1)
    return _above(first, lines, _mark(first.text, marks) or _BLANKS)


def _first_of_numbers(lines: Sequence[Line], marks: Sequence[str]) -> Line | None:
    """Return the first line of numbers that the line below resembles."""
    for line, below in pairwise((*lines, None)):
        if line is None or (mark := _mark(line.text, marks)) is None:
            continue
        width = len(_cells(line.text, mark))
        if below is None or len(_cells(below.text, mark)) == width:
            return line
    return None


def _mark(text: str, marks: Sequence[str]) -> str | None:
    """Return the mark that makes the most numbers of a line; None if most cells are no numbers."""
    shares = {mark: _share(_cells(text, mark)) for mark in marks if mark in text}
    mark = max(shares, key=lambda mark: shares[mark])
    return mark if shares[mark] > _MOSTLY else None


def _share(cells: Sequence[str]) -> float:
    if len(cells) > COLUMNS.most:
        return 0.0
    texts = [cell for cell in cells if cell]
    return sum(map(is_value, texts)) / max(len(texts), 1)


# The header.


def _above(first: Line, lines: Sequence[Line], mark: str) -> Head:
    row = _cells(first.text, mark)
    above = [line for line in lines if line.number < first.number and not is_rule(line.text)]
    candidates = [(line, names) for line in above if (names := _names(line, mark, row))]
    if not candidates and (plain := [line for line in above if not line.is_comment]):
        # As many names as there are, so that lines of another length are the fault.
        return Head(tuple(_cells(plain[-1].text, mark)), mark, plain[-1].number + 1)
    if not candidates:
        return Head((), mark, first.number)
    # Of lines alike the first that is no comment, or the comment that is nearest to the numbers.
    best = max(_known(names) for _, names in candidates)
    alike = [(line, names) for line, names in candidates if _known(names) == best]
    chosen, cells = next((c for c in alike if not c[0].is_comment), alike[-1])
    notes = [*_passed([line for line in above if line.number < chosen.number])]
    if chosen.is_comment:
        notes.append(f"the columns are named in line {chosen.number}, a comment")
    begin = chosen.number + 1
    below = [line for line in above if line.number >= begin]
    if units := next((u for line in below[:1] if (u := _units(line, mark, len(cells)))), None):
        cells = [_with_unit(*pair) for pair in zip(cells, units, strict=True)]
        begin = below[0].number + 1
        notes.append(f"the units are those of line {below[0].number}")
    return Head(tuple(cells), mark, begin, tuple(notes))


def _passed(lines: Sequence[Line]) -> Iterator[str]:
    """Yield a sentence about the lines above the header that are no comments."""
    numbers = [line.number for line in lines if not line.is_comment]
    if len(numbers) == 1:
        yield f"line {numbers[0]} above the table not read"
    elif numbers:
        yield f"lines {numbers[0]} to {numbers[-1]} above the table not read"


def _names(line: Line, mark: str, row: Sequence[str]) -> list[str]:
    """Return the names in a line, if there are as many as cells in a row of numbers; else none."""
    readings = [_fitting(cells, row) for cells in _ways(line.bare, mark)]
    named = [cells for cells in readings if cells and not any(map(is_value, cells))]
    if line.is_comment:
        named = [cells for cells in named if len(set(cells)) == len(cells)]
    return max(named, key=_known, default=[])


def _ways(text: str, mark: str) -> Iterator[list[str]]:
    """Yield the cells of a header by each mark, that of the rows first."""
    for each in (mark, *(other for other in MARKS if other != mark)):
        yield _cells(text, each)
    yield [cell.strip() for cell in _OUTSIDE_BRACKETS.split(text.strip())]
    yield [cell.strip() for cell in _WIDE_BLANKS.split(text.strip())]
    yield _WITH_UNIT.findall(text)


def _fitting(cells: Sequence[str], row: Sequence[str]) -> list[str]:
    """Return the names of the cells of a row: one may have no name in front, an empty one no end."""
    shorter = row[:-1] if row and not row[-1] else row
    if len(cells) == len(row) and (cells[-1] or row[-1]):
        return list(cells)
    names = cells[:-1] if cells and not cells[-1] else cells
    if len(names) == len(shorter):
        return list(names)
    return ["", *names] if len(names) == len(shorter) - 1 else []


def _known(names: Sequence[str]) -> int:
    return sum(bool(Name.of(name).readings) for name in names)


# Units.


def _units(line: Line, mark: str, width: int) -> list[str] | None:
    """Return the units in a line below the header; None for any other line."""
    for cells in _ways(line.bare, mark):
        units = [cell[1:-1] if cell[:1] + cell[-1:] in ("[]", "()") else cell for cell in cells]
        is_of_numbers = len(cells) != width or any(map(_is_plain_number, cells))
        if not is_of_numbers and any(map(_is_unit, units)):
            return units
    return None


def _is_plain_number(cell: str) -> bool:
    return cell != "1" and is_value(cell)


def _is_unit(text: str) -> bool:
    return text != "-" and any(in_brackets(text, group) for group in DIMENSION)


def _with_unit(name: str, unit: str) -> str:
    return name if unit in ("", "-", "1") or name.endswith(("]", ")")) else f"{name} [{unit}]"
