"""What lines and marks mean, at the foot of a figure or in a place that its panels leave free."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import fill
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.publish.pictures import panels as at
from taylor_verify.publish.pictures.palette import QUIET
from taylor_verify.publish.pictures.panels import Frame
from taylor_verify.publish.pictures.style import SMALL

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# How a line or mark is drawn, and what it means.
Entry = tuple[dict[str, Any], str]

# How many entries of a legend the page is wide enough for, and the space between its lines.
_ABREAST: Final = 4
_SPACING: Final = 0.8
# Letters of a note beside a panel.
_NARROW: Final = 38


def foot_of(entries: Sequence[Entry], note: str) -> float:
    """The height of the legend where it is at the foot, in inches."""
    return at.FOOT + at.LINE * (_lines(entries) + bool(note))


def _columns(entries: Sequence[Entry]) -> int:
    """As few lines as the page's width allows, and these about as long as each other."""
    return -(-len(entries) // _lines(entries))


def _lines(entries: Sequence[Entry]) -> int:
    return max(-(-len(entries) // _ABREAST), 1)


def draw_legend(figure: Figure, entries: Sequence[Entry], note: str, free: Frame | None) -> None:
    """In the free place beside the last panel, one below the other, else in a line at the foot.

    The note, a sentence of its own, is below.
    """
    from matplotlib.lines import Line2D

    width, height = figure.get_size_inches()
    left, top = at.LEFT, foot_of(entries, note)
    if free:
        left, top = free.left, free.low + free.height
    if entries:
        figure.legend(
            [Line2D([], [], **drawn) for drawn, _ in entries],
            [name for _, name in entries],
            loc="upper left",
            bbox_to_anchor=(left / width, top / height),
            ncols=1 if free else _columns(entries),
            frameon=False,
            fontsize=SMALL,
            borderpad=0,
            borderaxespad=0,
            columnspacing=1.4,
            handlelength=1.8,
            labelspacing=_SPACING,
        )
    below = top - at.LINE * (len(entries) if free else _lines(entries))
    words = fill(note, _NARROW) if free else note
    figure.text(left / width, below / height, words, size=SMALL, color=QUIET, va="top")
