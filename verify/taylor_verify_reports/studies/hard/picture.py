"""Picture of the digits left beside an unstable motion: over the distance from it, a line for each rung."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from math import log10
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.sheet import sheet
from taylor_verify.plotting.style import look_of_rung
from taylor_verify.plotting.wording import power_of_ten
from taylor_verify_reports.studies.hard.hard_scenes import (
    ACHIEVED,
    ATTAINABLE,
    HardStudy,
    ReachFamily,
    ReachRow,
    last_value,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Digits that an error of zero leaves: all of a double.
_ALL_DIGITS: Final = 307.0
_MOST_NAMES: Final = 6
_NOTE: Final = "After one period. Marks: achieved. Thin dashes: what perfect rounding would leave."


@dataclass(frozen=True)
class Line:
    """A family on a rung: its rows, the easiest value first, of which some have no numbers."""

    family: ReachFamily
    rung: str
    rows: Sequence[ReachRow]

    def points(self, key: str) -> list[tuple[float, float]]:
        """Return the values with the digits left after the first number of periods."""
        return [
            (float(row.value), digits_left(numbers[0]))
            for row in self.rows
            if (numbers := getattr(row, key))
        ]


def lines(study: HardStudy) -> list[Line]:
    """Return a line for each family and rung."""
    return [
        Line(family, rung, study.reach_of(family.name, rung))
        for family in study.families
        for rung in family.rungs
    ]


def pictures(study: HardStudy) -> list[Picture]:
    """Return the picture of all families with a symbol; none if none of them was run."""
    drawn = [line for line in lines(study) if line.family.symbol and line.points(ACHIEVED)]
    if not drawn:
        return []
    sentences = [
        f"{line.family.title}, {line.rung}: six digits up to {last_value(line.rows, 1, 6) or 'no value'}"
        for line in drawn
    ]
    alt = f"Digits left after one period against the distance d. {'; '.join(sentences)}."
    title = "Digits left near an unstable motion"
    return [Picture("hard-reach", title, alt, partial(_figure, drawn))]


def digits_left(error: float | None) -> float:
    """Return the decimal digits that an error leaves; 0 for NaN and None, which is a lost motion."""
    if error is None or not error < 1:
        return 0.0
    return -log10(error) if error > 0 else _ALL_DIGITS


def _figure(drawn: Sequence[Line]) -> Figure:
    families = {line.family.name: line.family for line in drawn}
    styles: dict[str, dict[str, Any]] = {line.rung: look_of_rung(line.rung).line for line in drawn}
    figure, places = sheet(len(families), [(style, rung) for rung, style in styles.items()], _NOTE)
    for axes, family in zip(places, families.values(), strict=True):
        axes.set(xscale="log", xlabel=family.symbol, ylabel="digits left")
        axes.set_title(family.name, pad=4)
        for line in (line for line in drawn if line.family == family):
            axes.plot(*zip(*line.points(ACHIEVED), strict=True), gid=line.rung, **styles[line.rung])
            axes.plot(
                *zip(*line.points(ATTAINABLE), strict=True),
                gid=f"{line.rung} {ATTAINABLE}",
                color=styles[line.rung]["color"],
                linewidth=0.7,
                dashes=(4, 2),
                zorder=1,
            )
        values = [float(value) for value in family.values][:: -(-len(family.values) // _MOST_NAMES)]
        axes.set_xticks(values, [power_of_ten(value) for value in values])
        axes.minorticks_off()
        axes.invert_xaxis()
        axes.set_ylim(bottom=-0.5)
        axes.grid(visible=True, which="major")
    return figure
