"""The columns of a trajectory file, by the reader of its format."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from typing import BinaryIO, Final

from taylor_verify.scenes.reading.faults import Refused
from taylor_verify.scenes.reading.regular_file import regular_file
from taylor_verify.solvers.files.formats import (
    aem,
    binary,
    delimited,
    documents,
    hdf5,
    matlab,
    mcap,
    parquet,
    rosbag,
)
from taylor_verify.solvers.files.formats.column import BYTES, Column, Table, check_lengths

Reader = Callable[[BinaryIO, Path, Collection[str]], list[Column]]
# Formats that may hold several trajectories: the text after # in FILE#PART says which one is read.
PartReader = Callable[[BinaryIO, Path, str], Table]

READERS: Final[Mapping[str, Reader]] = {
    ".csv": delimited.read,
    ".tsv": delimited.read,
    ".txt": delimited.read,
    ".json": documents.read,
    ".npz": binary.read,
    ".parquet": parquet.read,
}
PART_READERS: Final[Mapping[str, PartReader]] = {
    ".aem": aem.read,
    ".kvn": aem.read,
    ".xml": aem.read,
    ".h5": hdf5.read,
    ".hdf5": hdf5.read,
    ".nc": hdf5.read,
    ".mat": matlab.read,
    ".mcap": mcap.read,
    ".bag": rosbag.read,
    ".db3": rosbag.read,
}


def read_table(file: str | os.PathLike[str], known: Collection[str]) -> Table:
    """Return the columns as they are written; ``known`` are the names that mean something.

    ``file`` is a path, or FILE#PART where a file holds several trajectories. Raises Refused for what is
    no regular file of bounded size, and for a fault of its format.
    """
    path, part = parted(os.fspath(file))
    if rosbag.is_folder(path):
        return rosbag.read_folder(path, part)
    with regular_file(path, "a trajectory file", BYTES) as content:
        table = _table(content, path, part, known)
    check_lengths(table.columns, path)
    return table


def parted(file: str) -> tuple[Path, str]:
    """Split FILE#PART where FILE is there; a name that is itself a file has no part."""
    if not os.path.exists(file):
        for place, character in enumerate(file):
            if character == "#" and os.path.exists(file[:place]):
                return Path(file[:place]), file[place + 1 :]
    return Path(file), ""


def _table(content: BinaryIO, path: Path, part: str, known: Collection[str]) -> Table:
    suffix = path.suffix.lower()
    part_reader = aem.read if aem.is_text(content) else PART_READERS.get(suffix)
    if part_reader is not None:
        return part_reader(content, path, part)
    reader = READERS.get(suffix)
    if reader is None:
        expected = f"a file that ends in {', '.join((*READERS, *PART_READERS))}"
        raise Refused([f"expected {expected}, got {path.suffix or 'no suffix'} @ {path}"])
    if part:
        raise Refused(
            [f"expected a file of one trajectory by its name alone, got `#{part}` @ {path}"]
        )
    return Table(reader(content, path, known))
