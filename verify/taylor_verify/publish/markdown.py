"""Markdown as GitHub renders it: tables, code spans and text that cannot break either."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

# A bar ends a table's cell even inside a code span.
_BAR = r"\|"
# What Markdown gives a meaning: an underscore has none inside a word.
_MEANT = re.compile(r"[\\`*\[\]<>|~&$]|(?<!\w)_|_(?!\w)")


@dataclass(frozen=True)
class Column:
    """A heading; ``to_right`` is for numbers."""

    heading: str
    to_right: bool = False


def table(asked: Sequence[Column | str], rows: Iterable[Sequence[str]]) -> str:
    """A table whose source lines up too, but for its last column, which may be long.

    A column is given by its heading, a column of numbers by its heading and a colon.
    """
    columns = [column if isinstance(column, Column) else _column(column) for column in asked]
    headings = [column.heading for column in columns]
    body = [list(row) for row in rows]
    widths = [max(3, *(len(row[i]) for row in [headings, *body])) for i in range(len(columns))]
    rules = [
        "-" * (width - 1) + (":" if column.to_right else "-")
        for width, column in zip(widths, columns, strict=True)
    ]
    rules[-1] = "--:" if columns[-1].to_right else "---"
    return "\n".join(_line(row, columns, widths) for row in [headings, rules, *body])


def _column(heading: str) -> Column:
    return Column(heading.removesuffix(":"), heading.endswith(":"))


def _line(row: Sequence[str], columns: Sequence[Column], widths: Sequence[int]) -> str:
    cells = [
        cell.rjust(width) if column.to_right else cell.ljust(width)
        for cell, column, width in zip(row, columns, widths, strict=True)
    ]
    cells[-1] = row[-1]
    return f"| {' | '.join(cells)} |"


def code(text: str) -> str:
    """A code span; as prose where it holds a backtick or backslash, which no span can escape."""
    plain = " ".join(text.split())
    if "`" in plain or "\\" in plain:
        return prose(plain)
    return f"`{plain.replace('|', _BAR)}`" if plain else ""


def prose(text: str) -> str:
    """Somebody's words on one line, none of them taken for Markdown or HTML."""
    return _MEANT.sub(r"\\\g<0>", " ".join(text.split()))


def bold(text: str) -> str:
    return f"**{text}**"


def bullets(items: Iterable[str]) -> str:
    return "\n".join(f"- {item}" for item in items)
