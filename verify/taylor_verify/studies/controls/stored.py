"""The verdicts of every gate on every defect, as data/controls.json has them."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

from taylor_verify.records.json_text import complete, plain
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict, read_study
from taylor_verify.studies.controls.document import ControlsStudy
from taylor_verify.studies.stored import Stored

_APART: Final = ("digits", "sentence", "seconds", "provenance")
_SHIFT: Final = ("time_shift", "residual", "shift", "trend", "remains")


def _fields(study: ControlsStudy) -> dict[str, Any]:
    """Return keys and values as they are stored: of a verdict what is the same in every run."""
    rows = [_row(verdict) for verdict in study.verdicts]
    return {**complete(study), "machine": plain(study.machine), "verdicts": rows}


def _row(verdict: Verdict) -> dict[str, Any]:
    # Which way roundings push the time is another draw on every machine.
    apart = _APART if verdict.verdict is Status.FAIL else (*_APART, *_SHIFT)
    return {name: value for name, value in verdict.row().items() if name not in apart}


def _checked(file: Path, kind: type[ControlsStudy]) -> ControlsStudy:
    """Return the document in a file. Raises ValueError for a defect without its verdicts too."""
    study = read_study(file, kind)
    try:
        _ = study.sights
    except ValueError as error:
        raise ValueError(f"{error} @ {file}") from error
    return study


CONTROLS: Final = Stored(ControlsStudy, "controls", _fields, _checked)
