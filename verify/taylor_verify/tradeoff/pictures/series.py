"""Points of a trade-off by family for pictures, and the panels of the families."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from math import isfinite
from typing import Any, Final

from taylor_verify.plotting.style import TAYLOR, Look, heading_of, kind_of, look_of, place
from taylor_verify.records.standing import Standing
from taylor_verify.tradeoff.document import label
from taylor_verify.tradeoff.pareto import pareto

Row = Mapping[str, Any]

# The standings that are marked at the border.
AT_THE_BORDER: Final = (Standing.FALSE, Standing.FAILED)

# The most lines of a legible panel: if it has all solvers but taylor, and if it has one kind.
_ALL_IN_ONE: Final = 6
_MOST: Final = 7


@dataclass(frozen=True)
class Spot:
    """A setting in a picture: its numbers along both axes, zero for a missing number.

    ``spread`` is the slowest time over the fastest.
    """

    row: Row
    x: float
    y: float
    spread: float = 1.0

    @property
    def is_sound(self) -> bool:
        """True for a sound answer with numbers that a logarithmic axis can show."""
        return self.row["standing"] == Standing.SOUND and self.x > 0 and self.y > 0

    @property
    def is_exact(self) -> bool:
        """True for a sound answer without any error, which a logarithmic axis cannot show."""
        return self.row["standing"] == Standing.SOUND and self.x > 0 and self.row["error"] == 0

    @property
    def is_at_the_border(self) -> bool:
        """True for a failure or a false success whose work is known."""
        return self.row["standing"] in AT_THE_BORDER and self.x > 0

    @property
    def label(self) -> str:
        """The name of the setting in the output of `tradeoff`."""
        return label(self.row["solver"], self.row["setting"], self.row["rung"])


@dataclass(frozen=True)
class Series:
    """A family on a rung: its settings from the coarsest to the finest."""

    family: str
    rung: str
    spots: tuple[Spot, ...]

    @property
    def look(self) -> Look:
        return look_of(self.family, self.rung)

    @property
    def kind(self) -> str:
        return kind_of(self.family)

    @property
    def label(self) -> str:
        """The name of the family without its kind, which is the heading of the panel."""
        first, _, rest = self.family.partition(" ")
        return rest if rest and first == self.kind else self.family

    @property
    def pieces(self) -> list[list[Spot]]:
        """The sequences of neighbouring sound settings, which lines join."""
        runs = groupby(self.spots, key=lambda spot: spot.is_sound)
        return [list(spots) for is_sound, spots in runs if is_sound]

    @property
    def sound(self) -> list[Spot]:
        """The sound settings that an axis can show."""
        return [spot for spot in self.spots if spot.is_sound]

    @property
    def border(self) -> list[Spot]:
        """The failures and false successes, which are marked at the border."""
        return [spot for spot in self.spots if spot.is_at_the_border]


def series_of(document: Mapping[str, Any], x: str) -> list[Series]:
    """Return the families of a trade-off that were run, in the order of `style.place`.

    ``x`` is the key of the rows for the horizontal axis; the error is along the other one.
    """
    spots: dict[tuple[str, str], list[Spot]] = {}
    for row in document["points"]:
        spread = row["spread"] if x == "seconds" else None
        spot = Spot(row, _amount(row, x), _amount(row, "error"), spread or 1.0)
        spots.setdefault((row["family"], row["rung"]), []).append(spot)
    every = [Series(family, rung, tuple(own)) for (family, rung), own in spots.items()]
    ran = [line for line in every if any(s.row["standing"] != Standing.NOT_RUN for s in line.spots)]
    return sorted(ran, key=lambda line: (place(line.family, line.rung), line.rung))


def _amount(row: Row, key: str) -> float:
    """Return a number of the row if it is positive and finite, else 0.

    A run that is not sound has the time of its only solve.
    """
    value = row.get(key)
    if value is None and key == "seconds" and row["standing"] != Standing.SOUND:
        value = row.get("first_seconds")
    return value if value is not None and isfinite(value) and value > 0 else 0


def front_of(series: Iterable[Series]) -> list[Spot]:
    """Return the sound spots that no other beats in both numbers, by rising x and falling y."""
    sound = [spot for line in series for spot in line.sound]
    return pareto(sound, lambda spot: (spot.x, spot.y))


# Panels


@dataclass(frozen=True)
class Panel:
    """The families of one panel with its heading; ``yardstick`` is drawn with them."""

    heading: str
    series: tuple[Series, ...]
    yardstick: Series | None = None

    def label(self, series: Series) -> str:
        """Return the name of a family, in full if the heading does not name its kind."""
        is_named = {series.kind} == {line.kind for line in self.series}
        return series.label if is_named else series.family

    @property
    def drawn(self) -> tuple[Series, ...]:
        """All families of the panel, the yardstick first."""
        return (self.yardstick, *self.series) if self.yardstick else self.series

    @property
    def sound(self) -> list[Spot]:
        """The sound settings of all families of the panel."""
        return [spot for line in self.drawn for spot in line.sound]

    @property
    def ladder(self) -> dict[str, str]:
        """The colour of each rung of taylor in the panel."""
        return {line.rung: line.look.colour for line in self.drawn if line.kind == TAYLOR}


def panels_of(series: Sequence[Series]) -> list[Panel]:
    """Return a panel of taylor on all rungs, and panels of the other solvers with taylor on f64."""
    ladder = tuple(line for line in series if line.kind == TAYLOR)
    others = [line for line in series if line.kind != TAYLOR]
    # Taylor on a single rung needs no panel of its own, and is drawn with the others.
    is_alone = len(ladder) == 1 and bool(others)
    f64 = next((line for line in ladder if line.rung == "f64"), ladder[0] if is_alone else None)
    panels = [] if is_alone or not ladder else [Panel(heading_of(TAYLOR), ladder)]
    return panels + [Panel(heading, group, f64) for heading, group in _groups(others)]


def _groups(others: Sequence[Series]) -> list[tuple[str, tuple[Series, ...]]]:
    """Return the families by heading: all together if they are few, else each kind by itself."""
    if 0 < len(others) <= _ALL_IN_ONE:
        kinds = list(dict.fromkeys(heading_of(line.kind) for line in others))
        return [(kinds[0] if len(kinds) == 1 else "other solvers", tuple(others))]
    kinds_apart = [tuple(group) for _, group in groupby(others, key=lambda line: line.kind)]
    return [part for group in kinds_apart for part in _parts(group)]


def _parts(group: tuple[Series, ...]) -> Iterator[tuple[str, tuple[Series, ...]]]:
    """Yield a group with its heading, in equal parts if it is too large to be legible."""
    heading = heading_of(group[0].kind)
    count = -(-len(group) // _MOST)
    size = -(-len(group) // count)
    for i in range(count):
        number = f" ({i + 1} of {count})" if count > 1 else ""
        yield heading + number, group[i * size : (i + 1) * size]
