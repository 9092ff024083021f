"""The numbers of a trajectory file in compact form; exact values are formed when rows are read.

A million rows of eight numbers take 5 GB as rationals, and 0.4 GB as the text that they were read from.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from typing import Any, Final, overload

import gmpy2
import numpy as np
from mpmath import mp

from taylor_verify.records.faults import Faults
from taylor_verify.scenes.mpfr import to_mpf
from taylor_verify.solvers.files.formats.column import CHUNK, Column, alike, shown
from taylor_verify.solvers.values import Value, as_mpf, exact

Array = np.ndarray[Any, Any]
Floats = np.ndarray[Any, np.dtype[np.float64]]
Flags = np.ndarray[Any, np.dtype[np.bool_]]
Raw = Sequence[Any]

# Errors are reported as doubles, so the numbers of an answer must be in the range of doubles.
_LARGEST: Final = 2**1000
# A short decimal is a finite number far below that; whatever else is a number is read one by one.
_SHORT: Final = r"[+-]?[0-9]{1,40}(?:\.[0-9]{0,40})?(?:[eE][+-]?[0-9]{1,2})?"
_SHORT_TEXTS: Final = re.compile(rf"(?: *{_SHORT} *\n)*")
_DECIMAL: Final = re.compile(r"[+-]?[0-9.]+(?:[eE][+-]?[0-9]+)?")
NO_DIGITS: Final = re.compile(r"[eE][+-]?[0-9]+|[+. -]")


class Rows(Sequence[tuple[Value, ...]]):
    """Rows of some columns, each number exactly as it was written; equal to any sequence of the same rows.

    ``finite`` is True for the rows whose numbers are all finite. The number of a row is the factor of its
    column times the number that is written.
    """

    def __init__(
        self,
        columns: Sequence[Raw],
        finite: Flags | None = None,
        factors: Sequence[Fraction] | None = None,
    ) -> None:
        self._columns = tuple(columns)
        self._factors = factors or (Fraction(1),) * len(self._columns)
        self._count = len(self._columns[0])
        self.finite: Flags = np.ones(self._count, dtype=bool) if finite is None else finite

    def __len__(self) -> int:
        return self._count

    @property
    def width(self) -> int:
        return len(self._columns)

    @overload
    def __getitem__(self, place: int) -> tuple[Value, ...]: ...

    @overload
    def __getitem__(self, place: slice) -> tuple[tuple[Value, ...], ...]: ...

    def __getitem__(self, place: int | slice) -> Any:
        if isinstance(place, slice):
            return tuple(self[k] for k in range(self._count)[place])
        return next(self.values_at([place]))

    def __iter__(self) -> Iterator[tuple[Value, ...]]:
        for part in _chunks(self._count):
            yield from self.values_at(part)

    def values_at(self, places: Sequence[int]) -> Iterator[tuple[Value, ...]]:
        """Yield some of the rows."""
        return zip(*(map(exact, entries) for entries in self._some(places)), strict=True)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Sequence):
            return NotImplemented
        return len(self) == len(other) and all(a == b for a, b in zip(self, other, strict=True))

    def at(self, places: Sequence[int]) -> Rows:
        """Return some of the rows."""
        columns = [_some(column, places) for column in self._columns]
        return Rows(columns, self.finite[list(places)], self._factors)

    def doubles(self, places: Sequence[int] | None = None) -> Floats:
        """Return some of the rows, or all, as float64, each number rounded once."""
        places = range(self._count) if places is None else places
        doubles = np.empty((len(places), len(self._columns)))
        for part in _chunks(len(places)):
            for i, entries in enumerate(self._some(places[part.start : part.stop])):
                doubles[part.start : part.stop, i] = _doubles(entries)
        return doubles

    def written(self) -> Iterator[tuple[Raw, Floats]]:
        """Yield the entries of each column in the file's own unit, and the doubles nearest to them."""
        for column in self._columns:
            entries = _some(column, range(self._count))
            yield entries, _doubles(entries)

    def as_mpf(self, places: Sequence[int], bits: int) -> Array:
        """Return some of the rows as numbers of mpmath, exact where a number has at most so many bits."""
        columns = [_as_mpf(entries, bits) for entries in self._some(places)]
        return np.stack(columns, axis=1) if len(places) else np.empty((0, len(columns)), object)

    def _some(self, places: Sequence[int]) -> Iterator[Raw]:
        """Yield the entries of each column at some places, as they are written in the scene's unit."""
        for column, factor in zip(self._columns, self._factors, strict=True):
            entries = _some(column, places)
            yield entries if factor == 1 else [_scaled(exact(raw), factor) for raw in entries]


