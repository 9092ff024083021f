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


def bold(text: str, colour: str = "") -> Text:
    """Return a text in bold type."""
    return Text(text, f"bold {colour}".rstrip())


class Page:
    """A text that is kept until it is asked for, in the width and colours of stdout.

    It takes no markup: a name may hold brackets or colons.
    """

    def __init__(self, piped_width: int = PIPED_WIDTH) -> None:
        self.console = EscapingConsole(markup=False, emoji=False, highlight=False)
        if not sys.stdout.isatty():
            self.console.width = piped_width
        self.console.begin_capture()

    def line(self, *parts: str | Text) -> None:
        """Print one line; a pipe takes any length."""
        self.console.print(Text.assemble(*parts), soft_wrap=not sys.stdout.isatty())

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
