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
from taylor_verify.studies.tradeoff.pictures.diagram import Diagram, draw_series, names_of
from taylor_verify.studies.tradeoff.pictures.series import (
    Panel,
    Series,
    panels_of,
    requests_tolerance,
    series_of,
)
from taylor_verify.studies.tradeoff.pictures.wording import names

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_X: Final = "requested_digits"
_Y: Final = "achieved_digits"
_DIAGONAL: Final[Mapping[str, Any]] = {"color": QUIET, "linewidth": 0.8}
_LEGEND: Final[list[Entry]] = [(dict(_DIAGONAL), "achieved as asked; above it, more")]


def picture(document: Mapping[str, Any]) -> Picture | None:
    """None where no setting asked for digits and got some."""
    asking = [
        Series(one.family, one.rung, tuple(row for row in one.rows if requests_tolerance(row)))
        for one in series_of(document)
    ]
    series = [one for one in asking if one.sound(_X, _Y)]
    if not series:
        return None
    alt = (
        f"Decimal digits achieved against digits asked for on {document['scene']}, with the "
        f"diagonal on which both agree, for {names(series)}. {_typical(series)}"
    )
    title = f"Digits asked for and achieved: {document['scene']}"
    return Picture(stem_of(document, "digits"), title, alt, partial(_figure, panels_of(series)))


def _typical(series: Sequence[Series]) -> str:
    """The middle of achieved less asked, of each family."""
    said = []
    for one in series:
        gained = median(row[_Y] - row[_X] for row in one.sound(_X, _Y))
        said.append(f"{one.family} {abs(gained):.1f} {'more' if gained >= 0 else 'fewer'}")
    return f"Achieved, in the median, compared with what was asked for: {', '.join(said)}."


def _figure(panels: Sequence[Panel]) -> Figure:
    from matplotlib.ticker import MaxNLocator

    from taylor_verify.publish.pictures.labels import write_names

    figure, places = sheet(len(panels), _LEGEND)
    for panel, axes in zip(panels, places, strict=True):
        most_x, most_y = _most(panel, _X), _most(panel, _Y)
        axes.set(xlim=(0, most_x * 1.22), ylim=(-0.03 * most_y, max(most_y * 1.12, 4)))
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        axes.set(
            xlabel="digits asked for, \N{MINUS SIGN}log₁₀ tolerance",
            ylabel="digits achieved",
        )
        axes.grid(True)
        axes.set_title(panel.heading, pad=4)
        most = min(axes.get_xlim()[1], axes.get_ylim()[1])
        diagonal = [(0.0, 0.0), (most, most)]
        axes.plot(*zip(*diagonal, strict=True), gid="diagonal", zorder=1, **_DIAGONAL)
        for one in panel.drawn:
            draw_series(axes, one, Diagram(_X, _Y))
        write_names(axes, names_of(panel, _X, _Y), [diagonal])
    return figure


def _most(panel: Panel, key: str) -> float:
    return max(float(row[key]) for one in panel.drawn for row in one.sound(_X, _Y))
