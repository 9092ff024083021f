"""A folder for one process at a time: a lock that the system releases when its holder dies."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

LOCK: Final = ".taylor-verify.lock"
# Where in the file its holder is named: on Windows the first byte is locked, and nobody else reads it.
_NAME_AT: Final = 1


class Occupied(RuntimeError):  # noqa: N818 (it names the state of the folder)
    """Another process works in the folder; the text names both."""


@contextmanager
def alone_in(folder: Path) -> Iterator[None]:
    """Hold the lock of a folder, which is made if it is missing.

    Afterwards the lock file is removed, and every folder that was made and is still empty. Raises
    Occupied if another process or thread holds the lock, and OSError if the folder cannot be written.
    """
    made = [path for path in (folder, *folder.absolute().parents) if not path.exists()]
    handle = _locked(folder)
    try:
        yield
    finally:
        # In this order: whoever opens the file meanwhile sees that it is gone, and opens another.
        with suppress(OSError):
            os.unlink(folder / LOCK)
        os.close(handle)
        if os.name == "nt":
            # Windows removes no file that is open.
            with suppress(OSError):
                os.unlink(folder / LOCK)
        for path in made:
            with suppress(OSError):
                path.rmdir()


def _locked(folder: Path) -> int:
    while True:
        folder.mkdir(parents=True, exist_ok=True)
        handle = os.open(folder / LOCK, os.O_RDWR | os.O_CREAT, 0o666)
        try:
            if not _lock(handle):
                os.lseek(handle, _NAME_AT, os.SEEK_SET)
                holder = os.read(handle, 20).decode(errors="replace").strip()
                raise Occupied(
                    "expected a folder that no other run writes to, got one in use by "
                    f"process {holder or 'unknown'} @ {folder}"
                )
            if _is_in_place(handle, folder / LOCK):
                os.ftruncate(handle, 0)
                os.write(handle, f"{' ' * _NAME_AT}{os.getpid()}\n".encode())
                return handle
        except BaseException:
            os.close(handle)
            raise
        os.close(handle)


def _lock(handle: int) -> bool:
    """Return False if another process or thread has it; a filesystem without locks lets everybody in."""
    # Not at the top: most runs write to no folder, and it takes 60 ms.
    from filelock import lock_descriptor

    try:
        return lock_descriptor(handle, blocking=False)
    except OSError:
        return True


def _is_in_place(handle: int, file: Path) -> bool:
    """Return False if its former holder removed the file after it was opened here."""
    try:
        return os.path.samestat(os.fstat(handle), os.stat(file))
    except FileNotFoundError:
        return False