def _scaled(value: Value, factor: Fraction) -> Value:
    """Return a number in the scene's unit, exactly; NaN and infinity as they are."""
    return value * factor if isinstance(value, Fraction) else value


def _chunks(count: int) -> Iterator[range]:
    """Yield the places of so many rows, some thousands at once."""
    for begin in range(0, count, CHUNK):
        yield range(begin, min(begin + CHUNK, count))


def _some(column: Raw, places: Sequence[int]) -> Any:
    """Return the entries of a column at some places, texts as a list."""
    if isinstance(places, range) and places and abs(places.step) == 1:
        low, high = sorted((places[0], places[-1]))
        entries: Any = column[low : high + 1][:: places.step]
    elif isinstance(column, np.ndarray):
        entries = column[np.asarray(places, dtype=int)]
    else:
        return [column[k] for k in places]
    return entries.tolist() if _is_array(entries, "T") else entries


def _is_array(values: Raw, kind: str) -> bool:
    return isinstance(values, np.ndarray) and values.dtype.kind == kind


def _is_double(values: Raw) -> bool:
    return _is_array(values, "f") and np.asarray(values).dtype.itemsize <= 8


def _is_short(texts: Sequence[Any]) -> bool:
    """Return True if all are texts of short decimals."""
    if not all(isinstance(text, str) for text in texts):
        return False
    # A text may have a line of its own within it, which is no number.
    lines = "\n".join([*texts, ""])
    return lines.count("\n") == len(texts) and _SHORT_TEXTS.fullmatch(lines) is not None


def _doubles(values: Raw) -> Floats:
    if _is_double(values) or _is_short(values):
        return np.array(values, dtype=np.float64)
    return np.array([float(value) for value in map(exact, values)])


def _as_mpf(values: Raw, bits: int) -> Array:
    if _is_short(values):
        with gmpy2.context(precision=bits):
            return to_mpf(np.array([gmpy2.mpfr(text) for text in values], dtype=object))
    if _is_double(values):
        numbers = list(map(mp.mpf, np.asarray(values, dtype=np.float64).tolist()))
    else:
        numbers = [as_mpf(value, bits) for value in map(exact, values)]
    return np.fromiter(numbers, dtype=object, count=len(numbers))


# What is read of a file.


def check_numbers(column: Column, file: str, faults: Faults, blank: Flags | None) -> Flags:
    """Return True for the entries that are finite numbers; add a fault for text and too large numbers.

    Rows that are ``blank`` are passed over.
    """
    finite = np.ones(len(column.values), dtype=bool) if blank is None else ~blank
    with alike(faults, f"{file}, column {column.name}") as wrong:
        for part in _chunks(len(column.values)):
            values = _some(column.values, part)
            if _is_double(values):
                sizes = np.abs(np.asarray(values, dtype=np.float64))
                finite[part.start : part.stop] &= np.isfinite(sizes)
                suspects = np.isfinite(sizes) & (sizes >= _LARGEST)
            else:
                suspects = np.full(len(values), not _is_short(values))
            suspects &= finite[part.start : part.stop]
            for k in np.flatnonzero(suspects).tolist():
                try:
                    finite[part[k]] = _is_finite(values[k])
                except ValueError as error:
                    place = f"{file}, row {part[k] + 1}, column {column.name}"
                    wrong(str(error), shown(values[k]), place)
    return finite


def entries_at(column: Column, places: Sequence[int]) -> Column:
    """Return a column with some of its entries."""
    return column._replace(values=_some(column.values, places))


def _is_finite(raw: object) -> bool:
    value = exact(raw)
    if isinstance(value, Fraction) and abs(value) >= _LARGEST:
        raise ValueError("a number below 2^1000 in size")
    return isinstance(value, Fraction)


def written_digits(columns: Iterable[Column]) -> int | None:
    """Return the most significant digits of any decimal; None where they do not tell."""
    most = 0
    for _, values in columns:
        if not isinstance(values, list) and not _is_array(values, "T"):
            return None
        for part in _chunks(len(values)):
            texts = _some(values, part)
            if not _is_short(texts) and not all(map(is_decimal, texts)):
                return None
            digits = NO_DIGITS.sub("", "\n".join(text.strip() for text in texts))
            most = max(most, *(len(text.lstrip("0")) for text in digits.split("\n")))
    # Zeros alone are exact however they are written.
    return most or None


def is_decimal(raw: object) -> bool:
    """Return True for a text that is a decimal."""
    return isinstance(raw, str) and _DECIMAL.fullmatch(raw.strip()) is not None
