"""The proven width of an enclosure over time, and its true error."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class WidthRow:
    """The enclosure at the time ``t`` of a motion: its width and error, relative to the state vector."""

    scene: str
    t: float
    width: float
    error: float


@dataclass(frozen=True)
class EnclosureStudy:
    """The rows of all motions; ``bits`` is the precision of the enclosures."""

    bits: int
    rows: tuple[WidthRow, ...]
