"""Picture of each engine's errors of energy and of motion: a good energy does not prove a right motion."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import groupby
from math import inf
from typing import TYPE_CHECKING, Final

from taylor_verify.plotting.picture import Picture
from taylor_verify_reports.pictures.dumbbells import (
    FULL,
    HOLLOW,
    Dumbbell,
    Layout,
    draw_dumbbells,
)
from taylor_verify_reports.studies.engines.document import Board
from taylor_verify_reports.studies.engines.entry import EntryList
from taylor_verify_reports.studies.engines.ranking import newest, settings

if TYPE_CHECKING:
    from matplotlib.figure import Figure

STEM: Final = "engines-energy"
_LAYOUT: Final = Layout(
    marks={
        "energy": (HOLLOW, "error of the energy"),
        "motion": (FULL, "error of the angular velocity, against the exact motion"),
    },
    left=1.95,
    right=0.85,
    axis="largest error (1 is 100 %)",
    values="motion wrong by",
    note="Each engine with the setting and the step at which its motion is best, of all that we ran.",
    heading=0.44,
)


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
    lines = [
        Dumbbell(line.name, {"energy": line.energy, "motion": line.motion}, _percent(line.motion))
        for line in drawn
    ]
    return draw_dumbbells(lines, replace(_LAYOUT, headline=_headline(drawn, span)))


def _percent(error: float) -> str:
    """Return a relative error in percent, with two digits."""
    percent = 100 * error
    if percent >= 10:
        return f"{percent:.0f} %"
    digits, _, exponent = f"{percent:.1e}".partition("e")
    return f"{percent:.2g} %" if percent >= 1e-3 else f"{digits}e{int(exponent)} %"
