"""Picture of errors against time on every rung, beside the powers of time with which roundings grow.

Both axes are logarithmic; a line is the largest error so far. Errors are in units of the rung's own unit
roundoff u, so that the lines of all rungs agree if roundings are the only errors. The first panel is a
conserved quantity with the power 1/2 of Brouwer's law. The others are the state and the attitude, with the
power 3/2 of a phase whose rate has drifted, and the centre.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import accumulate
from math import exp, isfinite, log
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.plotting.log_axes import number_axes, widened
from taylor_verify.plotting.palette import QUIET
from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.sheet import sheet
from taylor_verify.plotting.style import look_of_rung
from taylor_verify.plotting.wording import plain, stem_of
from taylor_verify.records.precisions import place_of_rung

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Record = Mapping[str, Any]
Points = list[tuple[float, float]]

# Of each panel: the heading, the quantities (the first in the record is drawn), the power and its name.
PANELS: Final = (
    ("conserved", ("T", "H2", "FG", "F2"), 0.5, "\N{SQUARE ROOT}t"),
    ("state", ("omega", "impulse"), 1.5, "t\N{SQUARE ROOT}t"),
    ("attitude", ("attitude",), 1.5, "t\N{SQUARE ROOT}t"),
    ("centre", ("centre",), None, ""),
)
_NAMES: Final = {"T": "energy T", "H2": "|H|\N{SUPERSCRIPT TWO}", "omega": "angular velocity"}
_NOTE: Final = "The largest error up to t, in u, the rung's unit roundoff."
_POWER: Final[Mapping[str, Any]] = {"color": QUIET, "linewidth": 0.8, "dashes": (5, 2)}
# The number of marks on a line. A mark for every sample would crowd the right side.
_MARKS: Final = 9


@dataclass(frozen=True)
class Panel:
    """A panel: the lines of one quantity by rung, and the expected power of time, which ``words`` name."""

    heading: str
    quantity: str
    lines: Mapping[str, Points]
    power: float | None
    words: str


def series(records: Sequence[Record], start: float | None = None) -> dict[str, dict[str, Points]]:
    """Return the points (time since the start, error in u) by quantity and rung, without zeros.

    Times are in the scene's unit and positive, also of a run backwards in time. ``start`` is the time of
    the initial state, by default that of the first sample.
    """
    curves: dict[str, dict[str, Points]] = {}
    for record in sorted(records, key=lambda record: place_of_rung(record["rung"])):
        first, u = record["times"][0] if start is None else start, record["unit_roundoff"]
        for gate in record["gates"]:
            pairs = zip(record["times"], gate["errors"], strict=True)
            points = [(abs(t - first), e / u) for t, e in pairs if _is_drawable(t - first, e)]
            if points:
                curves.setdefault(gate["quantity"], {})[record["rung"]] = points
    return curves


def _is_drawable(elapsed: float, error: float | None) -> bool:
    """Return True for a point that logarithmic axes can show."""
    return elapsed != 0 and error is not None and isfinite(error) and error > 0


def picture(scene: str, records: Sequence[Record], start: float | None = None) -> Picture:
    """Return the picture of one scene. Raises ValueError for records without any error above zero."""
    panels = panels_of(series(records, start))
    if not panels:
        raise ValueError(f"expected errors above zero, got none @ {scene}")
    ends = "; ".join(
        f"{panel.quantity} on {rung} {plain(points[-1][1])} u at the end"
        for panel in panels
        for rung, points in panel.lines.items()
    )
    alt = (
        f"Errors of {scene} against the time since the start for each rung, both logarithmic, in units "
        f"of the rung's roundoff: {' and '.join(panel.quantity for panel in panels)}. {ends}."
    )
    title = f"Errors over time: {scene}"
    return Picture(stem_of({"scene": scene}, "errors"), title, alt, partial(_figure, panels))


def panels_of(curves: Mapping[str, Mapping[str, Points]]) -> list[Panel]:
    """Return a panel for a conserved quantity, if there is one, and for each part of the state."""
    panels = []
    for heading, names, power, words in PANELS:
        if name := next((name for name in names if name in curves), ""):
            panels.append(Panel(heading, name, curves[name], power, words))
    return panels


def _figure(panels: Sequence[Panel]) -> Figure:
    rungs = sorted({rung for panel in panels for rung in panel.lines}, key=place_of_rung)
    entries = [(look_of_rung(rung).line, rung) for rung in rungs]
    powers = dict.fromkeys(panel.words for panel in panels if panel.power)
    entries += [(dict(_POWER), " and ".join(powers))] if powers else []
    figure, places = sheet(len(panels), entries, _NOTE)
    for axes, panel in zip(places, panels, strict=True):
        _draw(axes, panel)
    return figure


def _draw(axes: Axes, panel: Panel) -> None:
    axes.set(xscale="log", yscale="log", xlabel="time since the start")
    unit = "u rad" if panel.quantity == "attitude" else "u"
    axes.set(ylabel=f"error of {_NAMES.get(panel.quantity, panel.quantity)} ({unit})")
    axes.set_title(panel.heading, pad=4)
    lines = {rung: so_far(points) for rung, points in panel.lines.items()}
    everything = [point for points in lines.values() for point in points]
    axes.set(xlim=widened([t for t, _ in everything], 0.04, 0.08))
    axes.set(ylim=widened([e for _, e in everything], 0.05, 0.08))
    number_axes(axes)
    if panel.power:
        _draw_power(axes, everything, panel.power)
    for rung, points in lines.items():
        look = {**look_of_rung(rung).line, "markevery": _marked(points)}
        axes.plot(*zip(*points, strict=True), gid=rung, zorder=3, alpha=0.9, **look)


def _marked(points: Points) -> list[int]:
    """Return the indices of points at about equal distances on a logarithmic axis."""
    (first, _), (last, _) = points[0], points[-1]
    apart = log(last / first) / _MARKS
    marks = [0]
    for i, (t, _) in enumerate(points):
        if log(t / points[marks[-1]][0]) >= apart > 0:
            marks.append(i)
    return marks


def so_far(points: Points) -> Points:
    """Return the largest error up to each time; the error itself is small where its sign changes."""
    largest = accumulate((error for _, error in points), max)
    return [(t, error) for (t, _), error in zip(points, largest, strict=True)]


def _draw_power(axes: Axes, points: Points, power: float) -> None:
    """Draw a power of time across the panel, through the mean of the points' logarithms."""
    shift = exp(sum(log(e) - power * log(t) for t, e in points) / len(points))
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    first = max(left, (bottom / shift) ** (1 / power))
    last = min(right, (top / shift) ** (1 / power))
    ends = [shift * first**power, shift * last**power]
    look = {**_POWER, "zorder": 4, "gid": f"power {power:g}"}
    axes.plot([first, last], ends, scalex=False, scaley=False, **look)
