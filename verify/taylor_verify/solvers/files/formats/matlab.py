"""Arrays and structs in a MATLAB file: versions 5 to 7 here, 4 beside it, 7.3 with h5py, as it is HDF5.

Nothing but numbers is read: no object is made, no cell is opened, and structs in each other are not deep.
SciPy reads these files too, and its process dies of one whose cells are nested twenty thousand deep.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator
from functools import partial
from math import prod
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from taylor_verify.records.faults import cut, refusal
from taylor_verify.solvers.files.formats import hdf5, version4
from taylor_verify.solvers.files.formats.arrays import Array, table
from taylor_verify.solvers.files.formats.column import BYTES, COLUMNS, Table
from taylor_verify.solvers.files.formats.content import Content
from taylor_verify.solvers.files.formats.missing_library import unbroken

_HEADER: Final = 128
# The last bytes of the header tell the order of all bytes; those before are the version.
_ORDERS: Final = {b"IM": "<", b"MI": ">"}
_VERSION, _HDF5 = 0x100, 0x200
_MATRIX, _COMPRESSED = 14, 15
_STRUCT, _OPAQUE = 2, 17
# The types of stored numbers, and the classes of arrays of real numbers, as NumPy writes them.
_STORED: Final = {
    **dict(enumerate(("i1", "u1", "i2", "u2", "i4", "u4", "f4"), start=1)),
    **{9: "f8", 12: "i8", 13: "u8"},
}
_CLASSES: Final = dict(
    enumerate(("f8", "f4", "i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8"), start=6)
)
_NUMBERS: Final = ("double", "single", *(f"{u}int{b}" for u in ("", "u") for b in (8, 16, 32, 64)))
_KINDS: Final = "fiuO"
_COMPLEX, _LOGICAL = 0x800, 0x200
_DEEPEST: Final = 4
_BROKEN: Final = (ValueError, struct.error, zlib.error, UnicodeDecodeError, OverflowError)


class _Element(NamedTuple):
    kind: int
    data: memoryview


_NO_ELEMENT: Final = _Element(0, memoryview(b""))


def read(file: Content, path: Path, part: str) -> Table:
    """Return the arrays of a struct, or of the whole file; their sizes are checked first."""
    header = file.beginning(_HEADER)
    order = _ORDERS.get(header[126:], "")
    version = struct.unpack(f"{order}H", header[124:126])[0] if order else 0
    if version == _HDF5 or header.startswith(b"\x89HDF"):
        return hdf5.opened(file, path, lambda f: _checked(list(_hdf5_arrays(f, path)), part, path))
    if version4.is_one(header):
        return _checked(list(version4.arrays(file.whole(BYTES), path)), part, path)
    if version != _VERSION:
        got = f"one that begins with {header[:10].decode('latin-1')!r}"
        mend = "Octave saves one by `save -v7`"
        raise refusal("a MATLAB file of version 4 to 7.3", got, path, mend)
    with unbroken("a MATLAB file", path, _BROKEN):
        arrays = list(_Reader(order, path).arrays(file.whole(BYTES)[_HEADER:]))
    return _checked(arrays, part, path)


def _checked(arrays: list[Array], part: str, path: Path) -> Table:
    """Return the table; refuse an object of MATLAB's that has no time beside it, and say how to save it."""
    objects = [array for array in arrays if array.kind not in _KINDS]
    if objects and not any(array.is_time for array in arrays):
        name = cut(objects[0].name)
        mend = (
            f"save the numbers: s.t = {name}.Time; s.w = {name}.Data; save file.mat -struct s; of a "
            "timetable, writetimetable to CSV"
        )
        got = f"the object `{name}` of class {cut(objects[0].kind)}"
        raise refusal("arrays or a struct of arrays", got, path, mend)
    return table(arrays, part, path)


# Version 7.3.


def _hdf5_arrays(content: Any, path: Path) -> Iterator[Array]:
    """Yield the arrays of a file of version 7.3, whose axes HDF5 has in the opposite order."""
    for name, dataset in hdf5.datasets(content, path):
        if name.startswith("#") or "MATLAB_empty" in dataset.attrs:
            continue
        class_name = bytes(dataset.attrs.get("MATLAB_class", b"double")).decode("latin-1")
        kind = dataset.dtype.kind if class_name in _NUMBERS else "O"
        if "MATLAB_object_decode" in dataset.attrs:
            kind = class_name
        shape = tuple(reversed(dataset.shape or ()))
        load = partial(np.transpose, dataset)
        yield Array(name, shape, kind, dataset.dtype.itemsize, load)


# Versions 5 to 7.


