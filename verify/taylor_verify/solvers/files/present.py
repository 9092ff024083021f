"""The rows of a file that are there: rows that repeat the one before, and groups with rows of their own.

A group has no row where all of its cells are blank, and none where all are NaN as in a table of two rates:
rows of the slower group stand alone, with about as many rows of NaN between each two, and every row of NaN
has numbers of another group. Any other NaN is an answer.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import groupby
from typing import Any, Final

import numpy as np

from taylor_verify.solvers.files.formats.column import Column
from taylor_verify.solvers.values import Value, exact

Flags = np.ndarray[Any, np.dtype[np.bool_]]

# R writes NA, and other programs null.
_BLANK: Final = ("", "NA", "null", None)
# With fewer gaps between its rows a group has no rate.
_FEWEST: Final = 2


def blanks(values: Sequence[Any]) -> Flags:
    """Return True for the cells that are blank."""
    if isinstance(values, np.ndarray) and values.dtype.kind in "fiub":
        return np.zeros(len(values), dtype=bool)
    if isinstance(values, np.ndarray) and values.dtype.kind == "T":
        texts = np.strings.strip(values)
        return np.logical_or.reduce([texts == blank for blank in _BLANK[:-1]])
    cells = (value.strip() if isinstance(value, str) else value for value in values)
    return np.fromiter((cell in _BLANK for cell in cells), dtype=bool, count=len(values))


def first_of_equal(times: Sequence[Value], columns: Sequence[Sequence[Any]]) -> list[int]:
    """Return the places of the rows that do not repeat the row before, time and numbers."""
    first: list[int] = []
    for k, time in enumerate(times):
        if not (first and time == times[first[-1]] and _are_equal(columns, first[-1], k)):
            first.append(k)
    return first


def _are_equal(columns: Sequence[Sequence[Any]], before: int, now: int) -> bool:
    return all(_number(column[before]) == _number(column[now]) for column in columns)


def _number(raw: Any) -> object:
    """Return a number; a text that is none, and NaN, are equal to themselves."""
    try:
        value = exact(raw)
    except ValueError:
        return raw
    return value if isinstance(value, Fraction) else str(value)


def rows_of_groups(
    groups: Mapping[str, Sequence[Column]], blank: Mapping[str, Flags], finite: Mapping[str, Flags]
) -> dict[str, Flags]:
    """Return True for the rows that each group has.

    ``blank`` are those without a number, and ``finite`` those whose numbers are all finite.
    """
    there = {group: ~blank[group] for group in groups}
    nan = {g: there[g] & _of_nan(columns, there[g] & ~finite[g]) for g, columns in groups.items()}
    sparse = [
        group
        for group in groups
        if _stands_alone(finite[group]) and _has_others(nan[group], group, finite)
    ]
    for group, rows in there.items():
        slower = [finite[each] for each in sparse if each != group]
        if group in sparse or any(_complements(nan[group], elsewhere) for elsewhere in slower):
            rows &= ~nan[group]
    return there


def _has_others(nan: Flags, group: str, finite: Mapping[str, Flags]) -> bool:
    """Return True if other groups have numbers in all rows of NaN."""
    others = [rows for each, rows in finite.items() if each != group]
    return bool(np.logical_or.reduce(others)[nan].all()) if others else False


def _complements(nan: Flags, elsewhere: Flags) -> bool:
    """Return True for NaN in most of the rows that another group has, and in no others."""
    return bool(elsewhere[nan].all()) and 2 * nan.sum() > elsewhere.sum()


def blank_rows(columns: Sequence[Column]) -> Flags:
    """Return True for the rows all of whose cells are blank."""
    return np.asarray(np.logical_and.reduce([blanks(column.values) for column in columns]))


def _of_nan(columns: Sequence[Column], rows: Flags) -> Flags:
    """Return True for those of some rows all of whose numbers are NaN."""
    nan = np.zeros(len(rows), dtype=bool)
    for k in np.flatnonzero(rows).tolist():
        nan[k] = all(_is_nan(column.values[k]) for column in columns)
    return nan


def _stands_alone(finite: Flags) -> bool:
    """Return True for rows that stand alone, with about as many others between each two and at the end."""
    runs = [(there, len(list(run))) for there, run in groupby(finite.tolist())]
    between = [length for there, length in runs[1:-1] if not there]
    if len(between) < _FEWEST or any(there and length > 1 for there, length in runs):
        return False
    last = 0 if runs[-1][0] else runs[-1][1]
    return max(*between, last) <= 2 * min(between) + 1


def _is_nan(raw: Any) -> bool:
    value = exact(raw)
    return value != value
