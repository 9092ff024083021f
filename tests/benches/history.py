"""The ratios that were kept, a row for each in a file of the repository, the latest last."""

from __future__ import annotations

import csv
import subprocess
from collections.abc import Iterable
from dataclasses import astuple, dataclass, fields
from datetime import UTC, datetime
from pathlib import Path
from typing import Final

from benches.ratio import RESOLUTION
from benches.suite import Measured
from taylor_verify.records.version import __version__

FILE: Final = Path(__file__).with_name("history.csv")


@dataclass(frozen=True)
class Row:
    """A ratio as it was on a day, of a commit, on a processor; ``cost`` is in seconds or bytes."""

    date: str
    commit: str
    version: str
    processor: str
    name: str
    ratio: float
    spread: float
    cost: float


_HEADER: Final = [field.name for field in fields(Row)]
_NUMBERS: Final = ("ratio", "spread", "cost")


def last(file: Path, processor: str) -> dict[str, Row]:
    """Return the latest row of each ratio on a processor, by its name."""
    if not file.exists():
        return {}
    with file.open(encoding="utf-8", newline="") as lines:
        rows = [
            Row(**cells | {name: float(cells[name]) for name in _NUMBERS})
            for cells in csv.DictReader(lines)
        ]
    return {row.name: row for row in rows if row.processor == processor}


def keep(measured: Iterable[Measured], file: Path, processor: str, commit: str) -> None:
    """Append the ratios to the history, which begins with its header."""
    date = datetime.now(UTC).date().isoformat()
    rows = [
        Row(
            *(date, commit, __version__, processor, one.ratio.name),
            *(float(f"{number:.4g}") for number in (one.value, one.spread, one.cost)),
        )
        for one in measured
    ]
    is_new = not file.exists()
    with file.open("a", encoding="utf-8", newline="") as lines:
        writer = csv.writer(lines, lineterminator="\n")
        writer.writerows([_HEADER] if is_new else [])
        writer.writerows(map(astuple, rows))


def has_moved(now: Measured, row: Row) -> bool:
    """Return True if a ratio is farther from the last than both spreads, and the resolution, explain."""
    apart = abs(now.value - row.ratio)
    return not apart <= max(now.spread + row.spread, RESOLUTION * row.ratio)


def commit() -> str:
    """Return the commit that is checked out, with a plus where files differ from it; empty without git."""
    asked = ["git", "describe", "--always", "--exclude", "*", "--dirty=+"]
    done = subprocess.run(
        asked, cwd=Path(__file__).parent, capture_output=True, text=True, check=False
    )
    return done.stdout.strip()
