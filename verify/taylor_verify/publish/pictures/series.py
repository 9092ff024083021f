"""The points of a trade-off by family, as a picture shows them: joined, or marked at the border."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import groupby
from math import isfinite
from typing import Any, Final

from taylor_verify.publish.pictures.style import Look, kind_of, look_of, place
from taylor_verify.records.standing import Standing

Row = Mapping[str, Any]

# What is marked at the border, and how it is read.
AT_THE_BORDER: Final = (Standing.FALSE, Standing.FAILED)


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
