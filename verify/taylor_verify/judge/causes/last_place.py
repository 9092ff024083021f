"""Half a unit in the last place of the numbers of a file, by its longest number.

A constant column may be short and exact, so the digits are those of the whole file: significant ones, and
decimals where all numbers have as many.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import floor, log10
from typing import TYPE_CHECKING, Any, Final

import numpy as np

if TYPE_CHECKING:
    from taylor_verify.solvers.files.file import TrajectoryFile

_DOUBLE: Final = 2.0**-53
_SINGLE: Final = 2.0**-24
# Decimals with so many significant digits are not shorter than a double.
_LONG: Final = 16
_NOT_FINITE: Final = frozenset({"nan", "inf", "infinity"})


def half_units(file: TrajectoryFile) -> dict[str, float]:
    """Return half a unit in the last place of the largest number of each group of columns."""
    relative = _SINGLE if file.is_single_precision else _DOUBLE
    entries = (e for rows in file.groups.values() for column, _ in rows.written() for e in column)
    digits, decimals = _longest(entries)
    return {
        name: max(relative * size, _printed(size, digits, decimals))
        for name, size in _largest(file).items()
    }


def relative_unit(file: TrajectoryFile) -> float:
    """Return the largest half unit of a group of columns, relative to its largest number."""
    units, sizes = half_units(file), _largest(file)
    return max((units[name] / size for name, size in sizes.items() if size), default=0.0)


def _largest(file: TrajectoryFile) -> dict[str, float]:
    """Return the size of the largest number of each group."""
    columns = {name: rows.doubles() for name, rows in file.groups.items()}
    return {
        name: float(np.max(np.abs(values[np.isfinite(values)]), initial=0.0))
        for name, values in columns.items()
    }


def _printed(largest: float, digits: int, decimals: int) -> float:
    if not largest > 0 or not 0 < digits < _LONG:
        return 0.0
    significant = 10.0 ** (floor(log10(largest)) + 1 - digits)
    return 0.5 * max(significant, 10.0**-decimals if decimals < _LONG else 0.0)


def _longest(entries: Iterable[Any]) -> tuple[int, int]:
    """Return the most significant digits and the most decimals; 0 digits where a number is no decimal."""
    digits = decimals = 0
    for entry in entries:
        if not isinstance(entry, str):
            return 0, 0
        mantissa, _, exponent = entry.strip().lower().partition("e")
        plain = mantissa.lstrip("+-")
        if plain in _NOT_FINITE:
            continue
        if not plain.replace(".", "").isdigit():
            return 0, 0
        digits = max(digits, len(plain.replace(".", "").lstrip("0")))
        decimals = max(decimals, len(plain.partition(".")[2]) - int(exponent or 0))
    return digits, decimals
