"""Replacement of generated files as a whole: a reader of the folder sees old files or new ones."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

from taylor_verify.records.faults import Refused
from taylor_verify.records.limit import Limit
from taylor_verify.records.regular_file import regular_file

_ANY_SIZE: Final = Limit(2**40, "bytes", "only the first line is read")
_LONGEST_LINE: Final = 4096


def replace_files(
    folder: Path, contents: Mapping[str, str | bytes | Iterator[str]], stale: Iterable[Path] = ()
) -> tuple[Path, ...]:
    """Put the contents, by their paths below ``folder``, in place of what is there; remove ``stale``.

    A long text may come in pieces. All are first written apart, so that what fails in writing leaves
    the old files as they were, and none is ever half written. Raises OSError, which names the folder;
    returns the paths in the order given.
    """
    places = {name: folder / name for name in contents}
    # A directory inside the folder is on the same file system, where a move is one step.
    with _made(folder), TemporaryDirectory(dir=folder, prefix=".unfinished-") as staging:
        for name, content in contents.items():
            place = Path(staging, name)
            place.parent.mkdir(parents=True, exist_ok=True)
            if isinstance(content, bytes):
                place.write_bytes(content)
            else:
                pieces = [content] if isinstance(content, str) else content
                with place.open("w", encoding="utf-8", newline="") as staged:
                    staged.writelines(pieces)
        for name, place in places.items():
            place.parent.mkdir(parents=True, exist_ok=True)
            os.replace(Path(staging, name), place)
    for file in set(stale) - set(places.values()):
        file.unlink(missing_ok=True)
    return tuple(places.values())


@contextmanager
def _made(folder: Path) -> Iterator[None]:
    """Make a folder, and remove what was made of it if the block fails and left it empty.

    An error of the system that names no file, such as a full disk, names the folder then.
    """
    new = [path for path in (folder, *folder.absolute().parents) if not path.exists()]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        yield
    except BaseException as error:
        for path in new:
            with suppress(OSError):
                path.rmdir()
        if isinstance(error, OSError) and error.errno and error.filename is None:
            raise OSError(error.errno, error.strerror, str(folder)) from error
        raise


def first_line(file: Path) -> str:
    """Return the line in which a generated file names its maker; empty for what cannot be read."""
    try:
        with regular_file(file, "a generated file", _ANY_SIZE) as opened:
            return opened.readline(_LONGEST_LINE).decode(errors="replace").rstrip("\n")
    except Refused:
        return ""