class _Reader:
    """The arrays of a file of version 5 to 7; ``order`` is that of the bytes."""

    def __init__(self, order: str, path: Path) -> None:
        self.order, self.path, self.unpacked, self.count = order, path, 0, 0

    def arrays(self, content: bytes) -> Iterator[Array]:
        for element in self._elements(memoryview(content)):
            if element.kind == _COMPRESSED:
                for inner in self._elements(self._unpacked(element.data)):
                    yield from self._matrix(inner)
            else:
                yield from self._matrix(element)

    def _unpacked(self, data: memoryview) -> memoryview:
        unpacking = zlib.decompressobj()
        unpacked = unpacking.decompress(data, BYTES.most - self.unpacked + 1)
        self.unpacked += len(unpacked)
        BYTES.check(self.unpacked, self.path)
        if not unpacking.eof:
            raise ValueError("a compressed array that ends early")
        return memoryview(unpacked)

    def _elements(self, data: memoryview) -> Iterator[_Element]:
        """Yield the elements in a row; a small one has its number of bytes in the upper half of its tag."""
        place = 0
        while place < len(data):
            kind, size = struct.unpack_from(f"{self.order}II", data, place)
            start, length = place + 8, size
            if kind >> 16:
                start, length, kind = place + 4, kind >> 16, kind & 0xFFFF
            if start + length > len(data):
                raise ValueError(f"{length} bytes announced where {len(data) - start} are left")
            yield _Element(kind, data[start : start + length])
            padded = length if kind == _COMPRESSED else length + -length % 8
            place = place + 8 if start == place + 4 else start + padded

    def _matrix(
        self, element: _Element, group: str = "", name: str = "", depth: int = 0
    ) -> Iterator[Array]:
        """Yield the array in an element, or the arrays of the struct in it; other elements hold none."""
        # Counted before anything else: zeros that are packed are elements without data.
        self.count += 1
        COLUMNS.check(self.count, self.path)
        if element.kind != _MATRIX or not len(element.data):
            return
        parts = self._elements(element.data)
        (flags,) = struct.unpack_from(f"{self.order}I", _next(parts).data)
        kind = flags & 0xFF
        if kind == _OPAQUE:
            own, _, class_name = (_text(_next(parts)) for _ in range(3))
            yield Array(
                f"{group}{name or own}", (1,), class_name or "object", itemsize=8, load=_nothing
            )
            return
        sizes, own = _next(parts).data, _text(_next(parts))
        shape = struct.unpack(f"{self.order}{len(sizes) // 4}i", sizes)
        full = group + (name or own)
        if any(size < 0 for size in shape):
            raise ValueError(f"the shape {shape}")
        if kind == _STRUCT:
            yield from self._struct(full, shape, parts, depth)
        elif kind in _CLASSES and not flags & (_COMPLEX | _LOGICAL):
            yield self._numbers(full, shape, kind, next(parts, None))
        else:
            yield Array(full, shape, "O", itemsize=8, load=_nothing)

    def _struct(
        self, name: str, shape: tuple[int, ...], parts: Iterator[_Element], depth: int
    ) -> Iterator[Array]:
        if depth == _DEEPEST:
            raise ValueError(f"structs nested more than {_DEEPEST} deep")
        (length,) = struct.unpack_from(f"{self.order}i", _next(parts).data)
        names = _text(_next(parts))
        # Of no fields too, there may be no more structs.
        COLUMNS.check(prod(shape) * max(len(names) // max(length, 1), 1), self.path)
        fields = [names[i : i + length].partition("\0")[0] for i in range(0, len(names), length)]
        for row in range(prod(shape)):
            group = f"{name}." if prod(shape) == 1 else f"{name}[{row}]."
            for field in fields:
                yield from self._matrix(next(parts, _NO_ELEMENT), group, field, depth + 1)

    def _numbers(
        self, name: str, shape: tuple[int, ...], kind: int, stored: _Element | None
    ) -> Array:
        dtype = np.dtype(_CLASSES[kind])
        if stored is None or stored.kind not in _STORED:
            raise ValueError(f"no numbers in {cut(name)}")
        form = np.dtype(self.order + _STORED[stored.kind])
        if len(stored.data) != prod(shape) * form.itemsize:
            raise ValueError(f"{len(stored.data)} bytes for the shape {shape} of {cut(name)}")

        def load() -> np.ndarray[Any, Any]:
            return np.frombuffer(stored.data, form).astype(dtype).reshape(shape, order="F")

        return Array(name, shape, dtype.kind, dtype.itemsize, load)


def _next(parts: Iterator[_Element]) -> _Element:
    element = next(parts, None)
    if element is None:
        raise ValueError("an array that ends early")
    return element


def _text(element: _Element) -> str:
    return bytes(element.data).decode("latin-1")


def _nothing() -> np.ndarray[Any, Any]:
    return np.empty(0)
