"""The formats of a trajectory file, each with what it is and the package that it lacks."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.util import find_spec
from typing import Final, NamedTuple

from taylor_verify.solvers.files.formats.reading import PART_READERS, READERS


class _Format(NamedTuple):
    what: str
    package: str = ""
    extra: str = ""
    needs: str = "needs"


_HDF5: Final = _Format("datasets of numbers", "h5py", "hdf5")
_BAG: Final = _Format("a topic of a rosbag", "rosbags", "rosbag")
_FORMATS: Final[Mapping[str, _Format]] = {
    ".csv": _Format("a header line and rows"),
    ".tsv": _Format("a header line and rows, with tabs"),
    ".txt": _Format("a header line and rows, with blanks; or an AEM"),
    ".json": _Format("an object of arrays"),
    ".npz": _Format("named arrays of NumPy"),
    ".parquet": _Format("columns of numbers", "pyarrow", "parquet"),
    ".aem": _Format("attitude ephemeris of the CCSDS, as text or XML"),
    ".kvn": _Format("attitude ephemeris of the CCSDS, as text"),
    ".xml": _Format("attitude ephemeris of the CCSDS, as XML"),
    ".h5": _HDF5,
    ".hdf5": _HDF5,
    ".nc": _HDF5._replace(what="NetCDF 4, which is HDF5"),
    ".mat": _Format("arrays and structs of MATLAB", "h5py", "hdf5", "version 7.3 needs"),
    ".mcap": _Format("a topic of ROS 2 messages or JSON", "mcap", "mcap"),
    ".bag": _BAG._replace(what="a topic of a rosbag of ROS 1"),
    ".db3": _BAG._replace(what="a topic of a rosbag of ROS 2; its folder is read too"),
}


def formats() -> dict[str, str]:
    """Return a sentence for each suffix, with the install command where its package is missing."""
    return {suffix: _sentence(_FORMATS[suffix]) for suffix in (*READERS, *PART_READERS)}


def _sentence(one: _Format) -> str:
    if not one.package or _is_there(one.package):
        return one.what
    return f"{one.what}; {one.needs} {one.package}: pip install 'taylor-verify[{one.extra}]'"


def _is_there(package: str) -> bool:
    try:
        return find_spec(package) is not None
    except ValueError:  # it is marked as missing, as tests do
        return False
