"""A table that loses no character at any width: columns that do not fit go into a part below."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from rich.console import Console
from rich.table import Table
from rich.text import Text

from taylor_verify.scenes.names import escaped

Cell = str | Text

# The blanks between two columns, one where this makes room for all.
_GAP = 2
# A key that has to be folded is not folded into less.
_NARROWEST_KEY = 8


class Heading(NamedTuple):
    """The name of a column; numbers stand to the right."""

    name: str
    to_right: bool = False


def print_table(
    console: Console,
    headings: Sequence[Heading],
    rows: Sequence[Sequence[Cell]],
    keys: int,
) -> None:
    """Print a table in the width of the console; the first ``keys`` columns begin each of its parts.

    The first column may hold cells of any length, such as paths, and is folded. No other cell is.
    """
    cells = [[cell if isinstance(cell, Text) else Text(escaped(cell)) for cell in r] for r in rows]
    widths = [
        max(Text(heading.name).cell_len, *(row[i].cell_len for row in cells), 0)
        for i, heading in enumerate(headings)
    ]
    gap = _GAP if sum(widths) + _GAP * (len(widths) - 1) <= console.width else 1
    widest = max(widths[keys:], default=0)
    room = console.width - sum(width + gap for width in widths[1:keys]) - gap - widest
    widths[0] = min(widths[0], max(room, _NARROWEST_KEY))
    for i, part in enumerate(_parts(widths, keys, gap, console.width)):
        if i:
            console.print()
        console.print(_part(part, headings, cells, widths, gap))


def _parts(widths: Sequence[int], keys: int, gap: int, room: int) -> Iterator[list[int]]:
    """Return the columns of each part, the keys first."""
    begin = list(range(keys))
    part, used = list(begin), sum(widths[i] for i in begin) + gap * (keys - 1)
    for i in range(keys, len(widths)):
        if len(part) > keys and used + gap + widths[i] > room:
            yield part
            part, used = list(begin), sum(widths[k] for k in begin) + gap * (keys - 1)
        part.append(i)
        used += gap + widths[i]
    yield part


def _part(
    columns: Sequence[int],
    headings: Sequence[Heading],
    cells: Sequence[Sequence[Text]],
    widths: Sequence[int],
    gap: int,
) -> Table:
    table = Table(box=None, padding=(0, gap, 0, 0), pad_edge=False)
    for i in columns:
        table.add_column(
            headings[i].name,
            justify="right" if headings[i].to_right else "left",
            width=widths[i],
            no_wrap=i > 0,
            overflow="fold",
        )
    for row in cells:
        table.add_row(*(row[i] for i in columns))
    return table
