"""Figures of a trade-off: a panel for each group of families, with failures at its upper border.

In a work-precision diagram x is the work (seconds, evaluations), y the error, both logarithmic:
further down and to the left is better. Lines join only neighbouring sound settings of one family.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.plotting.log_axes import Limits, number_axes, widened
from taylor_verify.plotting.palette import INK, PAPER, QUIET
from taylor_verify.plotting.sheet import (
    Entry,
    add_axes,
    blank,
    draw_legend,
    foot_of,
    frames_of,
    free_place,
    name_lines,
)
from taylor_verify.records.standing import Standing
from taylor_verify.tradeoff.pictures.series import Panel, Series, Spot, front_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Margins for names, as parts of the panel: left and right, below and above.
_MARGINS_X: Final = (0.06, 0.16)
_MARGINS_Y: Final = (0.09, 0.09)


def work_precision(
    panels: Sequence[Panel],
    x_name: str,
    y_name: str,
    floors: Mapping[str, float],
    bars: bool,
    note: str,
) -> Figure:
    """Return the whole figure: the panels row by row, the meaning of the marks below.

    ``floors`` are the attainable errors by rung, each drawn in panels with taylor on that rung. ``bars`` is
    True to draw the spread of times. ``note`` is a text below the marks.
    """
    front = front_of(series for panel in panels for series in panel.drawn)
    entries = _legend(panels, has_bars=bars, has_floors=bool(floors))
    frames, height = frames_of(len(panels), foot_of(entries, note))
    figure = blank(height)
    shared = _limits_x(p for p in panels if p.yardstick)
    for panel, frame in zip(panels, frames, strict=True):
        axes = add_axes(figure, frame)
        # The panels with the yardstick have one axis, so that they can be compared. The panel of taylor on
        # all rungs has its own axis, because its times are near each other.
        x_limits = shared if panel.yardstick else _limits_x([panel])
        own = {rung: floors[rung] for rung in panel.ladder if rung in floors}
        y_limits = widened([*(spot.y for spot in panel.sound), *own.values()], *_MARGINS_Y)
        axes.set(xscale="log", yscale="log", xlim=x_limits, ylim=y_limits)
        axes.set(xlabel=x_name, ylabel=y_name)
        number_axes(axes)
        stairs = _stairs(front, axes)
        # The front is a thin line behind everything else.
        axes.plot(*zip(*stairs, strict=True), color=QUIET, linewidth=0.6, zorder=1, gid="front")
        for rung, floor in own.items():
            colour = panel.ladder[rung]
            axes.axhline(floor, color=colour, linewidth=0.6, dashes=(1, 2), gid="floor")
        for series in panel.drawn:
            _draw_series(axes, panel, series, bars)
            _draw_exact(axes, series)
            _draw_failures(axes, panel, series)
        name_lines(axes)
        axes.set_title(panel.heading, pad=4)
    draw_legend(figure, entries, note, free_place(frames))
    return figure


def _draw_series(axes: Axes, panel: Panel, series: Series, bars: bool) -> None:
    """Draw a line through each sequence of sound settings of a family, and bars for the spread of times."""
    look = series.look
    name: str | None = panel.label(series)
    for piece in series.pieces:
        x, y = [spot.x for spot in piece], [spot.y for spot in piece]
        if bars:
            beyond = [[0.0] * len(piece), [spot.x * (spot.spread - 1) for spot in piece]]
            axes.errorbar(
                x, y, xerr=beyond, fmt="none", ecolor=look.colour, elinewidth=0.5, alpha=0.6
            )
        # Thick lines below thin ones.
        axes.plot(x, y, gid=series.family, label=name, zorder=4 - look.width / 10, **look.line)
        # One of its pieces has the name of a family.
        name = None


def _draw_exact(axes: Axes, series: Series) -> None:
    """Mark answers without any error at the lower border."""
    look = {**series.look.line, "linestyle": "none", "marker": "v"}
    place = axes.get_xaxis_transform()
    for spot in series.spots:
        if spot.is_exact:
            axes.plot([spot.x], [0.0], transform=place, clip_on=False, gid="exact", **look)


def _stairs(front: Sequence[Spot], axes: Axes) -> list[tuple[float, float]]:
    """Return the corners of the front; settings above and to the right of it are beaten."""
    level = max(axes.get_ylim()[1], front[0].y)
    corners = []
    # The yardstick is in several panels, and counts once.
    for x, y in dict.fromkeys((spot.x, spot.y) for spot in front):
        corners += [(x, level), (x, y)]
        level = y
    return [*corners, (max(axes.get_xlim()[1], front[-1].x), level)]


def _draw_failures(axes: Axes, panel: Panel, series: Series) -> None:
    """Mark what is no answer at the upper border, each at its work."""
    place, name = axes.get_xaxis_transform(), None if series.sound else panel.label(series)
    for spot in series.border:
        is_hollow = spot.row["standing"] == Standing.FALSE
        axes.plot(
            [spot.x],
            [1.0],
            transform=place,
            linestyle="none",
            marker=series.look.marker if is_hollow else "x",
            markersize=4.5,
            markerfacecolor=PAPER if is_hollow else series.look.colour,
            markeredgecolor=series.look.colour,
            markeredgewidth=1.0,
            gid=spot.row["standing"],
            label=name,
            clip_on=False,
        )
        name = None


def _legend(panels: Sequence[Panel], has_bars: bool, has_floors: bool) -> list[Entry]:
    """Return the legend of the marks that occur."""
    spots = [spot for panel in panels for series in panel.drawn for spot in series.spots]
    standings = {spot.row["standing"] for spot in spots if spot.is_at_the_border}
    has_exact = any(spot.is_exact for spot in spots)
    dotted, mark = (0, (1, 2)), {"linestyle": "none", "markersize": 4.5, "markeredgecolor": INK}
    every: list[tuple[bool, dict[str, Any], str]] = [
        (True, {"color": QUIET, "linewidth": 0.8}, "Pareto front"),
        (has_bars, {"color": QUIET, "linewidth": 0.5, "marker": "|"}, "best to slowest repeat"),
        (has_floors, {"color": INK, "linewidth": 0.6, "linestyle": dotted}, "attainable"),
        (
            Standing.FALSE in standings,
            {**mark, "marker": "o", "markerfacecolor": PAPER},
            "false success",
        ),
        (Standing.FAILED in standings, {**mark, "marker": "x"}, "failed"),
        (has_exact, {**mark, "marker": "v", "markerfacecolor": INK}, "no error seen"),
    ]
    return [(look, name) for occurs, look, name in every if occurs]


def _limits_x(panels: Iterable[Panel]) -> Limits:
    """Return the limits of the work in the panels, with room for names."""
    spots = [spot for panel in panels for series in panel.drawn for spot in series.spots]
    sound = [x for s in spots if s.is_sound for x in (s.x, s.x * s.spread)]
    return widened([*sound, *(s.x for s in spots if s.is_at_the_border)], *_MARGINS_X)
