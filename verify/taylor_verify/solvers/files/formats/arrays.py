"""Columns from the named arrays in a file: the arrays as long as the times, and their names.

A vector is a column of its own name. An array N of n rows and k columns is k columns N[0] ... N[k-1], one
of n matrices is N[0][0] ... . The names of groups stand before a dot: sim.omega[0]. A group that holds
everything is not named.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from math import prod
from typing import Any, Final, NamedTuple

import numpy as np

from taylor_verify.records.faults import refusal
from taylor_verify.solvers.files.columns.readings import Name
from taylor_verify.solvers.files.formats.column import (
    BYTES,
    COLUMNS,
    Column,
    Table,
    check_size,
    listed,
)

# Decimals in text are numbers too.
_NUMBERS: Final = "fiuU"
_SIGNALS: Final = ".signals.values"
_MOST_OF_MATRIX: Final = 30


class Array(NamedTuple):
    """An array that is not read yet: ``load`` reads it, ``kind`` is NumPy's letter of its numbers."""

    name: str
    shape: tuple[int, ...]
    kind: str
    itemsize: int
    load: Callable[[], np.ndarray[Any, Any]]

    @property
    def group(self) -> str:
        return self.name.rpartition(".")[0]

    @property
    def is_time(self) -> bool:
        readings = Name.of(self.name.rpartition(".")[2]).readings
        return any(reading.spelling.group == "time" and not reading.path for reading in readings)

    @property
    def longest(self) -> int:
        return max(self.shape, default=0)


