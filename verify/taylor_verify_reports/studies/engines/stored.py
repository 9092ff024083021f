"""The files of the board in a report folder: rows, times with their machine, and trajectories."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from taylor_verify.records.json_text import complete, plain
from taylor_verify.records.replacement import replace_files
from taylor_verify_reports.studies.engines.document import Board, EnginesStudy, EnginesTimings
from taylor_verify_reports.studies.stored import Stored


def _fields(study: EnginesStudy) -> Mapping[str, Any]:
    """Return the stored keys and values; fields with their default are left out of the many rows."""
    rows = [plain(row) for row in study.rows]
    return {"versions": study.versions, "spans": study.spans, "rows": rows}


TRAJECTORIES: Final = "data/engines/trajectories.npz"
ENGINES: Final = Stored(EnginesStudy, "engines", _fields)
TIMINGS: Final = Stored(EnginesTimings, "engines", complete, stem="engines-timings")


def write(folder: Path, board: Board, file: bytes) -> list[Path]:
    """Store a board and ``file``, the bytes of its trajectories, below a report folder. Raises OSError."""
    # The rows come last, because they refer to the other files.
    return [
        *replace_files(folder, {TRAJECTORIES: file}),
        *TIMINGS.write(folder, board.timings),
        *ENGINES.write(folder, board.study),
    ]


def find(folder: Path) -> Board | None:
    """Return the board that is stored below a report folder; None if there is none.

    Raises OSError for files that cannot be read and ValueError for files that hold something else.
    """
    study = ENGINES.find(folder)
    return None if study is None else Board(study, TIMINGS.load(folder))
