"""The folders that a call names: locked by one run at a time, tried out before the work."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Final

from taylor_verify.batch import lock
from taylor_verify.cli.answer import WrongCall, wrong_calls

# Bytes of a file name that are not UTF-8, as Python has them.
_FOREIGN: Final = re.compile("[\ud800-\udfff]")
_FOLDER: Final = "a folder that can be written"
# Folders of names that stand for a device or a stream of the process.
_DEVICES: Final = tuple(map(Path, ("/dev", "/dev/fd", "/proc/self/fd")))
IN_A_CHECKOUT: Final = (
    "what is published belongs to a checkout of the project, and no package has it: go to one, or "
    "name a folder that `run --out` has written"
)


@contextmanager
def alone_in(folder: Path | None, option: str = "--out") -> Iterator[None]:
    """Keep other runs out of a folder while this one writes to it; None is no folder.

    Raises WrongCall if another run is there, or if the folder cannot be written.
    """
    with ExitStack() as stack:
        if folder is not None:
            with (
                wrong_calls(f" ({option})", lock.Occupied),
                unwritable(_FOLDER, str(folder), option),
            ):
                stack.enter_context(lock.alone_in(folder))
        yield


def writable(folder: str, option: str = "--out", names: Iterable[str] = ()) -> Path:
    """Return the folder if it can be written, tried out before hours of work; it is not made yet.

    ``names`` are those that its files will mention. Like that of the folder, they must be UTF-8.
    """
    with unwritable(_FOLDER, folder, option):
        if not folder:
            raise NotADirectoryError(0, "an empty name")
        for name in (folder, *names):
            if _FOREIGN.search(name):
                raise OSError(0, f"the name {name!r} is not UTF-8")
        return _tried(Path(folder), [Path(folder)])


def writable_file(name: str, option: str) -> Path:
    """Return the file if it can be written, its folder tried out before hours of work.

    A link stands for the file that it leads to. A device and a pipe are refused: the new file would take
    their place. So is a file in a folder that does not exist, which may be a slip of the pen.
    """
    path = Path(name)
    with unwritable("a file that can be written", name, option):
        if not name or path.is_dir():
            raise IsADirectoryError(0, "a folder" if name else "an empty name")
        if (path.exists() and not path.is_file()) or path.absolute().parent in _DEVICES:
            raise OSError(0, "a device or a pipe")
        path = path.resolve() if path.is_symlink() else path
        if not path.absolute().parent.exists():
            raise FileNotFoundError(0, f"there is no folder {path.parent}")
        return _tried(path)


@contextmanager
def unwritable(expected: str, name: str, option: str) -> Iterator[None]:
    """Report an error of writing as a wrong call."""
    try:
        yield
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise WrongCall(f"expected {expected}, got {name!r} ({reason}) @ {option}") from error


def not_written(error: OSError, option: str) -> str:
    """Return the message for a file that could not be written at the end of the work."""
    place = f" @ {error.filename}" if error.filename else ""
    return f"expected to write, got {error.strerror or error}{place} ({option})"


def _tried(path: Path, within: Iterable[Path] = ()) -> Path:
    """Return a path behind a file that was made for a moment in the nearest folder there is."""
    import tempfile

    nearest = next(place for place in (*within, *path.absolute().parents) if place.exists())
    with tempfile.TemporaryFile(dir=nearest):
        return path
