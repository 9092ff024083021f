"""Columns in an NPZ archive: named one-dimensional arrays of numbers.

The header of a member says how much it will be, and is believed only if the member is as long. Pickled
objects are never read.
"""

from __future__ import annotations

import re
import zipfile
import zlib
from io import BytesIO
from itertools import islice
from lzma import LZMAError
from mmap import ACCESS_READ, mmap
from pathlib import Path
from tokenize import TokenError
from typing import Any, Final, NamedTuple

import numpy as np

from taylor_verify.records.faults import Faults, Refused, refusal
from taylor_verify.solvers.files.formats.column import (
    BYTES,
    CHARACTERS,
    COLUMNS,
    Column,
    Table,
    check_size,
    refuse_part,
)
from taylor_verify.solvers.files.formats.content import Content

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
    LZMAError,
    RuntimeError,
)


class _Member(NamedTuple):
    """An array of an archive that is not read yet."""

    name: str
    info: zipfile.ZipInfo
    header_bytes: int
    shape: tuple[int, ...]
    dtype: np.dtype[np.generic]


def read(file: Content, path: Path, part: str) -> Table:
    """Return the arrays; every header is checked before the data of any is read."""
    refuse_part(part, path)
    try:
        _check_entries(file, path)
        with zipfile.ZipFile(file.binary) as archive:
            members = [_member(archive, info, path) for info in archive.infolist()]
            _check(members, path)
            return Table([_column(archive, member) for member in members])
    except _BROKEN as error:
        raise refusal("an NPZ archive", f"a fault in it: {error}", path) from None


def _check_entries(file: Content, path: Path) -> None:
    """Count the entries of the directory, of which zipfile would make an object each."""
    if file.beginning(6) == np.lib.format.MAGIC_PREFIX:
        raise ValueError("one array, and no archive of named ones")
    with mmap(file.binary.fileno(), 0, access=ACCESS_READ) as content:
        entries = sum(1 for _ in islice(_ENTRY.finditer(content), COLUMNS.most + 1))
    if entries > COLUMNS.most:
        raise COLUMNS.refusal("more", path)


def _member(archive: zipfile.ZipFile, info: zipfile.ZipInfo, path: Path) -> _Member:
    """Return what the header of an array says of it."""
    name = info.filename.removesuffix(".npy")
    with archive.open(info) as stream:
        start = BytesIO(stream.read(_LONGEST_HEADER))
    try:
        version = np.lib.format.read_magic(start)
        if version not in _READERS:
            raise ValueError(f"format version {version}")
        shape, _, dtype = _READERS[version](start)
    except _BROKEN as error:
        got = repr(str(error).splitlines()[0])
        raise refusal("an array in NPY form", got, f"{path}, column {name}") from None
    return _Member(name, info, start.tell(), shape, dtype)


def _check(members: list[_Member], path: Path) -> None:
    faults = Faults()
    for name, info, header_bytes, shape, dtype in members:
        place = f"{path}, column {name}"
        if len(shape) != 1 or shape[0] < 0 or dtype.kind not in "fiuUb":
            expected = "a one-dimensional array of real numbers"
            faults.add(expected, f"shape {shape} of {dtype}", place)
        elif dtype.kind == "U" and dtype.itemsize > 4 * CHARACTERS.most:
            faults.lines += CHARACTERS.refusal(dtype.itemsize // 4, place).faults
        elif info.file_size != header_bytes + shape[0] * dtype.itemsize:
            expected = f"{shape[0] * dtype.itemsize} bytes of data as its header says"
            faults.add(expected, str(info.file_size - header_bytes), place)
    if faults.lines:
        raise Refused(faults.lines)
    check_size(len(members), max((member.shape[0] for member in members), default=0), path)
    BYTES.check(sum(member.info.file_size for member in members), path)


def _column(archive: zipfile.ZipFile, member: _Member) -> Column:
    data = archive.read(member.info)
    if len(data) != member.info.file_size:
        raise ValueError(f"{member.name} ends early")
    values: Any = np.frombuffer(data, member.dtype, offset=member.header_bytes)
    return Column(member.name, values)
