"""Picture of the cost of each option of a scene: a bar for each, as a multiple of the yardstick's."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.plotting.palette import INK, PAPER, QUIET
from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.sheet import Frame, add_axes, blank, draw_legend
from taylor_verify.plotting.style import PAGE_WIDTH, SMALL, look_of_rung
from taylor_verify.plotting.wording import stem_of, times
from taylor_verify_reports.pictures.ratio import Ratio, check

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# In inches.
_BAR: Final = 0.24
_ABOVE: Final = 0.12
_BELOW: Final = 0.52
_FOOT: Final = 0.24
_RIGHT: Final = 0.15
# The mean width of a character of a label, and the largest width for labels.
_LETTER: Final = 0.068
_WIDEST: Final = 3.0
_RANGE: Final[Mapping[str, Any]] = {"color": INK, "linewidth": 0.8, "marker": "|"}


def picture(scene: str, yardstick: str, ratios: Sequence[Ratio]) -> Picture:
    """Return the picture of ratios to the time of ``yardstick``. Raises ValueError for invalid ratios.

    The ends of a ratio are those of the interval for its median, at 95 %.
    """
    check(ratios)
    dearest = max(ratios, key=lambda bar: bar.ratio)
    words = "; ".join(f"{bar.label} on {bar.rung} {times(bar.ratio)}" for bar in ratios)
    alt = (
        f"Cost of what {scene} requires, as a multiple of the time of {yardstick}: "
        f"{words}. The dearest is {dearest.label} on {dearest.rung}."
    )
    title = f"Cost of what is required: {scene}"
    return Picture(
        stem_of({"scene": scene}, "prices"), title, alt, partial(_figure, ratios, yardstick)
    )


def _figure(ratios: Sequence[Ratio], yardstick: str) -> Figure:
    bars, below = _BAR * len(ratios), _BELOW + _FOOT
    figure = blank(_ABOVE + bars + below)
    left = min(0.25 + _LETTER * max(len(_name(bar)) for bar in ratios), _WIDEST)
    axes = add_axes(figure, Frame(left, below, PAGE_WIDTH - left - _RIGHT, bars))
    _draw_bars(axes, ratios)
    axes.set(xlabel=f"time, as a multiple of that of {yardstick}")
    if any(bar.least < bar.greatest for bar in ratios):
        draw_legend(figure, [(dict(_RANGE), "interval of the median, 95 %")])
    return figure


def _draw_bars(axes: Axes, ratios: Sequence[Ratio]) -> None:
    """Draw bars from 1, the yardstick, to each ratio, with its interval and its number."""
    axes.set(xscale="log", ylim=(len(ratios) - 0.4, -0.6))
    for i, bar in enumerate(ratios):
        colour = look_of_rung(bar.rung).colour
        axes.barh(i, bar.ratio - 1, left=1, height=0.62, color=colour, gid=bar.label, zorder=2)
        axes.plot([bar.ratio], [i], marker="|", color=colour, markersize=9, zorder=2)
        if bar.least < bar.greatest:
            # A white line below makes the line visible on a dark bar.
            below = {"color": PAPER, "linewidth": 2.0, "marker": "|", "markeredgewidth": 2.4}
            for look in (below, _RANGE):
                axes.plot([bar.least, bar.greatest], [i, i], zorder=3, **look)
        axes.annotate(
            times(bar.ratio),
            (max(bar.greatest, 1.0), i),
            (6, 0),
            textcoords="offset points",
            va="center",
            size=SMALL,
            gid="number",
        )
    axes.axvline(1, color=QUIET, linewidth=0.8, zorder=4)
    least = min(1.0, *(bar.least for bar in ratios))
    most = max(1.0, *(bar.greatest for bar in ratios))
    # The last number needs a fifth of the axis.
    axes.set_xlim(least / 1.15, most * max((most / least) ** 0.22, 1.3))
    axes.set_yticks(range(len(ratios)), [_name(bar) for bar in ratios])
    axes.tick_params(axis="y", length=0)
    axes.xaxis.set_major_formatter("{x:g}")
    axes.grid(visible=True, axis="x", which="major")


def _name(bar: Ratio) -> str:
    return f"{bar.label}, {bar.rung}"
