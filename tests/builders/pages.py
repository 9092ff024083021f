"""The tables of the pages of docs."""

from __future__ import annotations

from builders.worked import DOCS


def table_rows(page: str) -> list[list[str]]:
    """The cells of every line of a table of a page of docs, heads and rules included."""
    text = (DOCS / page).read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if line.startswith("| ")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
