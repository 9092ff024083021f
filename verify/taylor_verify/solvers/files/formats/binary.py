"""Columns in files of NumPy: the arrays of an NPZ archive by name, those of one NPY array by number.

The header of a member says how much it will be, and is believed only if the member is as long. Pickled
objects are never read.
"""

from __future__ import annotations

import re
import zipfile
import zlib
from collections.abc import Callable
from functools import partial
from io import BytesIO
from itertools import islice
from math import prod
from mmap import ACCESS_READ, mmap
from pathlib import Path
from tokenize import TokenError
from typing import Any, Final, Literal, NamedTuple

import numpy as np

from taylor_verify.records.faults import Faults, Refused, cut, refusal
from taylor_verify.solvers.files.formats.arrays import Array, table
from taylor_verify.solvers.files.formats.column import (
    BYTES,
    CHARACTERS,
    COLUMNS,
    Column,
    Table,
    check_size,
)
from taylor_verify.solvers.files.formats.content import Content
from taylor_verify.solvers.files.formats.missing_library import unbroken

_READERS: Final = {
    (1, 0): np.lib.format.read_array_header_1_0,
    (2, 0): np.lib.format.read_array_header_2_0,
    (3, 0): np.lib.format.read_array_header_2_0,
}
_ENTRY: Final = re.compile(rb"PK\x01\x02")
# NumPy's own bound on a header, and the twelve bytes before it.
_LONGEST_HEADER: Final = 10_012
# What a member that is no array, or no archive, makes of the libraries.
_BROKEN: Final = (
    ValueError,
    TypeError,
    KeyError,
    EOFError,
    SyntaxError,
    TokenError,
    OverflowError,
    zipfile.BadZipFile,
    zlib.error,
    RuntimeError,
)


class _Header(NamedTuple):
    """The header of an array, its length, and the bytes that follow it."""

    name: str
    shape: tuple[int, ...]
    order: Literal["C", "F"]
    dtype: np.dtype[np.generic]
    length: int
    stored: int

    def array(self, data: Callable[[], bytes]) -> Array:
        """Return the array whose header this is; its ``data`` is not read yet."""
        kind, size = self.dtype.kind, self.dtype.itemsize
        return Array(self.name, self.shape, kind, size, lambda: self.values(data()))

    def values(self, data: bytes) -> np.ndarray[Any, Any]:
        if len(data) != self.length + self.stored:
            raise ValueError(f"{self.name} ends early")
        values: np.ndarray[Any, Any] = np.frombuffer(data, self.dtype, offset=self.length)
        return values.reshape(self.shape, order=self.order)


def read(file: Content, path: Path) -> Table:
    """Return the arrays; every header is checked before the data of any is read."""
    if file.beginning(6) == np.lib.format.MAGIC_PREFIX:
        return _of_one(file, path)
    kind = "an NPY array" if path.suffix.lower() == ".npy" else "an NPZ archive"
    with unbroken(kind, path, _BROKEN):
        _check_entries(file, path)
        with zipfile.ZipFile(file.binary) as archive:
            members = archive.infolist()
            headers = [_header_of(archive, info, path) for info in members]
            _check(headers, path)
            data = (partial(archive.read, info) for info in members)
            return table(map(_Header.array, headers, data), "", path)


def _check_entries(file: Content, path: Path) -> None:
    """Count the entries of the directory, of which zipfile would make an object each."""
    with mmap(file.binary.fileno(), 0, access=ACCESS_READ) as content:
        entries = sum(1 for _ in islice(_ENTRY.finditer(content), COLUMNS.most + 1))
    if entries > COLUMNS.most:
        raise COLUMNS.refusal("more", path)


def _header_of(archive: zipfile.ZipFile, info: zipfile.ZipInfo, path: Path) -> _Header:
    """Return the header of a member; refuse a method that NumPy does not use.

    zipfile unpacks those whole, whatever a member claims.
    """
    if info.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        place = f"{path}, member {cut(info.filename)}"
        raise refusal("a member that is stored or deflated", f"method {info.compress_type}", place)
    with archive.open(info) as stream:
        start = stream.read(_LONGEST_HEADER)
    return _header(start, info.filename.removesuffix(".npy"), info.file_size, path)


def _header(start: bytes, name: str, size: int, path: Path) -> _Header:
    """Return what the beginning of an array of so many bytes says of it."""
    stream = BytesIO(start)
    try:
        version = np.lib.format.read_magic(stream)
        if version not in _READERS:
            raise ValueError(f"format version {version}")
        shape, is_fortran, dtype = _READERS[version](stream)
    except _BROKEN as error:
        got = repr(str(error).splitlines()[0])
        raise refusal("an array in NPY form", got, f"{path}, column {name}") from None
    order: Literal["C", "F"] = "F" if is_fortran else "C"
    return _Header(name, shape, order, dtype, stream.tell(), size - stream.tell())


def _check(headers: list[_Header], path: Path) -> None:
    faults = Faults()
    for header in headers:
        place, size = f"{path}, column {header.name}", prod(header.shape) * header.dtype.itemsize
        if any(length < 0 for length in header.shape):
            faults.add("an array", f"shape {header.shape} of {header.dtype}", place)
        elif header.dtype.kind == "U" and header.dtype.itemsize > 4 * CHARACTERS.most:
            faults.lines += CHARACTERS.refusal(header.dtype.itemsize // 4, place).faults
        elif header.dtype.kind in "fiuUb" and header.stored != size:
            expected = f"{size} bytes of data as its header says"
            faults.add(expected, str(header.stored), place)
    if faults.lines:
        raise Refused(faults.lines)
    COLUMNS.check(len(headers), path)


# One array.


def _of_one(file: Content, path: Path) -> Table:
    """Return the columns of a matrix by their numbers."""
    content = file.whole(BYTES)
    header = _header(content[:_LONGEST_HEADER], "1", len(content), path)
    _check([header], path)
    is_matrix = 1 <= len(header.shape) <= 2 and all(header.shape)
    if header.dtype.kind not in "fiu" or not is_matrix:
        got = f"shape {header.shape} of {header.dtype}"
        raise refusal("a matrix of numbers, a row for each time", got, path)
    matrix: Any = header.values(content).reshape(header.shape[0], -1)
    check_size(matrix.shape[1], matrix.shape[0], path)
    return Table([Column(str(k), column) for k, column in enumerate(matrix.T, start=1)])
