"""The bytes of a regular file of bounded size; anything else is refused before it is opened.

A pipe would block for ever, and a device never ends. The kind of the file is checked twice: before it is
opened, because opening a device can have effects, and after, because the path may lead elsewhere by then.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO, Final

from taylor_verify.records.faults import Refused
from taylor_verify.records.limit import Limit

_KINDS: Final = {
    stat.S_IFDIR: "a folder",
    stat.S_IFIFO: "a FIFO",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
    stat.S_IFSOCK: "a socket",
}


@contextmanager
def regular_file(path: Path, expected: str, most: Limit) -> Iterator[BinaryIO]:
    """Open a regular file of no more bytes than the limit, for reading.

    ``expected`` names what the file should be. Raises Refused for a file that is missing, too large, or
    not regular, and for one that cannot be opened or read.
    """
    try:
        with _opened(path, expected, most) as file:
            yield file
    except FileNotFoundError:
        raise Refused([f"expected {expected}, got no such file @ {path}"]) from None
    except OSError as error:
        reason = error.strerror or str(error)
        raise Refused([f"expected {expected}, got {reason!r} @ {path}"]) from None


def read_bytes(path: Path, expected: str, most: Limit) -> bytes:
    """Return the whole content. Raises Refused as `regular_file` does, and for a file that grows."""
    with regular_file(path, expected, most) as file:
        return _whole(file, path, most)


def bounded_bytes(path: Path, expected: str, most: Limit) -> bytes:
    """Return the whole content as `read_bytes` does, but raise OSError for what cannot be opened."""
    with _opened(path, expected, most) as file:
        return _whole(file, path, most)


def _whole(file: BinaryIO, path: Path, most: Limit) -> bytes:
    content = file.read(most.most + 1)
    if len(content) > most.most:
        raise most.refusal("more", path)
    return content


@contextmanager
def _opened(path: Path, expected: str, most: Limit) -> Iterator[BinaryIO]:
    _check(_status(path, expected), path, expected, most)
    with open(path, "rb", opener=open_without_waiting) as file:
        _check(os.fstat(file.fileno()), path, expected, most)
        yield file


def _status(path: Path, expected: str) -> os.stat_result:
    try:
        return path.stat()
    except ValueError:  # a NUL in the name, or a character that this system cannot encode
        raise Refused([f"expected {expected}, got a name that no file has @ {path}"]) from None


def open_without_waiting(path: str, flags: int) -> int:
    """Open a file for `open`: a FIFO that nobody reads is an OSError, and holds nobody up."""
    # Windows has no such flag, and no FIFO that a name could lead to.
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))


def _check(status: os.stat_result, path: Path, expected: str, most: Limit) -> None:
    if not stat.S_ISREG(status.st_mode):
        kind = _KINDS.get(stat.S_IFMT(status.st_mode), "no regular file")
        is_piped = stat.S_ISFIFO(status.st_mode) and "trajectory" in expected
        mend = " (name it -, and hand it over on standard input)" if is_piped else ""
        raise Refused([f"expected {expected}, got {kind} @ {path}{mend}"])
    most.check(status.st_size, path)
