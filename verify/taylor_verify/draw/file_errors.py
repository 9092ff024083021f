"""The errors of answers against time, each quantity in a panel, beside the roundoff floor.

The answers are files, or those of one solver on several rungs; the errors are then in units of each
rung's own roundoff, in which they are alike if roundings are all. They are those that `check` judges:
against the exact motion of the same start, relative to the largest value of the motion, and in radians for
an attitude. The floor is what perfect rounding would leave. The row at the start is left out: its only
error is the rounding of the data.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import PurePath
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from taylor_verify.draw.caption import Document, NotDrawn, captioned
from taylor_verify.draw.view import Numbers
from taylor_verify.plotting.log_axes import powers_within, widened
from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.sheet import Entry, sheet
from taylor_verify.plotting.style import QUIET, look_of_line, look_of_rung
from taylor_verify.plotting.wording import plain, power_of_ten
from taylor_verify.records.quantities import is_conserved, states_among

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Row = Mapping[str, Any]

# In inches.
_HEIGHT: Final = 2.2
_FLOOR: Final[dict[str, Any]] = {"linewidth": 0.9, "dashes": (1.2, 1.6), "gid": "floor"}
# The most marks on a line.
_MARKS: Final = 12
_TITLES: Final = {"omega": "angular velocity", "impulse": "impulses", "T": "energy T"}
# A longer name of a file is cut at its beginning, in characters.
_LONGEST_NAME: Final = 28


@dataclass(frozen=True)
class Line:
    """Errors of one answer at its times, and the roundoff floor; zeros are NaN, for a logarithmic axis."""

    name: str
    times: Numbers
    errors: Numbers
    floor: Numbers


Panels = Mapping[str, Sequence[Line]]


def panels_of(records: Mapping[str, Row], start: float, *, in_roundoffs: bool = False) -> Panels:
    """Return the lines of each state quantity, then of one conserved quantity, mostly the energy.

    ``records`` are documents of the answers' records, by name. The row at ``start`` is left out.
    """
    lines_of: dict[str, list[Line]] = {}
    for name, record in records.items():
        unit = record["unit_roundoff"] if in_roundoffs else 1.0
        times = np.array(record["times"])
        for gate in record["gates"]:
            errors, floor = (
                np.where(times == start, np.nan, _above_zero(gate[what]) / unit)
                for what in ("errors", "attainable")
            )
            if np.isfinite(errors).any():
                line = Line(name, times, errors, floor)
                lines_of.setdefault(gate["quantity"], []).append(line)
    conserved = [name for name in lines_of if is_conserved(name)][:1]
    return {name: lines_of[name] for name in (*states_among(lines_of), *conserved)}


def _above_zero(values: Sequence[float | None]) -> Numbers:
    numbers = np.array(values, dtype=float)
    return np.where(np.isfinite(numbers) & (numbers > 0), numbers, np.nan)


def picture(
    document: Document, records: Mapping[str, Row], *, in_roundoffs: bool = False
) -> Picture:
    """Return the errors of all answers in one picture, beside the roundoff floor.

    ``document`` is the exact motion. ``records`` are documents of the judged answers' records, by
    the names that the picture shows: files, or rungs, whose errors are in their own roundoffs. Raises
    NotDrawn if no error is above zero.
    """
    panels = panels_of(records, document["course"]["t"][0], in_roundoffs=in_roundoffs)
    if not panels:
        raise NotDrawn(
            f"expected an error above zero to draw, got none (every row is exact, or not compared) "
            f"@ {', '.join(records)}"
        )
    unit = " u" if in_roundoffs else ""
    largest = "; ".join(
        f"{quantity} of {line.name} at most {plain(float(np.nanmax(line.errors)))}{unit}"
        for quantity, lines in panels.items()
        for line in lines
    )
    alt = f"Errors against time on {document['scene']}, logarithmic: {largest}."
    drawn = partial(_figure, panels, in_roundoffs)
    return captioned(document, "errors", "Errors in time", alt, drawn)


def _figure(panels: Panels, in_roundoffs: bool, words: str) -> Figure:
    names = list(dict.fromkeys(line.name for lines in panels.values() for line in lines))
    styles = {
        name: (look_of_rung(name) if in_roundoffs else look_of_line(k)).line
        for k, name in enumerate(names)
    }
    entries: list[Entry] = [(styles[name], _short(name)) for name in names]
    entries.append(({"color": QUIET, **_FLOOR}, "roundoff floor"))
    figure, places = sheet(len(panels), entries, words, _HEIGHT)
    for axes, (quantity, lines) in zip(places, panels.items(), strict=True):
        _draw(axes, quantity, lines, styles)
        units = ("u rad", "u") if in_roundoffs else ("rad", "relative")
        axes.set_ylabel(f"error ({units[quantity != 'attitude']})")
    return figure


def _short(name: str) -> str:
    name = PurePath(name).name
    return name if len(name) <= _LONGEST_NAME else f"…{name[1 - _LONGEST_NAME :]}"


def _draw(axes: Axes, quantity: str, lines: Sequence[Line], styles: Mapping[str, Any]) -> None:
    from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter

    for line in lines:
        look = {**styles[line.name], "markevery": max(1, len(line.times) // _MARKS)}
        axes.plot(line.times, line.errors, gid="course", zorder=3, **look)
        axes.plot(line.times, line.floor, color=look["color"], zorder=2, **_FLOOR)
    values = np.concatenate([part for line in lines for part in (line.errors, line.floor)])
    times = np.concatenate([line.times for line in lines])
    first, last = float(times.min()), float(times.max())
    aside = 0.03 * ((last - first) or 1.0)
    axes.set(yscale="log", xlabel="time t")
    axes.set(xlim=(first - aside, last + aside))
    axes.set(ylim=widened([float(v) for v in values[np.isfinite(values)]], 0.05, 0.08))
    axes.xaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
    axes.yaxis.set_major_locator(LogLocator(numticks=7))
    axes.yaxis.set_minor_formatter(NullFormatter())
    if powers_within(*axes.get_ylim()) >= 1:
        axes.yaxis.set_major_formatter(lambda value, _: power_of_ten(value))
    axes.grid(visible=True, which="major")
    axes.set_title(_TITLES.get(quantity, quantity), pad=4)
