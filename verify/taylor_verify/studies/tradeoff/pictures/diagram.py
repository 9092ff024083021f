"""A work-precision diagram: a panel for each group of families, and a strip for what is no answer.

x is the work (seconds, evaluations, steps), y the error, both logarithmic: further down and to the
left is better. Nothing is joined but neighbouring sound settings of one family.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.publish.pictures.log_axes import Limits, number_axes, widened
from taylor_verify.publish.pictures.named import Named
from taylor_verify.publish.pictures.palette import INK, PAPER, QUIET, for_text
from taylor_verify.publish.pictures.sheet import (
    STRIP,
    Entry,
    Frame,
    add_axes,
    blank,
    draw_legend,
    foot_of,
    frames_of,
    free_place,
)
from taylor_verify.publish.pictures.style import SMALL, Look
from taylor_verify.records.standing import Standing
from taylor_verify.studies.tradeoff.pictures.series import Panel, Row, Series, amount, front_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Room beside the points for their names, in parts of the panel.
_MARGIN_LEFT: Final = 0.06
_MARGIN_RIGHT: Final = 0.16
_MARGIN_LOW: Final = 0.09
_MARGIN_HIGH: Final = 0.09
# Thin and behind everything.
_FRONT: Final[Mapping[str, Any]] = {
    "color": QUIET,
    "linewidth": 0.6,
    "zorder": 1,
    "gid": "front",
}


@dataclass(frozen=True)
class Diagram:
    """What is drawn against what: keys of a row, and the axes' names with their units.

    ``floors`` are the attainable errors by rung, drawn where a panel has the rung; ``bars`` shows by
    how much times spread; ``note`` is said with the marks.
    """

    x: str
    y: str
    x_name: str = ""
    y_name: str = ""
    floors: Mapping[str, float] = field(default_factory=dict)
    bars: bool = False
    note: str = ""


def figure_of(diagram: Diagram, panels: Sequence[Panel]) -> Figure:
    """The whole figure: the panels row by row, the meaning of the marks below."""
    from taylor_verify.publish.pictures.labels import write_names

    strips = [_strip_rows(panel, diagram.x) for panel in panels]
    drawn = [one for panel in panels for one in panel.drawn]
    front = front_of((row for one in drawn for row in one.rows), diagram.x, diagram.y)
    exact = any(_exact_rows(one, diagram) for one in drawn)
    entries = legend_of(diagram, bool(front), exact, strips)
    frames, height = frames_of([len(rows) for rows in strips], foot_of(entries, diagram.note))
    figure = blank(height)
    shared = _limits_x([p for p in panels if p.yardstick], diagram)
    for panel, rows, frame in zip(panels, strips, frames, strict=True):
        axes = add_axes(figure, frame)
        # The ladder's times are near each other; the others are compared across their panels.
        x_limits = shared if panel.yardstick else _limits_x([panel], diagram)
        axes.set(xscale="log", yscale="log", xlim=x_limits, ylim=_limits_y(panel, diagram))
        axes.set(xlabel=diagram.x_name, ylabel=diagram.y_name)
        number_axes(axes)
        stairs = _stairs(front, diagram, axes)
        if stairs:
            axes.plot(*zip(*stairs, strict=True), **_FRONT)
        _draw_floors(axes, panel, diagram.floors)
        for series in panel.drawn:
            draw_series(axes, series, diagram)
            _draw_exact(axes, series, diagram)
        write_names(axes, names_of(panel, diagram.x, diagram.y), _beside(panel, stairs, diagram))
        top = _draw_strip(figure, frame, panel, rows, diagram.x, x_limits) if rows else axes
        top.set_title(panel.heading, pad=4)
    draw_legend(figure, entries, diagram.note, free_place(frames))
    return figure


def draw_series(axes: Axes, series: Series, diagram: Diagram) -> None:
    """The lines of a family, one for each run of sound neighbours, and a bar where times spread."""
    look = series.look
    for piece in series.pieces(diagram.x, diagram.y):
        x, y = [row[diagram.x] for row in piece], [row[diagram.y] for row in piece]
        if diagram.bars:
            beyond = [
                [0.0] * len(piece),
                [row[diagram.x] * ((row["spread"] or 1) - 1) for row in piece],
            ]
            axes.errorbar(
                x, y, xerr=beyond, fmt="none", ecolor=look.colour, elinewidth=0.5, alpha=0.6
            )
        axes.plot(x, y, gid=series.family, zorder=_above(series), **look.line)


def _exact_rows(series: Series, diagram: Diagram) -> list[Row]:
    """Those without any error, which a logarithmic axis has no place for."""
    return [
        row
        for row in series.rows
        if row["standing"] == Standing.SOUND and row[diagram.y] == 0 and amount(row, diagram.x)
    ]


def _draw_exact(axes: Axes, series: Series, diagram: Diagram) -> None:
    """At the lower border, and joined to nothing."""
    for row in _exact_rows(series, diagram):
        axes.plot(
            [row[diagram.x]],
            [0.0],
            transform=axes.get_xaxis_transform(),
            clip_on=False,
            gid="exact",
            **{**series.look.line, "linestyle": "none", "marker": "v"},
        )


def _above(series: Series) -> float:
    """Thick lines below thin ones."""
    return 4 - series.look.width / 10


def names_of(panel: Panel, x: str, y: str) -> list[Named]:
    return [
        Named(
            panel.label(one), one.look.colour, [[(r[x], r[y]) for r in p] for p in one.pieces(x, y)]
        )
        for one in panel.drawn
    ]


def _stairs(front: Sequence[Row], diagram: Diagram, axes: Axes) -> list[tuple[float, float]]:
    """The front's corners: what is above and to the right of them is beaten."""
    if not front:
        return []
    corners = [(front[0][diagram.x], max(axes.get_ylim()[1], front[0][diagram.y]))]
    for row in front:
        corners += [(row[diagram.x], corners[-1][1]), (row[diagram.x], row[diagram.y])]
    right = max(axes.get_xlim()[1], front[-1][diagram.x])
    return [*corners[1:], (right, corners[-1][1])]


