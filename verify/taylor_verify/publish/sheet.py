"""A sheet: rows as CSV with one heading line, every digit in place, for a program or a spreadsheet."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final

# What a spreadsheet begins a formula with; a tab has gone with the line ends.
_FORMULA: Final = ("=", "+", "-", "@")


def sheet(names: Sequence[str], rows: Iterable[Mapping[str, Any]]) -> str:
    """A line for every row: the columns of these names, empty where a row has none.

    A text that a spreadsheet would take for a formula has an apostrophe before it: the name of a scene
    is a path, and may be anybody's.
    """
    text = io.StringIO()
    writer = csv.DictWriter(text, names, extrasaction="ignore", lineterminator="\n")
    writer.writeheader()
    writer.writerows({name: _cell(value) for name, value in row.items()} for row in rows)
    return text.getvalue()


def _cell(value: Any) -> Any:
    """A text without line ends, which readers take differently, and without the force of a formula."""
    if not isinstance(value, str):
        return value
    text = " ".join(value.split())
    return f"'{text}" if text.startswith(_FORMULA) and not _is_number(text) else text


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
