"""The folders that a call names: one run at a time in each, and what belongs to a checkout alone."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Final

from taylor_verify.cli.answer import WrongCall

_PROJECT: Final = 'name = "taylor-verify"'
_REPORTS: Final = "reports"
IN_A_CHECKOUT: Final = (
    "what is published belongs to a checkout of the project, and no package has it: go to one, or "
    "name a folder that `run --out` has written"
)


@contextmanager
def alone_in(folder: Path | None, option: str = "--out") -> Iterator[None]:
    """Keep other runs out of a folder while this one writes to it; None is no folder.

    Raises WrongCall if another run is there, or if the folder cannot be written.
    """
    from taylor_verify.batch import lock

    if folder is None:
        yield
        return
    with ExitStack() as stack:
        try:
            stack.enter_context(lock.alone_in(folder))
        except lock.Occupied as error:
            raise WrongCall(f"{error} ({option})") from error
        except OSError as error:
            raise _cannot_be_written(str(folder), option, error) from error
        yield


def reports_folder(folder: str | None, measures: bool) -> str:
    """The folder of `publish --from`, or the reports of the checkout around.

    Raises WrongCall outside a checkout, unless files are made from a folder that is named.
    """
    if folder is not None and (not measures or _checkout(Path(folder))):
        return folder
    root = _checkout(Path.cwd())
    if root is None:
        raise WrongCall(f"expected a checkout of taylor-verify, got {Path.cwd()}; {IN_A_CHECKOUT}")
    return folder if folder is not None else os.path.relpath(root / _REPORTS)


def _checkout(place: Path) -> Path | None:
    """The checkout of this project in which a place lies."""
    here = place.absolute()
    return next((path for path in (here, *here.parents) if _is_checkout(path)), None)


def _is_checkout(path: Path) -> bool:
    project = path / "pyproject.toml"
    try:
        is_ours = _PROJECT in project.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError):
        return False
    return is_ours and (path / "cases").is_dir()


def writable(folder: str, option: str = "--out") -> Path:
    """The folder, tried out before hours of work end in a refusal to write, and not yet made."""
    import tempfile

    path = Path(folder)
    try:
        if not folder:
            raise NotADirectoryError(0, "an empty name")
        with tempfile.TemporaryFile(dir=_nearest_existing(path)):
            return path
    except OSError as error:
        raise _cannot_be_written(folder, option, error) from error


def _cannot_be_written(folder: str, option: str, error: OSError) -> WrongCall:
    return WrongCall(
        f"expected a folder that can be written, got {folder!r} ({error.strerror}) @ {option}"
    )


def _nearest_existing(path: Path) -> Path:
    return next(folder for folder in (path, *path.absolute().parents) if folder.exists())
