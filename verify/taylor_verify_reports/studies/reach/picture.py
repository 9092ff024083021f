"""Maps of the digits left, over the distance to a separatrix and the periods.

Each rung has two maps: achieved and attainable digits. A cell is a run up to a number of periods; it
shows whole decimal digits. Its lightness is a class of the legend, so that the map is readable in grey.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise, product, takewhile
from math import floor, log10
from typing import TYPE_CHECKING, Final

from taylor_verify.plotting.palette import FAINT, INK, PAPER, QUIET, contrast
from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.sheet import Frame, add_axes, blank
from taylor_verify.plotting.style import PAGE_WIDTH, SMALL
from taylor_verify.plotting.wording import power_of_ten
from taylor_verify_reports.studies.reach.document import ReachFamily, ReachRow

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# The least digits of each class, and its colour: one hue, darker by equal steps.
CLASSES: Final = (
    (0, "#FFFFFF"),
    (1, "#DCE9F5"),
    (3, "#A9CCE8"),
    (6, "#6CA6D4"),
    (12, "#2F78B4"),
    (24, "#0B3F73"),
)
ACHIEVED, ATTAINABLE = "errors", "floors"
_HEADINGS: Final = {ACHIEVED: "achieved", ATTAINABLE: "attainable"}

# In inches.
_LEFT: Final = 0.78
_NAMES: Final = -0.34
_BETWEEN: Final = 0.12
_RIGHT: Final = 0.06
_CELL: Final = 0.135
_TOP: Final = 0.3
_GAP: Final = 0.14
_BELOW: Final = 0.42
_LEGEND: Final = 0.34
_NUMBER: Final = 5.5
_MOST_NAMES: Final = 7


def numbers_of(row: ReachRow, key: str) -> tuple[float | None, ...]:
    """Return the errors that were achieved, or those that were attainable."""
    return row.errors if key == ACHIEVED else row.floors


def picture(family: ReachFamily, rows: Sequence[ReachRow]) -> Picture:
    """Return the map of a family from its own rows. Raises ValueError without rows."""
    every = [_Map.of(family, rung, rows) for rung in family.rungs]
    maps = [panel for panel in every if panel.periods]
    if not maps:
        raise ValueError(f"expected runs of the family, got none @ {family.name}")
    alt = (
        f"Decimal digits left of {family.title}, over {family.symbol} from "
        f"{family.values[0]} to {family.values[-1]} and the periods, for each rung: achieved "
        f"by taylor, and attainable beside it. {' '.join(panel.sentence for panel in maps)}"
    )
    title = f"Digits left: {family.name}"
    return Picture(f"reach-{family.name}", title, alt, partial(_figure, family, maps))


@dataclass(frozen=True)
class _Map:
    """The map of a rung: digits achieved and attainable, of each value and number of periods.

    The keys of ``cells`` are value, periods, and ACHIEVED or ATTAINABLE; a missing key was not run.
    """

    rung: str
    values: tuple[str, ...]
    periods: tuple[int, ...]
    cells: Mapping[tuple[str, int, str], int]

    @classmethod
    def of(cls, family: ReachFamily, rung: str, rows: Sequence[ReachRow]) -> _Map:
        own = [row for row in rows if row.rung == rung and row.errors]
        cells = {
            (row.value, count, key): digits_of(error)
            for row in own
            for key in (ACHIEVED, ATTAINABLE)
            for count, error in zip(row.periods, numbers_of(row, key), strict=False)
        }
        periods = tuple(sorted({count for row in own for count in row.periods}))
        return cls(rung, family.values, periods, cells)

    @property
    def sentence(self) -> str:
        """The values up to which six digits are left, in words."""
        limits = []
        for n in sorted({self.periods[0], self.periods[-1]}):
            precise = [self.cells.get((value, n, ACHIEVED), 0) >= 6 for value in self.values]
            last = ("none of these", *self.values)[sum(takewhile(bool, precise))]
            limits.append(f"after {n} {'period' if n == 1 else 'periods'} up to {last}")
        return f"On {self.rung} six digits are left {' and '.join(limits)}."


def digits_of(error: float | None) -> int:
    """Return the whole decimal digits that an error leaves; 0 for NaN and None, which is a lost motion."""
    if error is None or not error < 1:
        return 0
    # An error of zero leaves all digits of a double.
    return floor(-log10(error)) if error > 0 else 307


def _figure(family: ReachFamily, maps: Sequence[_Map]) -> Figure:
    heights = [_CELL * len(panel.periods) for panel in maps]
    height = _TOP + sum(heights) + _GAP * (len(maps) - 1) + _BELOW + _LEGEND
    figure = blank(height)
    width = (PAGE_WIDTH - _LEFT - _BETWEEN - _RIGHT) / 2
    top = height - _TOP
    for panel, own in zip(maps, heights, strict=True):
        for column, key in enumerate((ACHIEVED, ATTAINABLE)):
            left = _LEFT + column * (width + _BETWEEN)
            axes = add_axes(figure, Frame(left, top - own, width, own))
            _draw_cells(axes, panel, key)
            if panel is maps[0]:
                axes.set_title(_HEADINGS[key], pad=5)
            if panel is maps[-1]:
                # There is room for a few names only.
                values = family.values
                shown = range(0, len(values), -(-len(values) // _MOST_NAMES))
                axes.set_xticks(list(shown), [power_of_ten(float(values[i])) for i in shown])
                axes.set_xlabel(f"{family.symbol}: towards {family.extreme}", size=SMALL)
            if column == 0:
                names = [str(n) if n < 1000 else power_of_ten(n) for n in panel.periods]
                axes.set_yticks(range(len(names)), names)
                axes.set_ylabel(f"{panel.rung}\nperiods", size=SMALL)
                axes.yaxis.set_label_coords(_NAMES / width, 0.5)
        top -= own + _GAP
    _draw_legend(figure)
    return figure


def _draw_cells(axes: Axes, panel: _Map, key: str) -> None:
    from matplotlib.patches import Rectangle

    axes.set(xlim=(-0.5, len(panel.values) - 0.5), ylim=(-0.5, len(panel.periods) - 0.5))
    axes.set(xticks=[], yticks=[])
    axes.tick_params(length=0)
    for spine in axes.spines.values():
        spine.set_visible(True)
    for (x, value), (y, count) in product(enumerate(panel.values), enumerate(panel.periods)):
        digits = panel.cells.get((value, count, key))
        cell = Rectangle((x - 0.5, y - 0.5), 1, 1, edgecolor=FAINT)
        axes.add_patch(cell)
        if digits is None:
            cell.set(facecolor=PAPER, hatch="////", linewidth=0.0, gid="not run")
            continue
        colour = next(colour for least, colour in reversed(CLASSES) if digits >= least)
        cell.set(facecolor=colour, linewidth=0.4, gid="cell")
        axes.text(
            x,
            y,
            str(digits),
            size=_NUMBER,
            ha="center",
            va="center_baseline",
            color=text_on(colour) if digits else QUIET,
            gid=f"{panel.rung} {_HEADINGS[key]} {value} {count}",
        )


def text_on(colour: str) -> str:
    """Return the colour of a text on ``colour``: ink or paper, whichever has more contrast."""
    return max((INK, PAPER), key=lambda text: contrast(text, colour))


def _draw_legend(figure: Figure) -> None:
    """Draw the classes in a line at the foot."""
    from matplotlib.patches import Rectangle

    axes = add_axes(figure, Frame(_LEFT, 0.06, PAGE_WIDTH - _LEFT - _RIGHT, 0.16))
    axes.set(xlim=(0, len(CLASSES) + 2.2), ylim=(0, 1))
    axes.axis("off")
    axes.text(0, 0.5, "digits left", size=SMALL, va="center_baseline", color=INK)
    words = [f"{least}\N{EN DASH}{beyond - 1}" for (least, _), (beyond, _) in pairwise(CLASSES)]
    words = ["none", *words[1:], f"{CLASSES[-1][0]} and more"]
    for i, ((_, colour), name) in enumerate(zip(CLASSES, words, strict=True)):
        left = 1.2 + i
        axes.add_patch(
            Rectangle((left, 0), 0.24, 1, facecolor=colour, edgecolor=QUIET, linewidth=0.5)
        )
        axes.text(left + 0.3, 0.5, name, size=SMALL, va="center_baseline", color=INK)
