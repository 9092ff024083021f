"""Markdown as GitHub renders it: tables, code spans and text that cannot break either."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

# A bar ends a cell of a table even inside a code span.
_BAR = r"\|"
# Characters with a meaning in Markdown; an underscore has none inside a word.
_MEANT = re.compile(r"[\\`*\[\]<>|~&$]|(?<!\w)_|_(?!\w)")
# Blanks would be half of a longer table, and nobody reads its text as it stands.
_ALIGNED = 40
_MARK = re.compile(r"\\(.)|[*`]")


def table(headings: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table with aligned columns, except the last one, which may be long, and all of a long table.

    A heading that ends with a colon marks a column of numbers, which are aligned to the right.
    """
    is_number = [heading.endswith(":") for heading in headings]
    first, *body = [[heading.removesuffix(":") for heading in headings], *rows]
    aligned = [first, *body] if len(body) < _ALIGNED else [[""] * len(first)]
    widths = [max([3, *map(len, column)]) for column in zip(*aligned, strict=True)]
    rule = ["-" * (width - 1) + "-:"[right] for width, right in zip(widths, is_number, strict=True)]
    rule[-1], widths[-1] = rule[-1][-3:], 0
    return "\n".join(_line(row, widths, is_number) for row in [first, rule, *body])


def _line(row: Sequence[str], widths: Sequence[int], is_number: Sequence[bool]) -> str:
    cells = [
        cell.rjust(width) if right else cell.ljust(width)
        for cell, width, right in zip(row, widths, is_number, strict=True)
    ]
    return f"| {' | '.join(cells)} |"


def code(text: str) -> str:
    """Return a code span, or prose for a text with a backtick or backslash, which no span can hold."""
    plain = " ".join(text.split())
    if "`" in plain or "\\" in plain:
        return prose(plain)
    return f"`{plain.replace('|', _BAR)}`" if plain else ""


def prose(text: str) -> str:
    """Return a text in one line, escaped so that nothing of it is Markdown or HTML."""
    return _MEANT.sub(r"\\\g<0>", " ".join(text.split()))


def bold(text: str) -> str:
    return f"**{text}**"


def bullets(items: Iterable[str]) -> str:
    return "\n".join(f"- {item}" for item in items)


def plain(text: str) -> str:
    """Return the words of a line without its marks: bold, code and the backslashes of `prose`."""
    return _MARK.sub(lambda match: match[1] or "", text)
