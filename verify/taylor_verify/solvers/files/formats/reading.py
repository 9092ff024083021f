"""The formats of a trajectory file: a line of `FORMATS` for each suffix.

To add one: a file beside this one whose ``read`` returns the columns, and a line here.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import BinaryIO, Final, NamedTuple

from taylor_verify.scenes.reading.faults import refusal
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
from taylor_verify.solvers.files.formats.column import BYTES, ROWS, Column, Table

# The text after # in FILE#PART says which of several trajectories in a file is read.
Reader = Callable[[BinaryIO, Path, str], Table]


class Format(NamedTuple):
    """A format: a phrase on it, its reader, and the package that the reader needs with its extra."""

    what: str
    read: Reader
    package: str = ""
    extra: str = ""
    needs: str = "needs"

    @property
    def sentence(self) -> str:
        """The phrase, with the install command where the package is missing."""
        if not self.package or _is_there(self.package):
            return self.what
        install = f"pip install 'taylor-verify[{self.extra}]'"
        return f"{self.what}; {self.needs} {self.package}: {install}"


def _alone(read: Callable[[BinaryIO, Path], list[Column]]) -> Reader:
    """Return the reader of a format that holds one trajectory in a file."""

    def read_alone(file: BinaryIO, path: Path, part: str) -> Table:
        if part:
            raise refusal("a file of one trajectory by its name alone", f"`#{part}`", path)
        return Table(read(file, path))

    return read_alone


_DELIMITED: Final = _alone(delimited.read)
_HDF5: Final = ("h5py", "hdf5")
_BAG: Final = (rosbag.read, "rosbags", "rosbag")
FORMATS: Final[Mapping[str, Format]] = {
    ".csv": Format("a header line and rows", _DELIMITED),
    ".tsv": Format("a header line and rows, with tabs", _DELIMITED),
    ".txt": Format("a header line and rows, with blanks; or an AEM", _DELIMITED),
    ".json": Format("an object of arrays", _alone(documents.read)),
    ".npz": Format("named arrays of NumPy", _alone(binary.read)),
    ".parquet": Format("columns of numbers", _alone(parquet.read), "pyarrow", "parquet"),
    ".aem": Format("attitude ephemeris of the CCSDS, as text or XML", aem.read),
    ".kvn": Format("attitude ephemeris of the CCSDS, as text", aem.read),
    ".xml": Format("attitude ephemeris of the CCSDS, as XML", aem.read),
    ".h5": Format("datasets of numbers", hdf5.read, *_HDF5),
    ".hdf5": Format("datasets of numbers", hdf5.read, *_HDF5),
    ".nc": Format("NetCDF 4, which is HDF5", hdf5.read, *_HDF5),
    ".mat": Format("arrays and structs of MATLAB", matlab.read, *_HDF5, "version 7.3 needs"),
    ".mcap": Format("a topic of ROS 2 messages or JSON", mcap.read, "mcap", "mcap"),
    ".bag": Format("a topic of a rosbag of ROS 1", *_BAG),
    ".db3": Format("a topic of a rosbag of ROS 2; its folder is read too", *_BAG),
}


def read_table(file: str | os.PathLike[str]) -> Table:
    """Return the columns as they are written.

    ``file`` is a path, or FILE#PART where a file holds several trajectories. Raises Refused for what is
    no regular file of bounded size, and for a fault of its format.
    """
    path, part = parted(os.fspath(file))
    if rosbag.is_folder(path):
        table = rosbag.read_folder(path, part)
    else:
        with regular_file(path, "a trajectory file", BYTES) as content:
            table = _reader(content, path)(content, path, part)
    ROWS.check(max((len(column.values) for column in table.columns), default=0), path)
    return table


def parted(file: str) -> tuple[Path, str]:
    """Split FILE#PART where FILE is there; a name that is itself a file has no part."""
    if not os.path.exists(file):
        for place, character in enumerate(file):
            if character == "#" and os.path.exists(file[:place]):
                return Path(file[:place]), file[place + 1 :]
    return Path(file), ""


def _reader(content: BinaryIO, path: Path) -> Reader:
    if aem.is_text(content):
        return aem.read
    known = FORMATS.get(path.suffix.lower())
    if known is None:
        expected = f"a file that ends in {', '.join(FORMATS)}"
        raise refusal(expected, path.suffix or "no suffix", path)
    return known.read


def _is_there(package: str) -> bool:
    try:
        return find_spec(package) is not None
    except ValueError:  # it is marked as missing, as tests do
        return False
