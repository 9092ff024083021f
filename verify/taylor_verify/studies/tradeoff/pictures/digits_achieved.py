"""Digits asked for against digits achieved: on the diagonal a tolerance means what it says."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from statistics import median
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.publish.pictures.palette import QUIET
from taylor_verify.publish.pictures.picture import Picture
from taylor_verify.publish.pictures.sheet import Entry, sheet
from taylor_verify.publish.pictures.wording import stem_of
from taylor_verify.studies.tradeoff.pictures.diagram import draw_series, names_of
from taylor_verify.studies.tradeoff.pictures.series import Panel, Series, panels_of, series_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_DIAGONAL: Final[Mapping[str, Any]] = {"color": QUIET, "linewidth": 0.8}
_LEGEND: Final[list[Entry]] = [(dict(_DIAGONAL), "achieved as asked; above it, more")]


def picture(document: Mapping[str, Any]) -> Picture | None:
    """Return the picture; None where no setting asked for digits and got some."""
    asking = [row for row in document["points"] if row["asked"] == "tolerance"]
    every = series_of({**document, "points": asking}, "requested_digits", "achieved_digits")
    series = [one for one in every if one.sound]
    if not series:
        return None
    alt = (
        f"Decimal digits achieved against digits asked for on {document['scene']}, with the "
        f"diagonal on which both agree, for {names(series)}. {_typical(series)}"
    )
    title = f"Digits asked for and achieved: {document['scene']}"
    return Picture(stem_of(document, "digits"), title, alt, partial(_figure, panels_of(series)))


def names(series: Sequence[Series]) -> str:
    """Return the names of the families as a sentence lists them."""
    *others, last = (one.family for one in series)
    return f"{', '.join(others)} and {last}" if others else last


def _typical(series: Sequence[Series]) -> str:
    """Return the median of achieved less asked, of each family."""
    said = []
    for one in series:
        gained = median(spot.y - spot.x for spot in one.sound)
        said.append(f"{one.family} {abs(gained):.1f} {'more' if gained >= 0 else 'fewer'}")
    return f"Achieved, in the median, compared with what was asked for: {', '.join(said)}."


def _figure(panels: Sequence[Panel]) -> Figure:
    from matplotlib.ticker import MaxNLocator

    from taylor_verify.publish.pictures.labels import write_names

    figure, places = sheet(len(panels), _LEGEND)
    for panel, axes in zip(panels, places, strict=True):
        most_x, most_y = max(s.x for s in panel.sound), max(s.y for s in panel.sound)
        axes.set(xlim=(0, most_x * 1.22), ylim=(-0.03 * most_y, max(most_y * 1.12, 4)))
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        axes.set(xlabel="digits asked for, \N{MINUS SIGN}log₁₀ tolerance", ylabel="digits achieved")
        axes.grid(True)
        axes.set_title(panel.heading, pad=4)
        most = min(axes.get_xlim()[1], axes.get_ylim()[1])
        diagonal = [(0.0, 0.0), (most, most)]
        axes.plot(*zip(*diagonal, strict=True), gid="diagonal", zorder=1, **_DIAGONAL)
        for one in panel.drawn:
            draw_series(axes, one)
        write_names(axes, names_of(panel), [diagonal])
    return figure
