"""The checkout of the project that is published from."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Final

from taylor_verify.cli.answer import WrongCall
from taylor_verify.cli.folders import IN_A_CHECKOUT

_PROJECT: Final = 'name = "taylor-verify"'
_REPORTS: Final = "reports"


def reports_folder(folder: str | None, measures: bool) -> str:
    """Return the folder of `publish --from`, or the reports of the checkout around.

    Raises WrongCall outside a checkout, unless files are made from a folder that is named.
    """
    if folder is not None and (not measures or _checkout(Path(folder))):
        return folder
    root = _checkout(Path.cwd())
    if root is None:
        raise WrongCall(f"expected a checkout of taylor-verify, got {Path.cwd()}; {IN_A_CHECKOUT}")
    return folder if folder is not None else os.path.relpath(root / _REPORTS)


def _checkout(place: Path) -> Path | None:
    """Return the checkout of this project in which a place lies."""
    here = place.absolute()
    return next((path for path in (here, *here.parents) if _is_checkout(path)), None)


def _is_checkout(path: Path) -> bool:
    try:
        project = (path / "pyproject.toml").read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return False
    return _PROJECT in project.splitlines() and (path / "cases").is_dir()
