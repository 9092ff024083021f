"""A run of all extremes, every row with the expected verdict."""

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
    """The expected verdict of a row, and the reason if it is no pass."""

    verdict: Status
    why: str


@dataclass(frozen=True)
class ExtremeVerdict(Verdict):
    """A verdict and the expected one; None if the row was compared with nothing."""

    expected: Expected | None = None

    @property
    def is_met(self) -> bool:
        """False for a mismatch; a row that was compared with nothing is no mismatch."""
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
    """Document of all verdicts, of the mismatches, and of the runs that were not made."""

    versions: dict[str, str]
    machine: Machine
    scenes: tuple[Titled, ...]
    left_out: tuple[LeftOut, ...]
    mismatches: tuple[str, ...]
    verdicts: tuple[ExtremeVerdict, ...]

    @cached_property
    def titles(self) -> dict[str, str]:
        """The title of each scene."""
        return {each.scene: each.title for each in self.scenes}
