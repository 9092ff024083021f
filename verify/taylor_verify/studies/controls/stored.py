"""The verdicts of every gate on every defect, as data/controls.json has them."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

from taylor_verify.records import store
from taylor_verify.records.json_text import complete, plain
from taylor_verify.records.replacement import replace_files
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict, read_study
from taylor_verify.studies.controls.document import ControlsStudy

CONTROLS: Final = f"{store.FOLDER}/controls.json"

_MADE_BY: Final = {"made_by": "taylor-verify publish --controls; do not edit"}
_APART: Final = ("digits", "sentence", "seconds", "provenance")
_SHIFT: Final = ("time_shift", "residual", "shift", "trend", "remains")


def write(folder: Path, study: ControlsStudy) -> Path:
    """Store a controls run below ``folder``. Raises OSError."""
    rows = {"machine": plain(study.machine), "verdicts": [_row(each) for each in study.verdicts]}
    text = store.laid_out({**_MADE_BY, **complete(study), **rows})
    (file,) = replace_files(folder, {CONTROLS: text})
    return file


def load(folder: Path) -> ControlsStudy:
    """Return the controls run that is stored below ``folder``.

    Raises OSError for a file that cannot be read and ValueError for one that holds something else.
    """
    file = folder / CONTROLS
    study = read_study(file, ControlsStudy)
    try:
        _ = study.sights
    except ValueError as error:
        raise ValueError(f"{error} @ {file}") from error
    return study


def _row(verdict: Verdict) -> dict[str, Any]:
    # Which way roundings push the time is another draw on every machine.
    apart = _APART if verdict.verdict is Status.FAIL else (*_APART, *_SHIFT)
    return {name: value for name, value in verdict.row().items() if name not in apart}
