"""The formats of a trajectory file: a line of `FORMATS` for each suffix.

To add one: a module beside this one with ``read(file, path) -> Table``, and a line here. ``file`` is a
`Content`, whose every way to read has a limit. Where a file may hold several trajectories, the module is
in `_OF_PARTS`, and ``read`` is given the text after # in FILE#PART too, which says which of them is read.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final, NamedTuple

from taylor_verify.records.faults import refusal
from taylor_verify.records.plugins import Plugin, free
from taylor_verify.records.regular_file import regular_file
from taylor_verify.solvers.files.formats import ccsds, echo, rosbag
from taylor_verify.solvers.files.formats.column import BYTES, ROWS, Column, Table
from taylor_verify.solvers.files.formats.content import Content
from taylor_verify.solvers.files.formats.missing_library import install, needed


class Format(NamedTuple):
    """A format: a phrase on it, the file of its reader, and the package that the reader needs."""

    what: str
    module: str
    package: str = ""
    needs: str = "needs"

    @property
    def sentence(self) -> str:
        """The phrase, with the install command where the package is missing."""
        if not self.package or _is_there(self.package):
            return self.what
        return f"{self.what}; {self.needs} {self.package}: {install(self.package)}"


FORMATS: Final[Mapping[str, Format]] = {
    ".csv": Format("a header line and rows", "delimited"),
    ".tsv": Format("a header line and rows, with tabs", "delimited"),
    ".txt": Format("a header line and rows, with blanks; or an AEM", "delimited"),
    ".json": Format(
        "an object of arrays, a list of objects, or an object in each line", "documents"
    ),
    ".jsonl": Format("an object in each line", "documents"),
    ".ndjson": Format("an object in each line", "documents"),
    ".npz": Format("named arrays of NumPy", "binary"),
    ".npy": Format("a matrix of NumPy, whose columns have numbers from 1", "binary"),
    ".parquet": Format("columns of numbers", "parquet", "pyarrow"),
    ".aem": Format("attitude ephemeris of the CCSDS, as text or XML", "aem"),
    ".kvn": Format("attitude or orbit ephemeris of the CCSDS, as text", "aem"),
    ".oem": Format("orbit ephemeris of the CCSDS, as text or XML", "oem"),
    ".xml": Format("attitude or orbit ephemeris of the CCSDS, as XML", "aem"),
    ".sto": Format("a table of OpenSim", "opensim"),
    ".mot": Format("a table of OpenSim", "opensim"),
    ".a": Format("attitudes of STK", "stk"),
    ".42": Format("a quantity of 42, beside its time.42", "forty_two"),
    ".yaml": Format("messages as ROS echoes them", "echo"),
    ".yml": Format("messages as ROS echoes them", "echo"),
    ".h5": Format("datasets of numbers", "hdf5", "h5py"),
    ".hdf5": Format("datasets of numbers", "hdf5", "h5py"),
    ".nc": Format("NetCDF 4, which is HDF5", "hdf5", "h5py"),
    ".mat": Format("arrays and structs of MATLAB", "matlab", "h5py", "version 7.3 needs"),
    ".mcap": Format("a topic of ROS 2 messages or JSON", "mcap", "mcap"),
    ".bag": Format("a topic of a rosbag of ROS 1", "rosbag", "rosbags"),
    ".db3": Format("a topic of a rosbag of ROS 2; its folder is read too", "rosbag", "rosbags"),
}

# Those whose files may hold several trajectories.
_OF_PARTS: Final = frozenset({"aem", "oem", "hdf5", "matlab", "mcap", "rosbag"})
# A file of any other name that is text.
_TEXT: Final = FORMATS[".txt"]


def read_table(file: str | os.PathLike[str]) -> Table:
    """Return the columns as they are written.

    ``file`` is a path, or FILE#PART where a file holds several trajectories. Raises Refused for what is
    no regular file of bounded size, and for a fault of its format.
    """
    path, part = parted(os.fspath(file))
    reader = None if path.suffix in FORMATS else plugged().get(path.suffix.lower())
    with needed(path):
        if reader:
            table = _read_by(reader, path)
        elif rosbag.is_folder(path):
            table = rosbag.read_folder(path, part)
        else:
            with regular_file(path, "a trajectory file", BYTES) as opened:
                # Its text ends with the file, and not before.
                content = Content(opened, path)
                table = _read(content, path, part)
    ROWS.check(max((len(column.values) for column in table.columns), default=0), path)
    return table


def plugged() -> dict[str, Plugin]:
    """Return the readers of other packages by suffix."""
    sound = free("readers", lambda plugin: iter(plugin.content.suffixes), iter(FORMATS))
    return {suffix: plugin for plugin in sound for suffix in plugin.content.suffixes}


def _read_by(reader: Plugin, path: Path) -> Table:
    """Return the columns that another package reads. Raises Refused with its name for any error of it."""
    with regular_file(path, "a trajectory file", BYTES):
        pass
    try:
        table = reader.content.read(path)
        columns = [Column(str(name), list(table[name])) for name in table]
    except Exception as error:  # other people's code
        got = f"{type(error).__name__}: {error}"
        raise refusal(f"a file that {reader.package} reads", got, path) from error
    return Table(columns, (f"read by {reader.name} {reader.origin}",))


def parted(file: str) -> tuple[Path, str]:
    """Split FILE#PART where FILE is there; a name that is itself a file has no part."""
    if not os.path.exists(file):
        for place, character in enumerate(file):
            if character == "#" and os.path.exists(file[:place]):
                return Path(file[:place]), file[place + 1 :]
    return Path(file), ""


def _read(content: Content, path: Path, part: str) -> Table:
    """Return the columns that the format's own file beside this one reads."""
    name = _reader(content, path)
    reader: Any = import_module(f"{__package__}.{name}")
    if part and name not in _OF_PARTS:
        raise refusal("a file of one trajectory by its name alone", f"`#{part}`", path)
    given = (content, path, part) if name in _OF_PARTS else (content, path)
    table: Table = reader.read(*given)
    return table


def _reader(content: Content, path: Path) -> str:
    """Return the name of the file beside this one that reads the format."""
    if message := ccsds.kind(content):
        return message
    if echo.is_one(content):
        return "echo"
    known = FORMATS.get(path.suffix.lower(), _TEXT if content.looks_like_text else None)
    if known is None:
        expected = f"a file that ends in {', '.join([*FORMATS, *plugged()])}"
        raise refusal(expected, path.suffix or "no suffix", path)
    return known.module


def _is_there(package: str) -> bool:
    try:
        return find_spec(package) is not None
    except ValueError:  # it is marked as missing, as tests do
        return False
