"""Rows as CSV with one heading line and all digits, for programs and spreadsheets."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final

# First characters of formulas in spreadsheets; tabs are removed with the line ends.
_FORMULA: Final = ("=", "+", "-", "@")


def sheet(names: Sequence[str], rows: Iterable[Mapping[str, Any]]) -> str:
    """Return a line for every row with these columns; missing values are empty.

    A text that a spreadsheet would take for a formula gets an apostrophe in front, because the name of a
    scene may be the path of anybody's file.
    """
    text = io.StringIO()
    writer = csv.DictWriter(text, names, lineterminator="\n")
    writer.writeheader()
    writer.writerows({name: _cell(row[name]) for name in names if name in row} for row in rows)
    return text.getvalue()


def _cell(value: Any) -> Any:
    """Return a text without line ends, and never a formula of a spreadsheet."""
    if not isinstance(value, str):
        return value
    text = " ".join(value.split())
    if not text.startswith(_FORMULA):
        return text
    try:
        float(text)
    except ValueError:
        return f"'{text}"
    return text
