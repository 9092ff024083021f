"""Pictures of a trade-off: error against time, and against evaluations of the equations.

Both axes are logarithmic: further down and to the left is better. There is a panel for each kind of solver.
A line joins neighbouring sound settings of a family, and the stairs are the front of all. Settings without
a sound answer are not drawn; the text and the tables name them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import groupby
from math import isfinite
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.plotting.log_axes import number_axes, widened
from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.sheet import Entry, name_lines, sheet
from taylor_verify.plotting.style import INK, QUIET, TAYLOR, heading_of, kind_of, look_of, place
from taylor_verify.plotting.wording import plain, stem_of
from taylor_verify.records.standing import Standing
from taylor_verify.tradeoff.document import label_of
from taylor_verify.tradeoff.pareto import pareto

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Row = Mapping[str, Any]
Spot = tuple[float, float]

# The key of a row, and the word in titles and names of files. Evaluations are the same on every machine.
WORKS: Final = {"seconds": "time", "evaluations": "evaluations"}
_NOTE: Final = "An evaluation of taylor is one order of a step's series."
# The most lines of a legible panel.
_MOST: Final = 7
# Margins for names, as parts of a panel: left and right, below and above.
_MARGINS_X: Final = (0.06, 0.16)
_MARGINS_Y: Final = (0.09, 0.09)
_FRONT: Final[Entry] = ({"color": QUIET, "linewidth": 0.8}, "Pareto front")
_FLOOR: Final[Entry] = (
    {"color": INK, "linewidth": 0.6, "linestyle": (0, (1, 2))},
    "attainable",
)


@dataclass(frozen=True)
class Series:
    """A family on a rung: its settings from the coarsest to the finest, and the key of the work."""

    family: str
    rung: str
    rows: tuple[Row, ...]
    key: str

    @property
    def kind(self) -> str:
        return kind_of(self.family)

    @property
    def label(self) -> str:
        """The name of the family without its kind, which is the heading of the panel."""
        first, _, rest = self.family.partition(" ")
        return rest if rest and first == self.kind else self.family

    @property
    def runs(self) -> list[list[Spot]]:
        """The sequences of neighbouring sound settings, which lines join."""
        groups = groupby(self.rows, key=lambda row: is_drawn(row, self.key))
        return [[(row[self.key], row["error"]) for row in own] for drawn, own in groups if drawn]

    @property
    def spots(self) -> list[Spot]:
        """The work and the error of each sound setting."""
        return [spot for run in self.runs for spot in run]


Panels = Mapping[str, Sequence[Series]]


def is_drawn(row: Row, key: str) -> bool:
    """Return True for a sound setting with work and error that logarithmic axes can show."""
    amounts = [row.get(key) or 0.0, row["error"] or 0.0]
    return row["standing"] == Standing.SOUND and all(isfinite(v) and v > 0 for v in amounts)


def series_of(document: Mapping[str, Any], key: str) -> list[Series]:
    """Return the families with a sound setting, in the order of `style.place`; ``key`` names the work."""
    rows: dict[tuple[str, str], list[Row]] = {}
    for row in document["points"]:
        rows.setdefault((row["family"], row["rung"]), []).append(row)
    every = [Series(family, rung, tuple(own), key) for (family, rung), own in rows.items()]
    drawn = [series for series in every if series.spots]
    return sorted(drawn, key=lambda series: (place(series.family, series.rung), series.rung))


def front_of(document: Mapping[str, Any], key: str) -> list[Row]:
    """Return the sound settings that no other beats in both numbers, by rising work."""
    drawn = [row for row in document["points"] if is_drawn(row, key)]
    return pareto(drawn, lambda row: (row[key], row["error"]))


def panels_of(series: Sequence[Series]) -> dict[str, list[Series]]:
    """Return taylor on all rungs, then each other kind with taylor on f64, by headings.

    A kind with too many families for a panel has several, with a number in their headings.
    """
    panels: dict[str, list[Series]] = {}
    yardstick = [line for line in series if (line.kind, line.rung) == (TAYLOR, "f64")][:1]
    for kind, group in groupby(series, key=lambda line: line.kind):
        own = list(group)
        parts = [own[k : k + _MOST] for k in range(0, len(own), _MOST)]
        for number, part in enumerate(parts, start=1):
            suffix = f" ({number} of {len(parts)})" if len(parts) > 1 else ""
            panels[heading_of(kind) + suffix] = [*yardstick[: kind != TAYLOR], *part]
    return panels


# Pictures.


def pictures(document: Mapping[str, Any]) -> list[Picture]:
    """Return the pictures of one scene's trade-off, as `TradeOff.document` gives it, that have points."""
    return [_picture(document, key) for key in WORKS if front_of(document, key)]


