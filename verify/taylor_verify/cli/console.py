"""Pages of text for a person: in the width of stdout, with tables that lose no character at any width."""

from __future__ import annotations

import sys
import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, Final

from rich.cells import cell_len
from rich.console import Console, ConsoleOptions, RenderableType
from rich.segment import Segment
from rich.table import Table
from rich.text import Text

from taylor_verify.cli.streams import MANNER
from taylor_verify.records.escapes import escaped, one_line

# Piped output keeps whole rows: a table cut to 80 columns cannot be read by the next program.
PIPED_WIDTH = 140


Cell = str | Text

_STYLES: Final[Mapping[str, dict[str, Any]]] = {
    "always": {"force_terminal": True, "color_system": "standard"},
    "never": {"color_system": None},
}

# The blanks between two columns, one where this makes room for all.
_GAP = 2
# A key that has to be folded is not folded into less.
_NARROWEST_KEY = 8


class EscapingConsole(Console):
    """A console on which no name can steer the terminal: styles are its own, the rest is text."""

    def render(
        self, renderable: RenderableType, options: ConsoleOptions | None = None
    ) -> Iterable[Segment]:
        for segment in super().render(renderable, options):
            is_text = segment.control is None
            yield Segment(escaped(segment.text), segment.style) if is_text else segment


def bold(text: str, colour: str = "") -> Text:
    """Return a text in bold type."""
    return Text(one_line(text), f"bold {colour}".rstrip())


class Page:
    """A text that grows line by line, in the width and colours of stdout.

    It takes no markup: a name may hold brackets or colons.
    """

    def __init__(self, piped_width: int = PIPED_WIDTH) -> None:
        styles = _STYLES.get(MANNER.colour, {})
        self.console = EscapingConsole(markup=False, emoji=False, highlight=False, **styles)
        if not sys.stdout.isatty():
            self.console.width = piped_width
        self.console.begin_capture()

    def line(self, *parts: str | Text) -> None:
        """Print one line; a pipe takes any length."""
        lines = [one_line(part) if isinstance(part, str) else part for part in parts]
        self.console.print(Text.assemble(*lines), soft_wrap=not sys.stdout.isatty())

    def indented(self, label: str, *texts: str) -> None:
        """Print texts behind the label of the first; on a terminal a long one goes on below itself."""
        for text in texts:
            width = max(self.console.width - len(label), 20)
            width = width if sys.stdout.isatty() else len(text) + 1
            for line in textwrap.wrap(text, width, break_on_hyphens=False):
                self.line(label + line)
                label = " " * len(label)

    def text(self) -> str:
        """Return everything printed."""
        return self.console.end_capture().rstrip("\n")


def titled(title: str, rest: str, lines: Iterable[str]) -> str:
    """Return a text that begins with a title in bold and the rest of its line; other lines follow."""
    page = Page()
    page.line(bold(title), rest)
    for line in lines:
        page.line(line)
    return page.text()


def print_table(
    console: Console, headings: Sequence[str], rows: Sequence[Sequence[Cell]], keys: int
) -> None:
    """Print a table in the width of the console; the first ``keys`` columns begin each of its parts.

    A column whose heading begins with ``>`` stands to the right. The first column may hold cells of any
    length, such as paths, and is folded. No other cell is.
    """
    cells = [[cell if isinstance(cell, Text) else Text(one_line(cell)) for cell in r] for r in rows]
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
