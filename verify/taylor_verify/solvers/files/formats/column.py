"""A column of a trajectory file as it is written, and the limits of what is read.

Every format holds a file to these limits before it makes anything of its content.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, Final, NamedTuple

from taylor_verify.records.faults import Faults, Refused, cut
from taylor_verify.records.limit import Limit
from taylor_verify.scenes.reading.time_table import MOST_SAMPLES

ROWS: Final = Limit(MOST_SAMPLES, "rows", "no scene has more samples")
VALUES: Final = Limit(
    22 * MOST_SAMPLES,
    "values",
    "t, w, x, y, R and c in as many rows as a scene has samples at most",
)
BYTES: Final = Limit(
    2**29, "bytes", "a million rows of t, x, y, q and c in hexadecimal floats take 350 MB"
)
COLUMNS: Final = Limit(
    1000, "columns", "a trajectory has 22, and a logger some hundreds beside them"
)
CHARACTERS: Final = Limit(4000, "characters in a number", "beyond them none is read")
LINE: Final = Limit(2**20, "characters in a line", "a thousand columns of a thousand each")
LINES: Final = Limit(4_000_000, "lines", "a million rows, and comments between them")
KEYS: Final = Limit(100_000, "keys and brackets", "a column has one of each")
CHUNK_BYTES: Final = Limit(2**26, "bytes in a packed part", "writers pack a few megabytes at once")
ELEMENTS: Final = Limit(4_000_000, "elements", "a state of an ephemeris has ten: ten seconds")

# Entries of a column that are worked on at once.
CHUNK: Final = 4096
_MOST_ALIKE: Final = 3
MOST_LISTED: Final = 8


class Column(NamedTuple):
    """A name and its entries: a list, or an array of NumPy, of texts or of numbers."""

    name: str
    values: Sequence[Any]


class Table(NamedTuple):
    """The columns of a file, and sentences that say how its format was read."""

    columns: list[Column]
    notes: tuple[str, ...] = ()


class Ragged(Refused):
    """The refusal of rows that are longer or shorter than the others: in ``table`` they are as long."""

    def __init__(self, faults: Sequence[str], table: Table) -> None:
        super().__init__(faults)
        self.table = table


def check_size(columns: int, rows: int, place: object) -> None:
    """Raise Refused for a file of more columns, rows or values than are read."""
    COLUMNS.check(columns, place)
    ROWS.check(rows, place)
    VALUES.check(columns * rows, place)


@contextmanager
def alike(faults: Faults, place: str) -> Iterator[Callable[[str, str, str], None]]:
    """Add the first three of the block's faults of one kind, and the number of the others."""
    count = 0

    def add(expected: str, got: str, at: str) -> None:
        nonlocal count
        count += 1
        if count <= _MOST_ALIKE:
            faults.add(expected, got, at)

    yield add
    if count > _MOST_ALIKE:
        faults.lines.append(f"and {count - _MOST_ALIKE} more of this kind @ {place}")


def listed(texts: Sequence[str], most: int = MOST_LISTED, between: str = ", ") -> str:
    """Return the first texts in one line, and the number of the others."""
    more = f" and {len(texts) - most} more" if len(texts) > most else ""
    return between.join(texts[:most]) + more


def shown(value: object) -> str:
    """Return a value as its file writes it, cut short where it is long."""
    if value is None or isinstance(value, bool):
        return json.dumps(value)
    return cut(repr(value) if isinstance(value, str) else str(value))
