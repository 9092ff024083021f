"""Which families share a panel, and where on the page each panel stands."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Final

from taylor_verify.publish.pictures.series import Series
from taylor_verify.publish.pictures.style import PAGE_WIDTH, TAYLOR, heading_of

# Beyond these a panel is hard to read: all but taylor in one panel, and any in one.
_ALL_IN_ONE: Final = 6
_MOST: Final = 7

# Lengths in inches: the columns beside a panel hold numbers and a name, the rows below them too.
LEFT: Final = 0.66
RIGHT: Final = 0.08
HEADING: Final = 0.26
BELOW: Final = 0.46
HEIGHT: Final = 2.35
# Of a line of the legend, and below the last.
LINE: Final = 0.2
FOOT: Final = 0.06
# Of a family's line in the strip above a panel.
STRIP: Final = 0.15


@dataclass(frozen=True)
class Frame:
    """Where a panel stands, in inches from the lower left corner of the figure."""

    left: float
    low: float
    width: float
    height: float


@dataclass(frozen=True)
class Panel:
    """The families of one panel under their heading; ``yardstick`` is drawn with them."""

    heading: str
    series: tuple[Series, ...]
    yardstick: Series | None = None

    def label(self, series: Series) -> str:
        """What the family is called here: in full where the heading does not say its kind."""
        mixed = len({one.kind for one in self.series}) > 1 or series.kind != self.series[0].kind
        return series.family if mixed else series.label

    @property
    def drawn(self) -> tuple[Series, ...]:
        return (*((self.yardstick,) if self.yardstick else ()), *self.series)


def panels_of(series: Sequence[Series]) -> list[Panel]:
    """taylor by rung in one panel; the others, with its f64 beside them, in one or by kind."""
    ladder = tuple(one for one in series if one.kind == TAYLOR)
    others = [one for one in series if one.kind != TAYLOR]
    yardstick = next((one for one in ladder if one.rung == "f64"), None)
    found = []
    if len(ladder) > 1 or not others:
        found.append(Panel(heading_of(TAYLOR), ladder))
        alone = None
    else:
        # One rung of taylor alone is no ladder: it stands among the others.
        alone = next(iter(ladder), None)
    for heading, group in _groups(others):
        found.append(Panel(heading, group, yardstick or alone))
    return [panel for panel in found if panel.drawn]


def _groups(others: Sequence[Series]) -> list[tuple[str, tuple[Series, ...]]]:
    """The families by heading: all together where they are few, else each kind by itself."""
    if 0 < len(others) <= _ALL_IN_ONE:
        kinds = list(dict.fromkeys(heading_of(one.kind) for one in others))
        return [(kinds[0] if len(kinds) == 1 else "other solvers", tuple(others))]
    kinds_apart = [tuple(group) for _, group in groupby(others, key=lambda one: one.kind)]
    return [found for group in kinds_apart for found in _parts(group)]


def _parts(group: tuple[Series, ...]) -> Iterator[tuple[str, tuple[Series, ...]]]:
    """The group, or as many even parts of it as keep each legible."""
    heading = heading_of(group[0].kind)
    count = -(-len(group) // _MOST)
    size = -(-len(group) // count)
    for i in range(count):
        number = f" ({i + 1} of {count})" if count > 1 else ""
        yield heading + number, group[i * size : (i + 1) * size]


def columns(count: int) -> int:
    return 1 if count == 1 else 2


def width_of(count: int) -> float:
    """Of one panel, in inches."""
    return (PAGE_WIDTH - columns(count) * (LEFT + RIGHT)) / columns(count)
