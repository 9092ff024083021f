r"""A table in LaTeX: ruled by booktabs, over as many pages as it takes, turned or cut where it is wide.

Nobody looks at every page before it is printed, so the width of a cell is estimated here, and the table is
laid out in the first way that fits:

    upright     as it is, in \footnotesize or \scriptsize
    wrapped     the same with its columns of prose broken into lines
    turned      on pages turned by 90 degrees, as it is or wrapped
    cut         turned, in several tables one below the other, each with the columns that name a row

Widths are in points. The estimate is above what pdflatex sets: too wide a guess costs paper, too narrow a
one runs off the page.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property
from typing import Final

# A4 with margins of 20 mm, upright and turned.
UPRIGHT: Final = 483.0
TURNED: Final = 731.0

# Between two columns.
_GAP: Final = 8.0
# Prose of fewer signs than this is not worth breaking.
_LONG: Final = 24
# What a column of prose gets at least, in signs, where columns are broken.
_LEAST: Final = 18.0
# A cell that has nothing to say.
_NOTHING: Final = ("", "--")
_CONTINUED: Final = (
    r"\par\noindent\emph{The same, further columns; a row that has nothing in them is left out.}"
)


@dataclass(frozen=True)
class Size:
    """A size of type: its name, and the width of a digit in it and of a sign of code."""

    name: str
    digit: float
    code: float


SIZES: Final = (Size("footnotesize", 4.25, 4.25), Size("scriptsize", 3.98, 3.72))
_SMALLEST: Final = SIZES[-1]


@dataclass(frozen=True)
class Cell:
    """What stands in a cell, in LaTeX, and what a reader sees of it: words, and signs of code."""

    latex: str
    words: str
    code: str = ""

    @cached_property
    def _digits(self) -> float:
        return _digits(self.words)

    def width(self, size: Size) -> float:
        return self._digits * size.digit + len(self.code) * size.code

    def longest_word(self, size: Size) -> float:
        """What cannot be broken; code can, behind a / or a hyphen, and then is as long as a half."""
        words = max(map(_digits, self.words.split()), default=0.0) * size.digit
        return max(words, len(self.code) * size.code * (0.5 if len(self.code) > _LONG else 1.0))


@dataclass(frozen=True)
class Table:
    """Headings and rows; ``to_right`` says which columns are numbers."""

    heads: tuple[Cell, ...]
    to_right: tuple[bool, ...]
    rows: tuple[tuple[Cell, ...], ...]

    def of_columns(self, places: Sequence[int]) -> Table:
        return Table(
            tuple(self.heads[i] for i in places),
            tuple(self.to_right[i] for i in places),
            tuple(tuple(row[i] for i in places) for row in self.rows),
        )

    def natural(self, size: Size) -> list[float]:
        """What each column takes if none is broken; a heading is, at its spaces."""
        return [
            max(head.longest_word(size), *(row[i].width(size) for row in self.rows), 0.0)
            for i, head in enumerate(self.heads)
        ]


@dataclass(frozen=True)
class Layout:
    """A table with the type it is set in and the widths of its columns; ``None`` is as it comes."""

    table: Table
    size: Size
    turned: bool
    widths: tuple[float | None, ...]


def laid_out(table: Table) -> list[Layout]:
    """The first way that fits; several layouts where the columns must be cut."""
    return next(_ways(table))


def _ways(table: Table) -> Iterator[list[Layout]]:
    unbroken = (None,) * len(table.heads)
    for turned, room in ((False, UPRIGHT), (True, TURNED)):
        for size in SIZES:
            if _total(table.natural(size)) <= room:
                yield [Layout(table, size, turned, unbroken)]
        for size in SIZES:
            widths = _wrapped(table, size, room)
            if widths:
                yield [Layout(table, size, turned, widths)]
    yield _cut(table)


def _total(widths: Sequence[float]) -> float:
    return sum(widths) + _GAP * len(widths)


def _wrapped(table: Table, size: Size, room: float) -> tuple[float | None, ...] | None:
    """Widths with the columns of prose broken, if what the others leave is enough for those."""
    natural = table.natural(size)
    prose = [i for i in range(len(natural)) if _is_prose(table, i)]
    if not prose:
        return None
    left = room - _total([0.0 if i in prose else width for i, width in enumerate(natural)])
    least = {i: _least(table, i, size) for i in prose}
    if sum(least.values()) > left:
        return None
    # In proportion to the root of the length: the longest column is not all that is read.
    spare = left - sum(least.values())
    wanted = {i: max(natural[i] - least[i], 0.0) ** 0.5 for i in prose}
    share = spare / (sum(wanted.values()) or 1.0)
    given = {i: min(natural[i] + 1.0, least[i] + share * wanted[i]) for i in prose}
    return tuple(given.get(i) for i in range(len(natural)))


def _is_prose(table: Table, i: int) -> bool:
    """Words that may be broken: not numbers, and long enough to gain by it."""
    cells = [row[i] for row in table.rows]
    longest = max((len(cell.words) + len(cell.code) for cell in cells), default=0)
    return not table.to_right[i] and longest > _LONG


def _least(table: Table, i: int, size: Size) -> float:
    longest = max(cell.longest_word(size) for cell in (table.heads[i], *(r[i] for r in table.rows)))
    return max(longest, _LEAST * size.digit)


def _cut(table: Table) -> list[Layout]:
    """Groups of columns that fit, each behind the columns that say whose row it is."""
    size = _SMALLEST
    natural = [
        min(width, TURNED / 3) if _is_prose(table, i) else width
        for i, width in enumerate(table.natural(size))
    ]
    keys = list(range(table.to_right.index(True) if True in table.to_right else 1))
    # Those with an entry in every row come first; of the rest, then, few rows are left.
    fullest = sorted(range(len(keys), len(natural)), key=lambda i: _empty_cells(table, i))
    groups: list[list[int]] = [[]]
    for i in fullest:
        if groups[-1] and _total([natural[k] for k in (*keys, *groups[-1], i)]) > TURNED:
            groups.append([])
        groups[-1].append(i)
    groups = [sorted(group) for group in groups]
    return [
        Layout(
            _with_entries(
                table.of_columns([*keys, *group]), len(keys), everything=group is groups[0]
            ),
            size,
            True,
            tuple(natural[i] if _is_prose(table, i) else None for i in (*keys, *group)),
        )
        for group in groups
    ]


def _empty_cells(table: Table, i: int) -> int:
    return sum(row[i].latex in _NOTHING for row in table.rows)


def _with_entries(table: Table, keys: int, everything: bool) -> Table:
    """The rows that have something to say; of the first columns all, for every row to be there."""
    if everything:
        return table
    rows = [row for row in table.rows if any(c.latex not in _NOTHING for c in row[keys:])]
    return replace(table, rows=tuple(rows))


# In LaTeX.


def latex(layouts: Sequence[Layout]) -> str:
    """The table, or its parts one below the other."""
    return f"\n{_CONTINUED}\n".join(map(_longtable, layouts))


def _longtable(layout: Layout) -> str:
    table = layout.table
    heads = " & ".join(
        _heading(head, right, width, layout)
        for head, right, width in zip(table.heads, table.to_right, _room(layout), strict=True)
    )
    rows = [" & ".join(cell.latex for cell in row) + r" \\" for row in table.rows]
    return "\n".join(
        [
            rf"{{\{layout.size.name}\setlength{{\tabcolsep}}{{{_GAP / 2:g}pt}}%",
            rf"\begin{{longtable}}{{@{{}}{_columns(layout)}@{{}}}}",
            rf"\toprule {heads} \\ \midrule \endhead",
            r"\bottomrule \endfoot",
            *rows,
            r"\end{longtable}}",
        ]
    )


def _columns(layout: Layout) -> str:
    return "".join(
        ("r" if right else "l")
        if width is None
        else rf">{{\raggedright\arraybackslash}}p{{{width:.0f}pt}}"
        for right, width in zip(layout.table.to_right, layout.widths, strict=True)
    )


def _room(layout: Layout) -> list[float]:
    """The width that each heading may take."""
    natural = layout.table.natural(layout.size)
    return [n if w is None else w for n, w in zip(natural, layout.widths, strict=True)]


def _heading(head: Cell, right: bool, room: float, layout: Layout) -> str:
    """On one line where the column has room for it, else a word or more a line."""
    if head.code or head.width(layout.size) <= room or " " not in head.words:
        return head.latex
    lines: list[str] = []
    for word in head.latex.split():
        joined = f"{lines[-1]} {word}" if lines else word
        if lines and Cell(joined, joined).width(layout.size) <= room:
            lines[-1] = joined
        else:
            lines.append(word)
    side, stacked = "r" if right else "l", r"\\".join(lines)
    return rf"\begin{{tabular}}[b]{{@{{}}{side}@{{}}}}{stacked}\end{{tabular}}"


def _digits(words: str) -> float:
    """The width of words in digits."""
    return sum(map(_relative, words))


@cache
def _relative(sign: str) -> float:
    """The width of a sign in digits, from above for capitals and wide letters."""
    if sign in "il.,:;'|!()[]/tjf ":
        return 0.75
    if sign in "mwMW%@\N{EN DASH}\N{MULTIPLICATION SIGN}∞→√":
        return 1.75
    return 1.5 if sign.isupper() else 1.08
