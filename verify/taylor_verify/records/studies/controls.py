"""The verdicts of every gate on every deliberate defect, and on its sound twin."""

from __future__ import annotations

from dataclasses import dataclass

from taylor_verify.records.provenance import Machine
from taylor_verify.records.verdict import Verdict


@dataclass(frozen=True)
class DefectRow:
    """One defect in words; ``twin`` names the sound solver that differs from it by the defect alone."""

    name: str
    setting: str
    scene: str
    gate: str
    what: str
    why: str
    told: bool
    twin: str
    twin_setting: str


@dataclass(frozen=True)
class ControlsStudy:
    """All defects, and the verdicts on them by solver and setting."""

    versions: dict[str, str]
    machine: Machine
    factor: int
    defects: tuple[DefectRow, ...]
    verdicts: tuple[Verdict, ...]
