"""A table of a scene file whose values become exact numbers, or faults with their path.

A reader method returns None where it recorded a fault, so that reading goes on to the next one.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from decimal import Decimal
from fractions import Fraction
from itertools import combinations
from typing import Any, Final, NamedTuple, TypeGuard, TypeVar

from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.records.faults import Faults, cut, near, shown

LARGEST_EXPONENT = 5000
MOST_DIGITS = 4000  # below the 4300 digits at which Python refuses to read an integer
_MOST_BITS = 16_600  # 10^5000 has 16610 bits
_LONGEST_SENTENCE = 1000  # it stands in a cell of a table

_NUMBER = "a finite number"
_EXPONENT = f"a number with powers of ten up to {LARGEST_EXPONENT}"
_WITHOUT_UNIT = (
    "a number without a unit (units are any consistent set; `omega` and `angular_velocity` alone "
    'take text such as "2 deg/s")'
)
_FRACTION = re.compile(r"([+-]?[0-9]+)/([0-9]+)")
_DECIMAL = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE]([+-]?[0-9]+))?")
# Neither 1e9/3 nor 0x10 is a number and a unit.
_QUANTITY = re.compile(
    r"([+-]?[0-9.][0-9./eE+-]*)(?![eE][+-]?[0-9])(?!(?<=0)[xXoObB][0-9a-fA-F])\s*([^\W\d_\s].*|[°%].*)"
)

T = TypeVar("T")


class Number(NamedTuple):
    """A way to read one number: ``read`` raises ValueError with what it expects.

    ``stand_in`` takes the place of a number that is a fault, so that what reads it is examined too. So are
    the entries of an array of another length.
    """

    read: Callable[[object], Any]
    stand_in: Fraction | None = None


def complete(values: Iterable[T | None]) -> tuple[T, ...] | None:
    """Return all values, or None if one of them is None because of a fault."""
    read = tuple(values)
    known = tuple(value for value in read if value is not None)
    return known if len(known) == len(read) else None


class Table:
    """Table of a scene: each key that was asked for is known, and each other key is a fault."""

    def __init__(self, entries: Mapping[str, object], path: str, faults: Faults) -> None:
        self._left = dict(entries)
        self._known: set[str] = set()
        self._path = path
        self.faults = faults

    def path(self, key: str = "") -> str:
        return ".".join(part for part in (self._path, key) if part)

    def has(self, key: str) -> bool:
        """Return True if the scene writes the key; from now on the key is known."""
        self._known.add(key)
        return key in self._left

    def fault(self, expected: str, got: str, key: str = "", mend: str = "") -> None:
        self.faults.add(expected, got, self.path(key), mend)

    def take(self, key: str, expected: str) -> object | None:
        """Return the value as TOML has it (which has no null); a missing key is a fault."""
        if not self.has(key):
            self.fault(expected, "nothing", key, f"add the key `{key}`")
            return None
        return self._left.pop(key)

    def close(self, advice: Callable[[str, object], str] = lambda key, value: "") -> None:
        """Report every key that was not taken; ``advice`` says for some keys what to write instead."""
        for key, value in self._left.items():
            if self.faults.is_full:
                break
            mend = advice(key, value) or near(cut(key), self._known)
            self.fault("a known key", f"`{cut(key)}`", cut(key), mend)

    def table(self, key: str, mend: str = "") -> Table | None:
        """Return a table; ``mend`` says how to write one."""
        entries = self.take(key, "a table")
        return None if entries is None else self._table(entries, key, mend)

    def tables(self, key: str) -> tuple[Table, ...] | None:
        """Return an array of tables; an empty array, and each entry that is no table, is a fault."""
        entries = self.take(key, "an array of tables")
        if entries is None:
            return None
        if not isinstance(entries, list) or not entries:
            self.fault("an array of tables", shown(entries), key)
            return None
        return complete([self._table(entry, f"{key}[{i}]") for i, entry in enumerate(entries)])

    def empty(self, key: str) -> Table:
        """Return the table of that name as if it were there, with nothing in it."""
        return Table({}, self.path(key), self.faults)

    def text(self, key: str, default: str | None = None) -> str | None:
        """Return a string; empty or missing is a fault, unless there is a default."""
        if default is not None and not self.has(key):
            return default
        value = self.take(key, "a sentence")
        if isinstance(value, str) and value.strip() and len(value) <= _LONGEST_SENTENCE:
            return value
        if isinstance(value, str) and len(value) > _LONGEST_SENTENCE:
            self.fault(f"at most {_LONGEST_SENTENCE} characters", str(len(value)), key)
        elif value is not None:
            self.fault("a sentence", shown(value), key)
        return None

    def words(self, key: str, known: frozenset[str]) -> frozenset[str] | None:
        """Return an array of words out of the known ones; missing is the empty set."""
        if not self.has(key):
            return frozenset()
        value = self.take(key, "an array")
        if not isinstance(value, list):
            self.fault("an array of words", shown(value), key)
            return None
        for i, word in enumerate(value):
            if self.faults.is_full:
                break
            if not isinstance(word, str) or word not in known:
                expected = f"one of {', '.join(sorted(known))}"
                self.fault(expected, shown(word), f"{key}[{i}]", near(cut(str(word)), known))
        return known.intersection(word for word in value if isinstance(word, str))

    def number(
        self, key: str, default: Fraction | None = None, reader: Number | None = None
    ) -> Fraction | None:
        """Return an exact number; missing is a fault, unless there is a default.

        ``reader`` reads it, and is that of exact numbers unless given.
        """
        if default is not None and not self.has(key):
            return default
        value = self.take(key, _NUMBER)
        return None if value is None else self._exact(value, key, reader or EXACT)

    def left(self) -> list[str]:
        """Return the keys that were not taken yet."""
        return list(self._left)

    def numbers(self, key: str, most: int) -> Vector | None:
        """Return an array of at most ``most`` exact numbers."""
        value = self.take(key, "an array of numbers")
        if isinstance(value, list) and len(value) <= most:
            return self._entries(value, key, EXACT)
        if isinstance(value, list):
            self.fault(f"at most {most} numbers", str(len(value)), key)
        elif value is not None:
            self.fault("an array of numbers", shown(value), key)
        return None

    def vector(
        self, key: str, default: Vector | None = None, length: int = 3, reader: Number | None = None
    ) -> Vector | None:
        """Return an array of ``length`` numbers; missing is a fault, unless there is a default.

        ``reader`` reads an entry, and is that of exact numbers unless given.
        """
        if default is not None and not self.has(key):
            return default
        value = self.take(key, f"{length} numbers")
        return None if value is None else self._row(value, key, length, reader or EXACT)

    def note(self, sentence: str) -> None:
        """Add a sentence on how numbers of this table were formed."""
        self.faults.notes.append(sentence)

    def matrix(self, key: str, size: int = 3) -> Matrix | None:
        """Return a square matrix of exact numbers."""
        return complete(map(complete, self._cells(key, size, None)))

    def symmetric(self, key: str, size: int = 3, diagonal: Number | None = None) -> Matrix | None:
        """Return a square matrix equal to its transpose; every pair that differs is a fault.

        ``diagonal`` reads the entries of the diagonal, if it is given.
        """
        cells = self._cells(key, size, diagonal)
        apart = False
        for i, j in combinations(range(len(cells)), 2):
            upper, lower = cells[i][j], cells[j][i]
            if upper is not None and lower is not None and upper != lower:
                got = f"[{i}][{j}] = {shown(upper)} but [{j}][{i}] = {shown(lower)}"
                self.fault("a symmetric matrix", got, key, "write both entries alike")
                apart = True
        return None if apart else complete(map(complete, cells))

    def peek(self, key: str) -> list[object]:
        """Return the entries of an array without taking it; none for any other value."""
        value = self._left.get(key)
        return value if isinstance(value, list) else []

    def peek_keys(self, key: str) -> tuple[str, ...]:
        """Return the keys of a table without taking it; none for any other value."""
        value = self._left.get(key)
        return tuple(value) if isinstance(value, dict) else ()

    def is_array(self, key: str) -> bool:
        """Return True if the scene writes the key with an array, without taking it."""
        return isinstance(self._left.get(key), list)

    def _table(self, value: object, key: str, mend: str = "") -> Table | None:
        if isinstance(value, dict):
            return Table(value, self.path(key), self.faults)
        self.fault("a table", shown(value), key, mend)
        return None

    def _cells(self, key: str, size: int, diagonal: Number | None) -> list[list[Fraction | None]]:
        """Return the entries of a square matrix, None for each that is a fault."""
        value = self.take(key, f"a {size}x{size} matrix")
        lost: list[list[Fraction | None]] = [[None] * size for _ in range(size)]
        if value is None:
            return lost
        if not isinstance(value, list) or len(value) != size:
            form = ", ".join(["[..]"] * size)
            self.fault(f"a {size}x{size} matrix [{form}]", shown(value), key)
            return lost
        for i, row in enumerate(value):
            if self._is_row(row, f"{key}[{i}]", size):
                readers = [diagonal or EXACT if i == j else EXACT for j in range(size)]
                lost[i] = [
                    self._exact(entry, f"{key}[{i}][{j}]", reader)
                    for j, (entry, reader) in enumerate(zip(row, readers, strict=True))
                ]
        return lost

    def _is_row(self, value: object, key: str, length: int) -> TypeGuard[list[object]]:
        """Return True for an array of that length; another value is a fault."""
        if isinstance(value, list) and len(value) == length:
            return True
        self.fault(f"{length} numbers", shown(value), key)
        return False

    def _row(
        self, value: object, key: str, length: int, reader: Number | None = None
    ) -> Vector | None:
        reader = reader or EXACT
        if self._is_row(value, key, length):
            return self._entries(value, key, reader)
        if reader.stand_in is None:
            return None
        entries = value[:length] if isinstance(value, list) else []
        flat = [0 if isinstance(entry, list | dict) else entry for entry in entries]
        return self._entries(flat, key, reader)

    def _entries(self, values: list[object], key: str, reader: Number) -> Vector | None:
        return complete([self._exact(v, f"{key}[{i}]", reader) for i, v in enumerate(values)])

    def _exact(self, value: object, key: str, reader: Number) -> Fraction | None:
        try:
            number: Fraction = reader.read(value)
        except ValueError as error:
            parts = quantity(value)
            mend = f"write {cut(parts[0])}, if {cut(parts[1])} is its unit" if parts else ""
            self.fault(str(error), shown(value), key, mend)
            return reader.stand_in
        return number


def exact_number(value: object) -> Fraction:
    """Return the rational that is written as an integer, a decimal or a string ``"a/b"``.

    Raises ValueError, whose text is what was expected. Powers of ten beyond 10^5000 are refused
    before anything is built: 1e999999999 would be a gigabyte of digits.
    """
    if isinstance(value, int) and not isinstance(value, bool):
        # Only a hexadecimal literal can be that long; tomllib refuses the decimal ones itself.
        if value.bit_length() > _MOST_BITS:
            raise ValueError(_EXPONENT)
        return Fraction(value)
    if isinstance(value, Decimal):
        return _from_decimal(value)
    if isinstance(value, str):
        return _from_text(value.strip())
    raise ValueError(_NUMBER)


EXACT: Final = Number(exact_number)


def right(expected: str, is_right: Callable[[Fraction], bool]) -> Number:
    """Return a reader of exact numbers of which some are wrong; ``expected`` says what is right."""

    def read(value: object) -> Fraction:
        number = exact_number(value)
        if not is_right(number):
            raise ValueError(expected)
        return number

    return Number(read)


def _from_decimal(value: Decimal) -> Fraction:
    if not value.is_finite():
        raise ValueError(_NUMBER)
    exponent = value.as_tuple().exponent
    # adjusted() is the power of ten of the first digit, the exponent that of the last one.
    if max(abs(value.adjusted()), abs(int(exponent))) > LARGEST_EXPONENT:
        raise ValueError(_EXPONENT)
    return Fraction(value)


def _from_text(text: str) -> Fraction:
    if len(text) > MOST_DIGITS:
        raise ValueError(f"a number of at most {MOST_DIGITS} digits")
    if match := _FRACTION.fullmatch(text):
        if int(match[2]) == 0:
            raise ValueError("a denominator that is not zero")
        return Fraction(int(match[1]), int(match[2]))
    if match := _DECIMAL.fullmatch(text):
        if match[1] and abs(int(match[1])) > 2 * LARGEST_EXPONENT:
            raise ValueError(_EXPONENT)
        return _from_decimal(Decimal(text))
    raise ValueError(
        _WITHOUT_UNIT if quantity(text) else 'a number (an integer, a decimal or "a/b")'
    )


def is_numeral(text: str) -> bool:
    """Return True if text has the form of a number: digits, a decimal or a/b."""
    return bool(_FRACTION.fullmatch(text) or _DECIMAL.fullmatch(text))


def quantity(value: object) -> tuple[str, str] | None:
    """Return number and unit of text such as ``"2 deg/s"``; None for a bare number and any other text."""
    if not isinstance(value, str) or len(value) > MOST_DIGITS:
        return None
    text = value.strip()
    if is_numeral(text):
        return None
    parts = _QUANTITY.fullmatch(text)
    return (parts[1], parts[2].strip()) if parts else None
