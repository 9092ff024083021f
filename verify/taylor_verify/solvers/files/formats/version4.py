"""Matrices in a MATLAB file of version 4, and the results of Modelica that such a file holds.

A matrix has a header of five numbers, its name and its numbers. Dymola and OpenModelica write the names of
all variables into one matrix of text, and into `dataInfo` where each of them stands.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from math import prod
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from taylor_verify.records.faults import cut, refusal
from taylor_verify.solvers.files.formats.arrays import Array
from taylor_verify.solvers.files.formats.column import COLUMNS
from taylor_verify.solvers.files.formats.missing_library import unbroken

_HEADER: Final = 20
# The thousands of the type say the order of bytes, the tens the numbers, the ones what the matrix is.
_ORDERS: Final = {0: "<", 1: ">"}
_STORED: Final = ("f8", "f4", "i4", "i2", "u2", "u1")
_FULL, _TEXT = 0, 1
_LONGEST_NAME: Final = 1000
_MODELICA: Final = ("Aclass", "name", "dataInfo")


class _Matrix(NamedTuple):
    name: str
    kind: int
    values: np.ndarray[Any, Any]

    @property
    def texts(self) -> list[str]:
        """The rows of a matrix of text."""
        rows = self.values.astype(np.uint8)
        return [bytes(row.tolist()).decode("latin-1").rstrip("\0 ") for row in rows]


def is_one(start: bytes) -> bool:
    """Return True for the beginning of a file of version 4."""
    return len(start) >= _HEADER and _order(start) is not None


def _order(start: bytes) -> str | None:
    """Return the order of the bytes by the type of the first matrix, which both orders have to agree on."""
    for number, order in _ORDERS.items():
        kind, rows, columns, imaginary, length = struct.unpack(f"{order}5i", start[:_HEADER])
        digits = (kind // 1000, kind // 100 % 10, kind // 10 % 10, kind % 10)
        is_type = digits[0] == number and digits[1] == 0 and digits[2] < len(_STORED)
        is_sound = is_type and digits[3] <= 2 and imaginary in (0, 1)
        if is_sound and rows >= 0 <= columns and 0 < length <= _LONGEST_NAME:
            return order
    return None


def arrays(content: bytes, path: Path) -> Iterator[Array]:
    """Yield the matrices, or the variables of a result of Modelica."""
    with unbroken("a MATLAB file", path, (ValueError, struct.error)):
        matrices = {matrix.name: matrix for matrix in _matrices(content, path)}
    if matrices.keys() >= set(_MODELICA):
        yield from _of_modelica(matrices, path)
        return
    for matrix in matrices.values():
        kind = matrix.values.dtype.kind if matrix.kind == _FULL else "O"
        yield _array(matrix.name, matrix.values, kind)


def _array(name: str, values: np.ndarray[Any, Any], kind: str) -> Array:
    return Array(name, values.shape, kind, values.dtype.itemsize, lambda: values)


def _matrices(content: bytes, path: Path) -> Iterator[_Matrix]:
    order, place, count = _order(content), 0, 0
    while place < len(content):
        kind, *shape, imaginary, length = struct.unpack_from(f"{order}5i", content, place)
        form = np.dtype(f"{order}{_STORED[kind // 10 % 10]}") if 0 <= kind // 10 % 10 < 6 else None
        if form is None or min(shape) < 0 or not 0 < length <= _LONGEST_NAME:
            raise ValueError(f"a header of a matrix with {kind} {shape} {length}")
        start = place + _HEADER + length
        size = prod(shape) * form.itemsize
        if start + size * (1 + bool(imaginary)) > len(content):
            raise ValueError(f"{size} bytes announced where {len(content) - start} are left")
        name = content[place + _HEADER : start].rstrip(b"\0").decode("latin-1")
        values = np.frombuffer(content, form, prod(shape), start).reshape(shape, order="F")
        yield _Matrix(name, kind % 10 if not imaginary else -1, values)
        count += 1
        COLUMNS.check(count, path)
        place = start + size * (1 + bool(imaginary))


def _of_modelica(matrices: dict[str, _Matrix], path: Path) -> Iterator[Array]:
    """Yield the variables of a result: dataInfo has the matrix of each, and its column with a sign."""
    is_transposed = "binTrans" in matrices["Aclass"].texts
    names, info = matrices["name"], matrices["dataInfo"].values
    if is_transposed:
        names, info = names._replace(values=names.values.T), info.T
    texts = names.texts
    if len(texts) != len(info):
        raise refusal("a place in dataInfo for each name", f"{len(info)} of {len(texts)}", path)
    # Time is said to be in matrix 0, and stands in that of the results.
    places = [(int(row[0]), int(row[1])) for row in info]
    for name, (table, column) in zip(texts, places, strict=True):
        data = matrices.get(f"data_{table or 2}")
        if data is None or table == 1:
            continue
        values = data.values.T if is_transposed else data.values
        if not 1 <= abs(column) <= values.shape[1]:
            raise refusal(f"a column of data_{table or 2}", str(column), f"{path}, {cut(name)}")
        entries = values[:, abs(column) - 1]
        yield _array(name, -entries if column < 0 else entries, "f")
