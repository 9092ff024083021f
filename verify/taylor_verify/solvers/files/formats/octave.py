"""Variables in a text file of Octave: lines `# name:`, `# type:` and sizes, then the numbers."""

from __future__ import annotations

from collections.abc import Iterator
from math import prod
from pathlib import Path
from typing import Final

import numpy as np

from taylor_verify.records.faults import cut, refusal
from taylor_verify.solvers.files.formats.arrays import Array, table
from taylor_verify.solvers.files.formats.column import COLUMNS, ELEMENTS, Table
from taylor_verify.solvers.files.formats.content import Content

_NAME: Final = "# name:"
_BEGINNING: Final = 1024
# Types whose numbers are read; a struct holds the variables that follow it.
_NUMBERS: Final = ("matrix", "scalar")
_STRUCT: Final = "scalar struct"


def is_one(file: Content) -> bool:
    """Return True for a text that begins with the name of a variable, below comments."""
    lines = file.beginning(_BEGINNING).splitlines()
    above = [line for line in lines if not line.startswith((b"#", b"%")) and line.strip()]
    first = next((line for line in lines if line.startswith(_NAME.encode())), None)
    return first is not None and (not above or lines.index(first) < lines.index(above[0]))


def read(file: Content, path: Path, part: str) -> Table:
    """Return the matrices by name, each number as it is written."""
    arrays = list(_arrays(file, path))
    COLUMNS.check(len(arrays), path)
    return table(arrays, part, path)


def _arrays(file: Content, path: Path) -> Iterator[Array]:
    stated, cells = dict[str, str](), list[str]()
    count = 0
    for line in file.lines():
        if line.startswith(_NAME):
            yield from _array(stated, cells, path)
            stated, cells = {}, []
        if line.startswith("#"):
            key, _, text = line[1:].partition(":")
            stated[key.strip()] = text.strip()
            continue
        words = line.split()
        if "ndims" in stated and "sizes" not in stated and words:
            stated["sizes"] = line
            continue
        count += len(words)
        ELEMENTS.check(count, path)
        cells += words
    yield from _array(stated, cells, path)


def _array(stated: dict[str, str], cells: list[str], path: Path) -> Iterator[Array]:
    """Yield the matrix of a variable; what is of another type is left out, and named."""
    kind, name = stated.get("type", ""), stated.get("name", "")
    if not name or kind == _STRUCT:
        return
    if kind not in _NUMBERS:
        yield Array(name, (1,), "O", 8, lambda: np.empty(0))
        return
    sizes = stated.get("sizes", f"{stated.get('rows', '1')} {stated.get('columns', '1')}").split()
    shape = tuple(int(size) for size in sizes if size.isdecimal())
    if len(shape) < len(sizes) or prod(shape) != len(cells):
        raise refusal(f"{' x '.join(sizes)} numbers of {cut(name)}", str(len(cells)), path)
    # Rows are written as rows, but matrices of more dimensions as MATLAB stores them.
    values = np.array(cells, dtype=str).reshape(shape, order="F" if "ndims" in stated else "C")
    yield Array(name, shape, "U", values.dtype.itemsize, lambda: values)
