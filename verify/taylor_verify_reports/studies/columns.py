"""Tables by columns: a column is a heading and the function that makes a cell of a row."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeVar

from taylor_verify.words.markdown import table

Row = TypeVar("Row")
Columns = tuple[tuple[str, Callable[[Row], str]], ...]


def lay_out(columns: Columns[Row], rows: Iterable[Row]) -> str:
    """Return a Markdown table with a line for each row."""
    headings = [heading for heading, _ in columns]
    return table(headings, [[cell(row) for _, cell in columns] for row in rows])
