"""The files of a board in a report folder: its rows, and times with their machine."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from taylor_verify.records.json_text import complete, plain
from taylor_verify_reports.studies.engines.document import Board, EnginesStudy, EnginesTimings
from taylor_verify_reports.studies.engines.entry import BOARDS
from taylor_verify_reports.studies.stored import Stored


def _fields(study: EnginesStudy) -> Mapping[str, Any]:
    """Return the stored keys and values; fields with their default are left out of the many rows."""
    rows = [plain(row) for row in study.rows]
    return {"versions": study.versions, "spans": study.spans, "rows": rows}


class Places(NamedTuple):
    """The files of a board: rows and times."""

    rows: Stored[EnginesStudy]
    timings: Stored[EnginesTimings]


def places(board: str) -> Places:
    """Return the files of a board."""
    return Places(
        Stored(EnginesStudy, board, _fields),
        Stored(EnginesTimings, board, complete, stem=f"{board}-timings"),
    )


ENGINES, TIMINGS = places(BOARDS[0])


def write(folder: Path, board: Board) -> list[Path]:
    """Store a board below a report folder. Raises OSError."""
    place = places(board.name)
    # The rows come last, because they refer to the times.
    return [
        *place.timings.write(folder, board.timings),
        *place.rows.write(folder, board.study),
    ]


def find(folder: Path, name: str = BOARDS[0]) -> Board | None:
    """Return the board of that name below a report folder; None if it is not stored there.

    Raises OSError for files that cannot be read and ValueError for files that hold something else.
    """
    place = places(name)
    study = place.rows.find(folder)
    return None if study is None else Board(study, place.timings.load(folder), name)
