"""A run of all extremes, every row beside what was expected of it."""

from __future__ import annotations

from dataclasses import dataclass

from taylor_verify.records.answers import LeftOut
from taylor_verify.records.provenance import Machine
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict


@dataclass(frozen=True)
class ExpectedOfRow:
    """What was expected of one row."""

    scene: str
    rung: str
    quantity: str
    verdict: Status
    why: str


@dataclass(frozen=True)
class Titled:
    """A scene and its title."""

    scene: str
    title: str


@dataclass(frozen=True)
class ExtremesStudy:
    """All verdicts, what was expected of the rows that were compared with the file, and what differs."""

    versions: dict[str, str]
    machine: Machine
    scenes: tuple[Titled, ...]
    left_out: tuple[LeftOut, ...]
    mismatches: tuple[str, ...]
    expected: tuple[ExpectedOfRow, ...]
    verdicts: tuple[Verdict, ...]