def _beside(
    panel: Panel, stairs: Sequence[tuple[float, float]], diagram: Diagram
) -> list[Sequence[tuple[float, float]]]:
    """What else is drawn: the stairs, and the bars from a time to the slowest."""
    rows = [row for one in panel.drawn for row in one.sound(diagram.x, diagram.y)]
    bars = [
        ((row[diagram.x], row[diagram.y]), (row[diagram.x] * (row["spread"] or 1), row[diagram.y]))
        for row in rows
        if diagram.bars
    ]
    return [stairs, *bars] if stairs else [*bars]


def _draw_floors(axes: Axes, panel: Panel, floors: Mapping[str, float]) -> None:
    rungs = {series.rung: series.look.colour for series in panel.drawn if series.kind == "taylor"}
    for rung, colour in rungs.items():
        if rung in floors:
            axes.axhline(floors[rung], color=colour, linewidth=0.6, dashes=(1, 2), gid="floor")


def _strip_rows(panel: Panel, x: str) -> list[tuple[Series, list[Row]]]:
    found = [(series, series.at_the_border(x)) for series in panel.drawn]
    return [(series, rows) for series, rows in found if rows]


def _draw_strip(
    figure: Figure,
    frame: Frame,
    panel: Panel,
    found: Sequence[tuple[Series, list[Row]]],
    x: str,
    limits: Limits,
) -> Axes:
    """Above the panel a line for each family with what is no answer, at the work that it took."""
    above = Frame(frame.left, frame.low + frame.height, frame.width, STRIP * len(found))
    axes = add_axes(figure, above)
    axes.set(xscale="log", xlim=limits, ylim=(len(found) - 0.5, -0.5), yticks=[])
    axes.tick_params(which="both", bottom=False, labelbottom=False)
    axes.set_facecolor("#F4F4F4")
    axes.set_ylabel("no answer", rotation=0, ha="right", va="center", size=SMALL, color=QUIET)
    axes.spines["left"].set_visible(False)
    axes.spines["bottom"].set_visible(False)
    for line, (series, rows) in enumerate(found):
        for row in rows:
            hollow = row["standing"] == Standing.FALSE
            axes.plot(
                [amount(row, x) or 1.0],
                [line],
                linestyle="none",
                marker=series.look.marker if hollow else "x",
                markersize=4.5,
                markerfacecolor=PAPER if hollow else series.look.colour,
                markeredgecolor=series.look.colour,
                markeredgewidth=1.0,
                gid=row["standing"],
                clip_on=False,
            )
        _name_in_strip(
            axes,
            panel.label(series),
            series.look,
            line,
            [amount(row, x) or 0.0 for row in rows],
            limits,
        )
    return axes


