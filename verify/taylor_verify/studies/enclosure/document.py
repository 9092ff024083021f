"""The proven width of an enclosure over time, and its true error."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class WidthRow:
    """One instant of one motion; ``width`` and ``error`` are relative to the vector."""

    scene: str
    t: float
    width: float
    error: float


@dataclass(frozen=True)
class EnclosureStudy:
    """All rows, of enclosures with so many bits."""

    bits: int
    rows: tuple[WidthRow, ...]
