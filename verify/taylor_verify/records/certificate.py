"""Proven bounds of the error of a dense answer for all times, and what was found out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from typing import Any


class GapKind(Enum):
    """A fault of the extent of a dense answer."""

    JUMP = "jump"
    NOT_COVERED = "not covered"
    NOT_ANSWERED = "not in the answer"


@dataclass(frozen=True)
class Gap:
    """A place at which an answer jumps, by ``size``, or from which on it is missing, until ``end``."""

    kind: GapKind
    quantity: str
    at: float
    end: float | None = None
    size: float | None = None


class Fault(Enum):
    """A fault of an interpolant that its errors show."""

    BETWEEN = "the interpolant, not the steps"
    SLOPES = "the slopes at the nodes are those of the step before"
    NODES = "pieces that meet do not share their node"
    ABSCISSA = "the abscissa is off as a float32 is"


@dataclass(frozen=True)
class InterpolantFinding:
    """A fault of a quantity: its errors at the nodes, and between them."""

    quantity: str
    fault: Fault
    at_nodes: float
    between: float


@dataclass(frozen=True)
class Certified:
    """Proven bounds of the error of a dense answer, for all times of the span that it covers.

    ``bound`` and ``at`` are by quantity: the largest error, in the measures of the judge (relative to the
    largest size of vectors, radians for the attitude, by the length of its way for the centre, relative to
    the largest size so far for own states), and the time near which it is reached. ``largest`` are errors
    that are reached there, to a percent, and ``rounding`` bounds what the evaluation of the pieces in
    float64 adds. ``because`` says why nothing is proven, where that is so.
    """

    scene: str
    bound: Mapping[str, float]
    at: Mapping[str, float]
    largest: Mapping[str, float] = field(default_factory=dict)
    rounding: Mapping[str, float] = field(default_factory=dict)
    gaps: tuple[Gap, ...] = ()
    findings: tuple[InterpolantFinding, ...] = ()
    tolerance: float | None = None
    because: str = ""

    @property
    def passed(self) -> bool:
        """True if every bound is at most the tolerance, or without one if no gap was found.

        What is not covered by the answer never passes.
        """
        if self.because or not self.bound:
            return False
        if self.tolerance is None:
            return not self.gaps
        is_whole = all(gap.kind is GapKind.JUMP for gap in self.gaps)
        return is_whole and all(bound <= self.tolerance for bound in self.bound.values())

    @property
    def is_undecided(self) -> bool:
        """True if it does not pass, and nothing is known to be wrong.

        Wrong is an error beyond the tolerance, or without one a jump.
        """
        if self.tolerance is None:
            is_wrong = any(gap.kind is GapKind.JUMP for gap in self.gaps)
        else:
            is_wrong = any(error > self.tolerance for error in self.largest.values())
        return not (self.passed or is_wrong)

    def rows(self) -> list[dict[str, Any]]:
        """Return a row for each quantity."""
        return [
            {
                "quantity": name,
                "bound": bound,
                "at": self.at[name],
                "largest": self.largest[name],
                "rounding": self.rounding[name],
            }
            for name, bound in self.bound.items()
        ]
