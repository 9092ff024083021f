"""Refusals of files that need a missing library, or that a library cannot read."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

from taylor_verify.records.faults import Refused, cut, refusal

# The optional dependency that installs a package.
_EXTRAS: Final = {
    "h5py": "hdf5",
    "mcap": "mcap",
    "mcap_ros2": "mcap",
    "pyarrow": "parquet",
    "rosbags": "rosbag",
}


def install(package: str) -> str:
    """Return the command that installs a package that a reader needs."""
    return f"pip install 'taylor-verify[{_EXTRAS.get(package, 'readers')}]'"


@contextmanager
def needed(place: object) -> Iterator[None]:
    """Refuse the file at ``place`` if an import in the block lacks a package."""
    try:
        yield
    except ModuleNotFoundError as error:
        package = str(error.name).partition(".")[0]
        mend = f"install it with `{install(package)}`, or write CSV"
        raise refusal(f"the package {package}", "none", place, mend) from None


@contextmanager
def unbroken(
    what: str, place: object, kinds: tuple[type[Exception], ...] = (Exception,)
) -> Iterator[None]:
    """Refuse the file at ``place`` if the block raises an exception of some kinds.

    By default of any kind, because no library documents what a broken file becomes. A refusal, and the lack
    of a package, stay what they are.
    """
    try:
        yield
    except (Refused, ModuleNotFoundError):
        raise
    except kinds as error:
        reason = cut((str(error).splitlines() or [type(error).__name__])[0])
        raise refusal(what, f"a fault in it: {reason}", place) from None
