"""The columns of a trajectory file, by the reader of its format."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from typing import BinaryIO, Final

from taylor_verify.scenes.faults import Refused
from taylor_verify.scenes.regular_file import regular_file
from taylor_verify.solvers.formats import binary, delimited, documents, parquet
from taylor_verify.solvers.formats.column import BYTES, Column, check_lengths

Reader = Callable[[BinaryIO, Path, Collection[str]], list[Column]]

READERS: Final[Mapping[str, Reader]] = {
    ".csv": delimited.read,
    ".tsv": delimited.read,
    ".txt": delimited.read,
    ".json": documents.read,
    ".npz": binary.read,
    ".parquet": parquet.read,
}


def read_columns(path: Path, known: Collection[str]) -> list[Column]:
    """Return the columns as they are written; ``known`` are the names that mean something.

    Raises Refused for what is no regular file of bounded size, and for a fault of its format.
    """
    with regular_file(path, "a trajectory file", BYTES) as file:
        reader = READERS.get(path.suffix.lower())
        if reader is None:
            expected = f"a file that ends in {', '.join(READERS)}"
            raise Refused([f"expected {expected}, got {path.suffix or 'no suffix'} @ {path}"])
        columns = reader(file, path, known)
    check_lengths(columns, path)
    return columns
