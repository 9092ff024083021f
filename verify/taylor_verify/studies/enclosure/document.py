"""The proven width of an enclosure over time, and its true error."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class WidthRow:
    """Instant of a motion; ``width`` and ``error`` are relative to the vector."""

    scene: str
    t: float
    width: float
    error: float


@dataclass(frozen=True)
class EnclosureStudy:
    """Document of all rows; ``bits`` is the precision of the enclosures."""

    bits: int
    rows: tuple[WidthRow, ...]
