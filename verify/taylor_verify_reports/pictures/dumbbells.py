"""Picture with two errors on each line, joined by a stroke, and a value on the right."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.plotting.log_axes import widened
from taylor_verify.plotting.sheet import (
    BELOW,
    HEADING,
    Entry,
    Frame,
    add_axes,
    blank,
    draw_legend,
    foot_of,
)
from taylor_verify.plotting.style import INK, PAGE_WIDTH, PAPER, QUIET, SMALL
from taylor_verify.plotting.wording import power_of_ten

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MARK: Final[Mapping[str, Any]] = {"linestyle": "none", "markeredgewidth": 1.1}
FULL: Final[dict[str, Any]] = {
    **_MARK,
    "marker": "o",
    "markersize": 5,
    "markerfacecolor": "#A83C00",
    "markeredgecolor": "#A83C00",
}
HOLLOW: Final[dict[str, Any]] = {
    **_MARK,
    "marker": "D",
    "markersize": 4.5,
    "markerfacecolor": PAPER,
    "markeredgecolor": "#0072B2",
}
# The height of a line, in inches.
_LINE: Final = 0.19


@dataclass(frozen=True)
class Dumbbell:
    """A line of the picture: its label, its two errors by their marks, and the value on the right."""

    label: str
    errors: Mapping[str, float]
    value: str


@dataclass(frozen=True)
class Layout:
    """Marks, words and sizes that all lines share; ``left`` and ``right`` are margins in inches."""

    marks: Mapping[str, Entry]
    left: float
    right: float
    axis: str
    values: str
    note: str
    headline: str = ""
    heading: float = HEADING


def draw_dumbbells(lines: Sequence[Dumbbell], layout: Layout) -> Figure:
    """Return the figure of the lines, the first on top."""
    entries = list(layout.marks.values())
    foot, height = foot_of(entries, layout.note), _LINE * len(lines)
    figure = blank(foot + BELOW + height + layout.heading)
    width = PAGE_WIDTH - layout.left - layout.right
    axes = add_axes(figure, Frame(layout.left, foot + BELOW, width, height))
    axes.set(xscale="log", ylim=(len(lines) - 0.5, -0.5))
    axes.set(xlim=widened([error for line in lines for error in line.errors.values()], 0.04, 0.04))
    axes.set_yticks(range(len(lines)), [line.label for line in lines])
    axes.xaxis.set_major_formatter(lambda value, _: power_of_ten(value))
    axes.set_xlabel(layout.axis)
    axes.grid(visible=True, axis="x", which="major")
    axes.tick_params(axis="y", length=0)
    if layout.headline:
        figure.text(0.01, 0.985, layout.headline, va="top", weight="bold")
    axes.set_title(layout.values, pad=4, loc="right", x=1.0 + layout.right / width, fontsize=SMALL)
    for place, line in enumerate(lines):
        _draw(axes, place, line, layout.marks)
    draw_legend(figure, entries, layout.note)
    return figure


def _draw(axes: Axes, place: int, line: Dumbbell, marks: Mapping[str, Entry]) -> None:
    ends = list(line.errors.values())
    axes.plot(ends, [place, place], color=QUIET, linewidth=1.0, zorder=2)
    for key, (look, _) in marks.items():
        axes.plot([line.errors[key]], [place], zorder=3, gid=key, **look)
    axes.annotate(
        line.value,
        (1.0, place),
        (6, 0),
        xycoords=("axes fraction", "data"),
        textcoords="offset points",
        va="center_baseline",
        size=SMALL,
        color=INK,
        annotation_clip=False,
    )
