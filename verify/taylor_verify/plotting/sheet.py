"""Figure as wide as a page: the places of its panels and its legend, in inches."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from textwrap import fill
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.plotting.style import PAGE_WIDTH, QUIET, SMALL

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Style of a line or mark, and its meaning.
Entry = tuple[dict[str, Any], str]

# Margins of a panel for numbers and the name of an axis.
LEFT: Final = 0.66
RIGHT: Final = 0.08
HEADING: Final = 0.26
BELOW: Final = 0.46
HEIGHT: Final = 2.35
# Height of a line of the legend, and of the space below.
_LINE: Final = 0.2
_FOOT: Final = 0.06
# Entries in a line of the legend, and the space between its lines.
_ABREAST: Final = 4
_SPACING: Final = 0.8
# Letters in a line of a note beside a panel, and the width of a letter in inches.
_NARROW: Final = 38
_LETTER: Final = 0.055


@dataclass(frozen=True)
class Frame:
    """Place of a panel, in inches from the lower left corner of the figure."""

    left: float
    low: float
    width: float
    height: float


def sheet(
    count: int, entries: Sequence[Entry], note: str = "", height: float = HEIGHT
) -> tuple[Figure, list[Axes]]:
    """Return a figure with ``count`` panels, two in a row, and its legend.

    The legend is in the free place beside a last panel that is alone in its row, else at the foot.
    """
    across, has_place = min(2, count), count > 1 and count % 2 == 1
    width, whole = PAGE_WIDTH / across - LEFT - RIGHT, HEADING + height + BELOW
    total = whole * -(-count // across) + (0.0 if has_place else foot_of(entries, note))
    columns = [LEFT + k * (width + LEFT + RIGHT) for k in range(across)]
    frames = [
        Frame(columns[k % across], total - whole * (k // across + 1) + BELOW, width, height)
        for k in range(count)
    ]
    figure = blank(total)
    free = Frame(columns[1], frames[-1].low, width, height) if has_place else None
    draw_legend(figure, entries, note, free)
    return figure, [add_axes(figure, frame) for frame in frames]


def blank(height: float) -> Figure:
    """Return an empty figure, in which a pixel is a point during the layout."""
    from matplotlib.figure import Figure

    return Figure(figsize=(PAGE_WIDTH, height), dpi=72)


def add_axes(figure: Figure, frame: Frame) -> Axes:
    """Return new axes in this place."""
    width, height = figure.get_size_inches()
    return figure.add_axes(
        (frame.left / width, frame.low / height, frame.width / width, frame.height / height)
    )


def foot_of(entries: Sequence[Entry], note: str) -> float:
    """Return the height of a legend at the foot."""
    return _FOOT + _LINE * (_lines(entries) + bool(note))


def _lines(entries: Sequence[Entry]) -> int:
    return max(-(-len(entries) // _ABREAST), 1)


def name_lines(axes: Axes) -> None:
    """Write the names of the lines that have one, where they hide the fewest points."""
    if not axes.get_legend_handles_labels()[0]:
        return
    axes.legend(
        loc="best",
        fontsize=SMALL - 1,
        handlelength=2.0,
        borderpad=0.2,
        labelspacing=0.15,
        framealpha=0.6,
        edgecolor="none",
    )


def draw_legend(
    figure: Figure, entries: Sequence[Entry], note: str = "", free: Frame | None = None
) -> None:
    """Draw the legend in a free place with one entry in each line, else in full lines at the foot.

    The note, which is a sentence, is below.
    """
    from matplotlib.lines import Line2D

    width, height = figure.get_size_inches()
    left, top = LEFT, foot_of(entries, note)
    if free:
        left, top = free.left, free.low + free.height
    if entries:
        figure.legend(
            [Line2D([], [], **drawn) for drawn, _ in entries],
            [name for _, name in entries],
            loc="upper left",
            bbox_to_anchor=(left / width, top / height),
            # As few lines as the page's width allows, of about the same length.
            ncols=1 if free else -(-len(entries) // _lines(entries)),
            frameon=False,
            fontsize=SMALL,
            borderpad=0,
            borderaxespad=0,
            columnspacing=1.4,
            handlelength=1.8,
            labelspacing=_SPACING,
        )
    below = top - _LINE * (len(entries) if free else _lines(entries))
    words = fill(note, min(_NARROW, int(free.width / _LETTER))) if free else note
    figure.text(left / width, below / height, words, size=SMALL, color=QUIET, va="top")
