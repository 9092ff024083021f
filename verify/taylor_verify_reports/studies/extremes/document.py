"""Verdicts on all extremes, each beside the expected verdict."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from taylor_verify.records.answers import LeftOut
from taylor_verify.records.json_text import complete
from taylor_verify.records.provenance import Machine
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict


@dataclass(frozen=True)
class Expected:
    """An expected verdict, and the reason for it unless it is a pass."""

    verdict: Status
    why: str


@dataclass(frozen=True)
class ExtremeVerdict(Verdict):
    """A verdict beside the expected one; None if nothing is expected of this row."""

    expected: Expected | None = None

    @property
    def is_met(self) -> bool:
        """True unless the verdict differs from the expected one."""
        return self.expected is None or self.expected.verdict is self.verdict

    @classmethod
    def of(cls, verdict: Verdict, expected: Expected | None) -> ExtremeVerdict:
        """Return a verdict with the expected one."""
        return cls(**vars(verdict), expected=expected)

    def row(self) -> dict[str, Any]:
        """Return the row as JSON holds it."""
        return {**super().row(), "expected": complete(self.expected)}


@dataclass(frozen=True)
class Titled:
    """A scene and its title."""

    scene: str
    title: str


@dataclass(frozen=True)
class ExtremesStudy:
    """All verdicts, the mismatches in words, and the runs that were left out."""

    versions: dict[str, str]
    machine: Machine
    scenes: tuple[Titled, ...]
    left_out: tuple[LeftOut, ...]
    mismatches: tuple[str, ...]
    verdicts: tuple[ExtremeVerdict, ...]

    @cached_property
    def titles(self) -> dict[str, str]:
        """The title of each scene."""
        return {titled.scene: titled.title for titled in self.scenes}