def _picture(document: Mapping[str, Any], key: str) -> Picture:
    series, front, work = series_of(document, key), front_of(document, key), WORKS[key]
    names = " and ".join(
        filter(None, [", ".join(s.family for s in series[:-1]), series[-1].family])
    )
    first, best = front[0], front[-1]
    alt = (
        f"Largest error against {work} on {document['scene']}, both logarithmic, for {names}. "
        f"The least {work} of a sound setting has {label_of(first)} with an error of "
        f"{plain(first['error'])}; the most accurate is {label_of(best)} with {plain(best['error'])} at "
        f"{best[key] / first[key]:.2g} times that {work}. {len(front)} settings are beaten by none."
    )
    title = f"Error against {work}: {document['scene']}"
    return Picture(stem_of(document, work), title, alt, partial(_figure, document, key))


def floors_of(document: Mapping[str, Any]) -> dict[str, float]:
    """Return the attainable error of each rung that has one."""
    floors = document.get("attainable") or {}
    return {rung: float(e) for rung, e in floors.items() if e and isfinite(e) and e > 0}


def _figure(document: Mapping[str, Any], key: str) -> Figure:
    panels, floors = panels_of(series_of(document, key)), floors_of(document)
    note = _NOTE if key == "evaluations" else ""
    figure, places = sheet(len(panels), [_FRONT, *([_FLOOR] if floors else [])], note)
    # The times of taylor on all rungs are near each other. Other panels can be compared.
    shared = _limits_x(s for own in panels.values() for s in own if own[-1].kind != TAYLOR)
    front = [(row[key], row["error"]) for row in front_of(document, key)]
    unit = "relative; attitude in rad" if "attitude" in document["track"] else "relative"
    for axes, (heading, own) in zip(places, panels.items(), strict=True):
        limits = _limits_x(own) if own[-1].kind == TAYLOR else shared
        axes.set(xscale="log", yscale="log", xlim=limits)
        axes.set(xlabel=_work_named(document, key), ylabel=f"largest error ({unit})")
        axes.set_title(heading, pad=4)
        _draw(axes, own, floors, front)
    return figure


def _limits_x(series: Iterable[Series]) -> Spot:
    return widened([work for line in series for work, _ in line.spots], *_MARGINS_X)


def _work_named(document: Mapping[str, Any], key: str) -> str:
    if key == "evaluations":
        return "evaluations of the equations"
    # A published time is a median of many, which the page explains.
    best = f", best of {document['timing']['repeats']}" if "timing" in document else ""
    return f"time of a solve{best} (s)"


def _draw(
    axes: Axes, series: Sequence[Series], floors: Mapping[str, float], front: Sequence[Spot]
) -> None:
    rungs = {
        line.rung: look_of(line.family, line.rung).colour for line in series if line.kind == TAYLOR
    }
    own = {rung: floors[rung] for rung in rungs if rung in floors}
    errors = [error for line in series for _, error in line.spots]
    axes.set(ylim=widened([*errors, *own.values()], *_MARGINS_Y))
    number_axes(axes)
    for rung, floor in own.items():
        axes.axhline(floor, color=rungs[rung], linewidth=0.6, dashes=(1, 2), gid="floor")
    # The yardstick comes first, and is of another kind than the panel.
    kind = series[-1].kind
    for line in series:
        look = look_of(line.family, line.rung)
        name: str | None = line.label if line.kind == kind else line.family
        for run in line.runs:
            # Thick lines are below thin ones.
            order = 4 - look.width / 10
            axes.plot(
                *zip(*run, strict=True), gid=line.family, label=name, zorder=order, **look.line
            )
            # One of its runs has the name of a family.
            name = None
    name_lines(axes)
    corners = _stairs(front, axes.get_xlim()[1], axes.get_ylim()[1])
    axes.plot(*zip(*corners, strict=True), color=QUIET, linewidth=0.6, zorder=1, gid="front")


def _stairs(front: Sequence[Spot], right: float, top: float) -> list[Spot]:
    """Return the corners of the front; settings above and to the right of it are beaten."""
    level = max(top, front[0][1])
    corners = []
    for x, y in front:
        corners += [(x, level), (x, y)]
        level = y
    return [*corners, (max(right, front[-1][0]), level)]
