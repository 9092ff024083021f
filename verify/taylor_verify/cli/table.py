"""A table that loses no character at any width: columns that do not fit go into a part below."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from rich.cells import cell_len
from rich.console import Console
from rich.table import Table
from rich.text import Text

from taylor_verify.scenes.names import escaped

Cell = str | Text

# The blanks between two columns, one where this makes room for all.
_GAP = 2
# A key that has to be folded is not folded into less.
_NARROWEST_KEY = 8


def print_table(
    console: Console, headings: Sequence[str], rows: Sequence[Sequence[Cell]], keys: int
) -> None:
    """Print a table in the width of the console; the first ``keys`` columns begin each of its parts.

    A column whose heading begins with ``>`` stands to the right. The first column may hold cells of any
    length, such as paths, and is folded. No other cell is.
    """
    cells = [[cell if isinstance(cell, Text) else Text(escaped(cell)) for cell in r] for r in rows]
    columns = zip(*cells, strict=True) if cells else ([] for _ in headings)
    widths = [
        max(cell_len(heading.removeprefix(">")), *(cell.cell_len for cell in column), 0)
        for heading, column in zip(headings, columns, strict=True)
    ]
    gap = _GAP if sum(widths) + _GAP * (len(widths) - 1) <= console.width else 1
    widest = max(widths[keys:], default=0)
    room = console.width - sum(width + gap for width in widths[1:keys]) - gap - widest
    widths[0] = min(widths[0], max(room, _NARROWEST_KEY))
    for number, part in enumerate(_parts(widths, keys, gap, console.width)):
        table = Table(box=None, padding=(0, gap, 0, 0), pad_edge=False)
        for i in part:
            table.add_column(
                headings[i].removeprefix(">"),
                justify="right" if headings[i].startswith(">") else "left",
                width=widths[i],
                no_wrap=i > 0,
                overflow="fold",
            )
        for row in cells:
            table.add_row(*(row[i] for i in part))
        if number:
            console.print()
        console.print(table)


def _parts(widths: Sequence[int], keys: int, gap: int, room: int) -> Iterator[list[int]]:
    """Return the columns of each part, the keys first."""
    begin = list(range(keys))
    part = begin
    for i in range(keys, len(widths)):
        used = sum(widths[k] + gap for k in part)
        if len(part) > keys and used + widths[i] > room:
            yield part
            part = begin
        part = [*part, i]
    yield part