def _name_in_strip(
    axes: Axes, name: str, look: Look, line: int, taken: Sequence[float], limits: Limits
) -> None:
    """Right of the last mark, or left of the first where that is nearer the middle."""
    middle = (limits[0] * limits[1]) ** 0.5
    after = max(taken) < middle or min(taken) < middle
    axes.annotate(
        name,
        (max(taken) if after else min(taken), line),
        (5 if after else -5, 0),
        textcoords="offset points",
        ha="left" if after else "right",
        va="center_baseline",
        color=for_text(look.colour),
        size=SMALL,
    )


def legend_of(
    diagram: Diagram,
    front: bool,
    exact: bool,
    strips: Iterable[Iterable[tuple[Series, Iterable[Row]]]],
) -> list[Entry]:
    """What the marks mean, those alone that occur."""
    standings = {row["standing"] for strip in strips for _, rows in strip for row in rows}
    found: list[Entry] = []
    if front:
        found.append(({"color": QUIET, "linewidth": 0.8}, "Pareto front"))
    if diagram.bars:
        found.append(({"color": QUIET, "linewidth": 0.5, "marker": "|"}, "best to slowest repeat"))
    if diagram.floors:
        dotted = {"color": INK, "linewidth": 0.6, "linestyle": (0, (1, 2))}
        found.append((dotted, "attainable"))
    mark = {"linestyle": "none", "markersize": 4.5, "markeredgecolor": INK}
    if Standing.FALSE in standings:
        found.append(({**mark, "marker": "o", "markerfacecolor": PAPER}, "false success"))
    if standings - {Standing.FALSE}:
        found.append(({**mark, "marker": "x"}, "failed"))
    if exact:
        found.append(({**mark, "marker": "v", "markerfacecolor": INK}, "no error seen"))
    return found


def _limits_x(panels: Iterable[Panel], diagram: Diagram) -> Limits:
    series = [one for panel in panels for one in panel.drawn]
    sound = [row for one in series for row in one.sound(diagram.x, diagram.y)]
    spreads = [(row["spread"] or 1) if diagram.bars else 1 for row in sound]
    slowest = [row[diagram.x] * spread for row, spread in zip(sound, spreads, strict=True)]
    border = [amount(row, diagram.x) or 1 for one in series for row in one.at_the_border(diagram.x)]
    found = [*(row[diagram.x] for row in sound), *slowest, *border]
    return widened(found, _MARGIN_LEFT, _MARGIN_RIGHT)


def _limits_y(panel: Panel, diagram: Diagram) -> Limits:
    drawn = [row for one in panel.drawn for row in one.sound(diagram.x, diagram.y)]
    rungs = {one.rung for one in panel.drawn if one.kind == "taylor"}
    floors = [floor for rung, floor in diagram.floors.items() if rung in rungs and floor > 0]
    return widened([*(row[diagram.y] for row in drawn), *floors], _MARGIN_LOW, _MARGIN_HIGH)