def table(arrays: Iterable[Array], part: str, place: object) -> Table:
    """Return the columns of the arrays in a part of a file, or in the whole of it.

    The sizes that the file declares are checked before any array is read. An array of another length than
    the times, and one of no real numbers, is left out, and a note names it.
    """
    inner = _without_common_group(_of_signals(_within(list(arrays), part, place), place))
    _refuse_several(inner, place)
    numbers = [array for array in inner if array.kind in _NUMBERS and array.shape]
    rows = _rows_of_one(numbers[0], place) if len(numbers) == 1 else _rows(numbers)
    read = [array for array in numbers if rows in array.shape]
    COLUMNS.check(len(read), place)
    check_size(sum(prod(a.shape) // max(rows, 1) for a in read), rows, place)
    BYTES.check(sum(prod(array.shape) * array.itemsize for array in read), place)
    columns = [column for array in read for column in _columns(array, rows)]
    return Table(columns, (*_left_out(inner, read, rows), *_matrices(read, rows)))


def _within(arrays: list[Array], part: str, place: object) -> list[Array]:
    """Return the arrays of a group, named without it."""
    group = part.strip("/.").replace("/", ".")
    if not group:
        return arrays
    prefix = f"{group}."
    inner = [a._replace(name=a.name[len(prefix) :]) for a in arrays if a.name.startswith(prefix)]
    if not inner:
        groups = ", ".join(sorted({a.group for a in arrays} - {""})) or "none"
        raise refusal(f"one of the groups in the file ({groups})", f"`#{part}`", place)
    return inner


def _of_signals(arrays: list[Array], place: object) -> list[Array]:
    """Return the signals that Simulink saves as structs with time, each by the name of its struct.

    Their times are read once, if they are equal.
    """
    structs = [a.name.removesuffix(_SIGNALS) for a in arrays if a.name.endswith(_SIGNALS)]
    if len(structs) == 1 and not Name.of(f"{structs[0]}[0]").readings:
        return arrays
    names = {f"{name}.time" for name in structs}
    clocks = [array for array in arrays if array.name in names and array.kind in _NUMBERS]
    BYTES.check(sum(prod(clock.shape) * clock.itemsize for clock in clocks), place)
    if not clocks or not _are_equal(clocks):
        return arrays
    inner = tuple(f"{name}.{each}" for name in structs for each in ("signals", "time", "blockName"))
    signals = [array for array in arrays if array.name.endswith(_SIGNALS)]
    read = [array._replace(name=array.name.removesuffix(_SIGNALS)) for array in signals]
    left = [array for array in arrays if not array.name.startswith(inner)]
    name = "time" if any(array.name == "tout" for array in left) else "tout"
    return [*left, *read, clocks[0]._replace(name=name)]


def _are_equal(arrays: Sequence[Array]) -> bool:
    first, *others = (array.load() for array in arrays)
    return all(np.array_equal(first, other) for other in others)


def _without_common_group(arrays: list[Array]) -> list[Array]:
    """Return the arrays, named without the groups that hold them all."""
    while arrays and all("." in array.name for array in arrays):
        if len({array.name.partition(".")[0] for array in arrays}) > 1:
            break
        arrays = [a._replace(name=a.name.partition(".")[2]) for a in arrays]
    return arrays


def _refuse_several(arrays: Sequence[Array], place: object) -> None:
    groups = sorted({a.group for a in arrays if a.is_time})
    if len(groups) > 1 and "" not in groups:
        got = f"times in the groups {listed(groups)}"
        raise refusal("one trajectory", got, place, f"name one of them: FILE#{groups[0]}")


def _rows(arrays: Sequence[Array]) -> int:
    """Return the number of times; where nothing is called so, the length that most arrays have."""
    times = [array for array in arrays if array.is_time and array.longest == prod(array.shape)]
    if times:
        return min(times, key=lambda array: array.name.count(".")).longest
    lengths = Counter(array.longest for array in arrays)
    # A matrix of few rows may be wider than long.
    shared = Counter(size for array in arrays for size in {*array.shape})
    return max(lengths, key=lambda size: (lengths[size], shared[size], size), default=0)


def _rows_of_one(array: Array, place: object) -> int:
    """Return the number of rows of the only array: its times say if a matrix is transposed."""
    length, *width = array.shape
    if len(width) != 1 or not min(array.shape):
        return array.longest
    BYTES.check(prod(array.shape) * array.itemsize, place)
    values = array.load()
    is_transposed = _rises(values[0]) and not _rises(values[:, 0])
    return width[0] if is_transposed else length


def _rises(line: np.ndarray[Any, Any]) -> bool:
    return len(line) > 1 and bool((np.diff(line.astype(float)) > 0).all())


def _columns(array: Array, rows: int) -> Iterator[Column]:
    values: Any = np.moveaxis(array.load(), array.shape.index(rows), 0)
    # A stack of 3 x 1 x n has vectors in it.
    values = values.reshape(rows, *(size for size in values.shape[1:] if size > 1))
    if values.size == rows:
        yield Column(array.name, values.reshape(rows))
        return
    for index in np.ndindex(values.shape[1:]):
        name = array.name + "".join(f"[{i}]" for i in index)
        yield Column(name, values[(slice(None), *index)])


def _left_out(arrays: Sequence[Array], read: Sequence[Array], rows: int) -> Iterator[str]:
    names = {array.name for array in read}
    other = [array for array in arrays if array.name not in names]
    if short := [array.name for array in other if array.kind in _NUMBERS]:
        yield f"not read, because they have no {rows} rows: {listed(short)}"
    if strange := [array.name for array in other if array.kind not in _NUMBERS]:
        yield f"not read, because they hold no real numbers: {listed(strange)}"


def _matrices(read: Sequence[Array], rows: int) -> Iterator[str]:
    """Yield how to name the columns of a matrix whose own name says nothing."""
    for array in read:
        width = prod(array.shape) // max(rows, 1)
        names = [f"{array.name}[{k}]" for k in range(width)]
        if len(array.shape) == 2 and 1 < width and not Name.of(names[0]).is_known:
            example = ",".join(f"w{k}={name}" for k, name in enumerate(names[:2], start=1))
            shown = ", ".join(names[:_MOST_OF_MATRIX])
            more = f" ... {names[-1]}" if width > _MOST_OF_MATRIX else ""
            yield f"the columns of {array.name} are {shown}{more}, as in --columns {example},..."
