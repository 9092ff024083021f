"""Picture of each engine's errors of energy and of motion: a good energy does not prove a right motion."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from itertools import groupby
from math import inf
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.plotting import sheet
from taylor_verify.plotting.log_axes import widened
from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.style import INK, PAGE_WIDTH, PAPER, QUIET, SMALL
from taylor_verify.plotting.wording import power_of_ten
from taylor_verify_reports.studies.engines.document import Board
from taylor_verify_reports.studies.engines.entry import EntryList
from taylor_verify_reports.studies.engines.ranking import newest, settings

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

STEM: Final = "engines-energy"

_MARK: Final[dict[str, Any]] = {"linestyle": "none", "markeredgewidth": 1.1}
_HOLLOW: Final[dict[str, Any]] = {
    **_MARK,
    "marker": "D",
    "markersize": 4.5,
    "markerfacecolor": PAPER,
    "markeredgecolor": "#0072B2",
}
_FULL: Final[dict[str, Any]] = {
    **_MARK,
    "marker": "o",
    "markersize": 5,
    "markerfacecolor": "#A83C00",
    "markeredgecolor": "#A83C00",
}
# The two errors of a line, with their marks and meanings.
_MARKS: Final[dict[str, sheet.Entry]] = {
    "energy": (_HOLLOW, "error of the energy"),
    "motion": (_FULL, "error of the angular velocity, against the exact motion"),
}
_NOTE: Final = (
    "Each engine with the setting and the step at which its motion is best, of all that we ran."
)
# The height of a line, the heading, and the margins for names and values, in inches.
_LINE, _HEADING, _LEFT, _RIGHT = 0.19, 0.44, 1.95, 0.85


@dataclass(frozen=True)
class Line:
    """The largest errors of an engine: of the energy, and of the angular velocity."""

    name: str
    energy: float
    motion: float


def lines(board: Board, entries: EntryList, scene: str) -> list[Line]:
    """Return the engines on a scene, the one with the smallest error of the motion first."""
    titles = {row.name: row.title for row in entries.entry if not row.plain}
    drawn = []
    for engine, group in groupby(newest(settings(board.study)), key=lambda setting: setting.engine):
        rows = [row for setting in group if (row := setting.best(scene)) is not None]
        best = min(rows, key=lambda row: row.worst, default=None)
        if best is None or engine not in titles:
            continue
        energy, motion = (best.errors.get(name, 0.0) for name in ("T", "omega"))
        if 0 < energy < inf and 0 < motion < inf:
            drawn.append(Line(f"{titles[engine]} {best.version}".strip(), energy, motion))
    return sorted(drawn, key=lambda line: line.motion)


def pictures(board: Board, entries: EntryList) -> list[Picture]:
    """Return the picture of the first scene of the advice; an empty list if no engine ran there.

    The motion of that scene is regular. A motion that multiplies roundings would show the precision of an
    engine instead of its method.
    """
    scene = entries.advised[0]
    drawn = lines(board, entries, scene)
    if not drawn:
        return []
    span = f"{board.study.spans[scene]:g} s"
    return [
        Picture(
            STEM, f"Energy and motion: {scene}", _alt(drawn, span), partial(_figure, drawn, span)
        )
    ]


def _alt(drawn: Sequence[Line], span: str) -> str:
    """Return the finding in words: the engine with the worst motion in spite of a good energy."""
    worst, best = max(drawn, key=lambda line: line.motion / line.energy), drawn[0]
    return (
        f"{_headline(drawn, span)}. {worst.name} keeps the energy to {_percent(worst.energy)}, and its "
        f"angular velocity is {_percent(worst.motion)} wrong. "
        f"That of {best.name} is {_percent(best.motion)} wrong."
    )


def _headline(drawn: Sequence[Line], span: str) -> str:
    return f"A body turns freely for {span} in {len(drawn)} physics engines: energy alone proves nothing"


def _figure(drawn: Sequence[Line], span: str) -> Figure:
    """Return the figure: a line for each engine, its two errors joined by a stroke, the first on top."""
    entries = list(_MARKS.values())
    low, height = sheet.foot_of(entries, _NOTE) + sheet.BELOW, _LINE * len(drawn)
    figure = sheet.blank(low + height + _HEADING)
    width = PAGE_WIDTH - _LEFT - _RIGHT
    axes = sheet.add_axes(figure, sheet.Frame(_LEFT, low, width, height))
    errors = [error for line in drawn for error in (line.energy, line.motion)]
    axes.set(xscale="log", ylim=(len(drawn) - 0.5, -0.5), xlim=widened(errors, 0.04, 0.04))
    axes.set_yticks(range(len(drawn)), [line.name for line in drawn])
    axes.xaxis.set_major_formatter(lambda value, _: power_of_ten(value))
    axes.set_xlabel("largest error (1 is 100 %)")
    axes.grid(visible=True, axis="x", which="major")
    axes.tick_params(axis="y", length=0)
    figure.text(0.01, 0.985, _headline(drawn, span), va="top", weight="bold")
    axes.set_title("motion wrong by", pad=4, loc="right", x=1.0 + _RIGHT / width, fontsize=SMALL)
    for place, line in enumerate(drawn):
        _draw(axes, place, line)
    sheet.draw_legend(figure, entries, _NOTE)
    return figure


def _draw(axes: Axes, place: int, line: Line) -> None:
    axes.plot([line.energy, line.motion], [place, place], color=QUIET, linewidth=1.0, zorder=2)
    for key, (look, _) in _MARKS.items():
        axes.plot([getattr(line, key)], [place], zorder=3, gid=key, **look)
    axes.annotate(
        _percent(line.motion),
        (1.0, place),
        (6, 0),
        xycoords=("axes fraction", "data"),
        textcoords="offset points",
        va="center_baseline",
        size=SMALL,
        color=INK,
        annotation_clip=False,
    )


def _percent(error: float) -> str:
    """Return a relative error in percent, with two digits."""
    percent = 100 * error
    if percent >= 10:
        return f"{percent:.0f} %"
    digits, _, exponent = f"{percent:.1e}".partition("e")
    return f"{percent:.2g} %" if percent >= 1e-3 else f"{digits}e{int(exponent)} %"
