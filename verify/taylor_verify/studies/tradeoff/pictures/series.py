"""The points of a trade-off by family, as pictures show them, and which families share a panel."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from math import isfinite
from typing import Any, Final

from taylor_verify.publish.pictures.style import TAYLOR, Look, heading_of, kind_of, look_of, place
from taylor_verify.records.standing import Standing

Row = Mapping[str, Any]

# What is marked at the border, and how it is read.
AT_THE_BORDER: Final = (Standing.FALSE, Standing.FAILED)

# Beyond these a panel is hard to read: all but taylor in one panel, and any in one.
_ALL_IN_ONE: Final = 6
_MOST: Final = 7


@dataclass(frozen=True)
class Series:
    """One family on one rung, its rows from the coarsest setting to the finest."""

    family: str
    rung: str
    rows: tuple[Row, ...]

    @property
    def look(self) -> Look:
        return look_of(self.family, self.rung)

    @property
    def kind(self) -> str:
        return kind_of(self.family)

    @property
    def label(self) -> str:
        """What a reader calls it: without the kind, which stands above the panel."""
        first, _, rest = self.family.partition(" ")
        return rest if rest and first == self.kind else self.family

    def pieces(self, x: str, y: str) -> list[list[Row]]:
        """Runs of neighbours that are sound and have both numbers: what a line may join."""
        found = []
        for drawable, rows in groupby(self.rows, key=lambda row: is_sound(row, x, y)):
            if drawable:
                found.append(list(rows))
        return found

    def sound(self, x: str, y: str) -> list[Row]:
        return [row for piece in self.pieces(x, y) for row in piece]

    def is_seen(self, x: str, y: str) -> bool:
        """Whether there is anything of it to draw."""
        return bool(self.sound(x, y) or self.at_the_border(x))

    def at_the_border(self, x: str) -> list[Row]:
        """What failed or claimed a false success, where it is known what that took."""
        return [row for row in self.rows if row["standing"] in AT_THE_BORDER and amount(row, x)]


def series_of(document: Mapping[str, Any]) -> list[Series]:
    """The families of a trade-off that ran, in the order of `style.place`."""
    rows: dict[tuple[str, str], list[Row]] = {}
    for row in document["points"]:
        rows.setdefault((row["family"], row["rung"]), []).append(row)
    found = [Series(family, rung, tuple(its)) for (family, rung), its in rows.items()]
    ran = [one for one in found if any(row["standing"] != Standing.NOT_RUN for row in one.rows)]
    return sorted(ran, key=lambda one: (place(one.family, one.rung), one.rung))


def is_sound(row: Row, x: str, y: str) -> bool:
    """Whether a row is worth a point: sound, and with numbers that a logarithmic axis can show."""
    return row["standing"] == Standing.SOUND and bool(amount(row, x)) and bool(amount(row, y))


def amount(row: Row, key: str) -> float | None:
    """A positive finite number of the row, or None; a failed run's time is that of its only solve."""
    value = row.get(key)
    if value is None and key == "seconds" and row["standing"] != Standing.SOUND:
        value = row.get("first_seconds")
    return value if value is not None and isfinite(value) and value > 0 else None


def front_of(rows: Iterable[Row], x: str, y: str) -> list[Row]:
    """The sound rows that no other beats in both, by x; y falls from each to the next."""
    found: list[Row] = []
    sound = [row for row in rows if is_sound(row, x, y)]
    for row in sorted(sound, key=lambda row: (row[x], row[y])):
        if not found or row[y] < found[-1][y]:
            found.append(row)
    return found


def requests_tolerance(row: Row) -> bool:
    """Whether digits were asked for: a step asks for none."""
    return bool(row["asked"] == "tolerance" and row.get("requested_digits"))


# Panels


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
