"""Error of the energy beside that of the motion, each engine at its best: energy proves no motion."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import groupby
from math import inf
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.publish.pictures.log_axes import widened
from taylor_verify.publish.pictures.palette import INK, PAPER, QUIET
from taylor_verify.publish.pictures.picture import Picture
from taylor_verify.publish.pictures.sheet import (
    BELOW,
    Entry,
    Frame,
    add_axes,
    blank,
    draw_legend,
    foot_of,
)
from taylor_verify.publish.pictures.style import PAGE_WIDTH, SMALL
from taylor_verify.publish.pictures.wording import power_of_ten
from taylor_verify.studies.engines.document import Board
from taylor_verify.studies.engines.entry import EntryList
from taylor_verify.studies.engines.ranking import newest, settings

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

STEM: Final = "engines-energy"
# In inches.
_LEFT: Final = 1.95
_RIGHT: Final = 0.85
_LINE: Final = 0.19
_TOP: Final = 0.44
_NOTE: Final = (
    "Each engine with the setting and the step at which its motion is best, of all that we ran."
)
_ENERGY, _MOTION = "energy", "motion"
_MARK: Final[Mapping[str, Any]] = {"linestyle": "none", "markeredgewidth": 1.1}
_MARKS: Final[Mapping[str, Entry]] = {
    _ENERGY: (
        {
            **{**_MARK, "marker": "D", "markersize": 4.5},
            **{"markerfacecolor": PAPER, "markeredgecolor": "#0072B2"},
        },
        "error of the energy",
    ),
    _MOTION: (
        {
            **{**_MARK, "marker": "o", "markersize": 5},
            **{"markerfacecolor": "#A83C00", "markeredgecolor": "#A83C00"},
        },
        "error of the angular velocity, against the exact motion",
    ),
}


@dataclass(frozen=True)
class Line:
    """The largest errors of an engine: of the energy, and of the angular velocity."""

    name: str
    energy: float
    motion: float


def lines(board: Board, entries: EntryList, scene: str) -> list[Line]:
    """Return the engines on a scene, the one with the smallest error of the motion first."""
    titles = {row.name: row.title for row in entries.entry if not row.plain}
    found = []
    for engine, group in groupby(newest(settings(board.study)), key=lambda one: one.engine):
        rows = [row for one in group if (row := one.best(scene)) is not None]
        best = min(rows, key=lambda row: row.worst, default=None)
        if best is None or engine not in titles:
            continue
        energy, motion = (best.errors.get(name, 0.0) for name in ("T", "omega"))
        if 0 < energy < inf and 0 < motion < inf:
            found.append(Line(f"{titles[engine]} {best.version}".strip(), energy, motion))
    return sorted(found, key=lambda line: line.motion)


def pictures(board: Board, entries: EntryList) -> list[Picture]:
    """Return the picture of the first scene that all engines take; none without an engine on it.

    A motion that multiplies roundings would show the precision of an engine, and no method.
    """
    scene = entries.advised[0]
    found = lines(board, entries, scene)
    if not found:
        return []
    span = f"{board.study.spans[scene]:g} s"
    return [
        Picture(
            STEM, f"Energy and motion: {scene}", _alt(found, span), partial(_figure, found, span)
        )
    ]


def _alt(found: Sequence[Line], span: str) -> str:
    """Return the finding in words: the engine that is most wrong for all the energy that it keeps."""
    worst, best = max(found, key=lambda line: line.motion / line.energy), found[0]
    return (
        f"{_headline(found, span)}. {worst.name} keeps the energy to {_percent(worst.energy)}, and its "
        f"angular velocity is {_percent(worst.motion)} wrong. "
        f"That of {best.name} is {_percent(best.motion)} wrong."
    )


def _headline(found: Sequence[Line], span: str) -> str:
    return f"A body turns freely for {span} in {len(found)} physics engines: energy alone proves nothing"


def _figure(found: Sequence[Line], span: str) -> Figure:
    entries = list(_MARKS.values())
    foot = foot_of(entries, _NOTE)
    height = _LINE * len(found)
    figure = blank(foot + BELOW + height + _TOP)
    frame = Frame(_LEFT, foot + BELOW, PAGE_WIDTH - _LEFT - _RIGHT, height)
    axes = add_axes(figure, frame)
    axes.set(xscale="log", ylim=(len(found) - 0.5, -0.5))
    axes.set(
        xlim=widened([size for line in found for size in (line.energy, line.motion)], 0.04, 0.04)
    )
    axes.set_yticks(range(len(found)), [line.name for line in found])
    axes.xaxis.set_major_formatter(lambda value, _: power_of_ten(value))
    axes.set_xlabel("largest error (1 is 100 %)")
    axes.grid(True, axis="x", which="major")
    axes.tick_params(axis="y", length=0)
    figure.text(0.01, 0.985, _headline(found, span), va="top", weight="bold")
    axes.set_title(
        "motion wrong by", pad=4, loc="right", x=1.0 + _RIGHT / frame.width, fontsize=SMALL
    )
    for place, line in enumerate(found):
        _draw(axes, place, line)
    draw_legend(figure, entries, _NOTE)
    return figure


def _draw(axes: Axes, place: int, line: Line) -> None:
    axes.plot([line.energy, line.motion], [place, place], color=QUIET, linewidth=1.0, zorder=2)
    for key, size in ((_ENERGY, line.energy), (_MOTION, line.motion)):
        axes.plot([size], [place], zorder=3, gid=key, **_MARKS[key][0])
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
