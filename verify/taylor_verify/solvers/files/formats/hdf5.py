"""Columns in an HDF5 file, read with h5py; NetCDF 4 is HDF5 too.

Only datasets of numbers in the file itself are read: no link leads out of it, and no filter is loaded that
HDF5 has not built in.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import prod
from pathlib import Path
from typing import Any, Final

from taylor_verify.records.faults import cut, refusal
from taylor_verify.solvers.files.formats.arrays import Array, table
from taylor_verify.solvers.files.formats.column import CHUNK_BYTES, COLUMNS, Table
from taylor_verify.solvers.files.formats.content import Content
from taylor_verify.solvers.files.formats.missing_library import unbroken

# Deflate, shuffle, Fletcher's checksum, szip, nbit and scale-offset are HDF5's own; LZF is h5py's.
_PACKING: Final = {1, 4, 5, 6, 32000}
_FILTERS: Final = {2, 3, *_PACKING}


def read(file: Content, path: Path, part: str) -> Table:
    """Return the datasets of a group; their declared sizes are checked before any is read."""
    return opened(file, path, lambda content: table(_arrays(content, path), part, path))


def opened(file: Content, path: Path, tabulate: Callable[[Any], Table]) -> Table:
    """Return the table that is made of the open file; whatever is broken in it is refused."""
    import h5py

    if file.beginning(3) == b"CDF":
        mend = "write NetCDF 4, as `nccopy -k nc4 OLD NEW` does"
        raise refusal("NetCDF 4, which is HDF5", "the classic form of NetCDF", path, mend)
    with unbroken("an HDF5 file", path), h5py.File(file.binary, "r") as content:
        return tabulate(content)


def _arrays(content: Any, path: Path) -> Iterator[Array]:
    """Yield the datasets of the file; the fields of a table stand beside it, or below its name."""
    for name, dataset in datasets(content, path):
        if dataset.dtype.names is None:
            yield _array(name, dataset, dataset.dtype, dataset)
            continue
        prefix = name.rpartition(".")[0] if name.endswith("table") else name
        for field in dataset.dtype.names:
            full = f"{prefix}.{field}".lstrip(".")
            yield _array(full, dataset, dataset.dtype[field], dataset.fields(field))


def _array(name: str, dataset: Any, dtype: Any, entries: Any) -> Array:
    return Array(name, dataset.shape or (), dtype.kind, dtype.itemsize, lambda: entries[()])


def datasets(content: Any, path: Path) -> Iterator[tuple[str, Any]]:
    """Yield the datasets of a file by name, a dot between groups; no link out of it is followed."""
    import h5py

    waiting, visited, count = [("", content)], set[int](), 0
    while waiting:
        prefix, group = waiting.pop()
        address = h5py.h5o.get_info(group.id).addr
        if address in visited:
            continue
        visited.add(address)
        for name in group:
            count += 1
            COLUMNS.check(count, path)
            if not isinstance(group.get(name, getlink=True), h5py.HardLink):
                continue
            member = group[name]
            if isinstance(member, h5py.Group):
                waiting.append((f"{prefix}{name}.", member))
            elif isinstance(member, h5py.Dataset):
                _check_stored(member, path)
                yield f"{prefix}{name}", member


def _check_stored(dataset: Any, path: Path) -> None:
    """Refuse a dataset whose numbers are not in this file, or are packed by a foreign filter."""
    place = f"{path}, dataset {cut(dataset.name)}"
    properties = dataset.id.get_create_plist()
    filters = [properties.get_filter(i)[0] for i in range(properties.get_nfilters())]
    if dataset.is_virtual or dataset.external:
        raise refusal("numbers in this file", "a reference to another", place)
    if foreign := sorted({*filters} - _FILTERS):
        raise refusal("HDF5's own filters", foreign, place)
    if len(packing := [number for number in filters if number in _PACKING]) > 1:
        raise refusal("numbers that are packed once", f"the filters {packing}", place)
    CHUNK_BYTES.check(prod(dataset.chunks or ()) * dataset.dtype.itemsize, place)
