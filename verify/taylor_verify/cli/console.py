"""A console for the texts that a person reads: in the width of stdout, and kept until it is asked for."""

from __future__ import annotations

import sys
import textwrap
from collections.abc import Iterable

from rich.console import Console, ConsoleOptions, RenderableType
from rich.segment import Segment
from rich.text import Text

from taylor_verify.scenes.names import escaped

# Piped output keeps whole rows: a table cut to 80 columns cannot be read by the next program.
PIPED_WIDTH = 140


class EscapingConsole(Console):
    """A console on which no name can steer the terminal: styles are its own, the rest is text."""

    def render(
        self, renderable: RenderableType, options: ConsoleOptions | None = None
    ) -> Iterable[Segment]:
        for segment in super().render(renderable, options):
            is_text = segment.control is None
            yield Segment(escaped(segment.text), segment.style) if is_text else segment


def print_line(console: Console, *parts: str | Text) -> None:
    """One line as it is: a name may hold brackets or colons, and a pipe takes any length."""
    console.print(Text.assemble(*parts), soft_wrap=not sys.stdout.isatty())


def print_indented(console: Console, label: str, text: str) -> None:
    """A line behind its label; on a terminal what is too long goes on below itself."""
    width = max(console.width - len(label), 20) if sys.stdout.isatty() else len(text) + 1
    for i, line in enumerate(textwrap.wrap(text, width, break_on_hyphens=False)):
        print_line(console, (label if i == 0 else " " * len(label)) + line)


def new_console(piped_width: int = PIPED_WIDTH) -> Console:
    """A console that keeps its text, in the width and colours of stdout, and adds no markup."""
    console = EscapingConsole(markup=False, emoji=False, highlight=False)
    if not sys.stdout.isatty():
        console.width = piped_width
    console.begin_capture()
    return console


def text_of(console: Console) -> str:
    return console.end_capture().rstrip("\n")
