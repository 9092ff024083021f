"""The document of the engine board: a row for each run; times and machine are stored separately."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from functools import cached_property
from pathlib import Path
from typing import Any, Final, NamedTuple

from taylor_verify.records.json_text import complete, plain
from taylor_verify.records.provenance import Machine
from taylor_verify_reports.studies.engines.entry import BOARDS
from taylor_verify_reports.studies.stored import Stored

# State quantities that an engine answers, if the scene tracks them.
STATES: Final = ("omega", "impulse", "attitude", "centre")


class Standing(StrEnum):
    """The end of a run."""

    JUDGED = "judged"
    FAILED = "failed"
    UNAVAILABLE = "unavailable"
    UNSUITED = "unsuited"


@dataclass(frozen=True)
class EngineRow:
    """A run: its settings, and the judgement of its stored trajectory.

    ``knob`` is the option that sets the accuracy, and ``value`` its value as text; ``variant`` has the
    method and the other options. ``errors`` are the largest errors of all samples by quantity, relative or
    in radians, to four digits; errors that are no finite number are left out. ``floors`` are the errors of
    the states that perfect rounding would leave. ``start`` is the error of the first row. ``cause`` is the
    fault of the dynamics that, as the judge supposes, explains nearly all of the error; it is looked for at
    the coarsest value alone. ``made_of`` is the digest of the scene and the adapter. ``load`` says how the
    loads of a scene reach the engine.
    """

    engine: str
    version: str
    variant: str
    value: str
    scene: str
    rung: str
    solver: str
    standing: Standing
    made_of: str
    knob: str = "step"
    shipped: bool = False
    detail: str = ""
    steps: int = 0
    start: float | None = None
    errors: dict[str, float] = field(default_factory=dict)
    floors: dict[str, float] = field(default_factory=dict)
    cause: str = ""
    load: str = ""

    @property
    def key(self) -> str:
        """The text that identifies the run."""
        return f"{self.solver} {self.rung} {self.scene}"

    @property
    def is_judged(self) -> bool:
        """True if the run ended with a trajectory that was compared."""
        return self.standing is Standing.JUDGED

    @property
    def worst(self) -> float:
        """The largest error of the states; infinite if one is missing or no finite number."""
        errors = [self.errors[name] for name in self.floors if name in self.errors]
        lost = [name for name in self.floors if name not in self.errors]
        return float("inf") if lost or not errors else max(errors)


@dataclass(frozen=True)
class EnginesTimings:
    """The seconds of each run's propagation by its key, and the machine with ``workers`` runs at a time."""

    workers: int
    machine: Machine
    seconds: dict[str, float]


@dataclass(frozen=True)
class EnginesStudy:
    """All rows, in the order of the entry list; ``spans`` are durations in each scene's unit of time."""

    versions: dict[str, str]
    spans: dict[str, float]
    rows: tuple[EngineRow, ...]


@dataclass(frozen=True)
class Board:
    """The document of the study: the rows, and their times, which are stored in another file."""

    study: EnginesStudy
    timings: EnginesTimings
    name: str = "engines"

    @cached_property
    def numbers(self) -> dict[str, int]:
        """The number of each run by its key, from 0 on."""
        return {row.key: number for number, row in enumerate(self.study.rows)}

    def pace(self, row: EngineRow) -> float | None:
        """Return the seconds of a run per unit of the scene's time; None if they are unknown."""
        seconds = self.timings.seconds.get(row.key, 0.0)
        return seconds / self.study.spans[row.scene] if seconds > 0 else None


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
