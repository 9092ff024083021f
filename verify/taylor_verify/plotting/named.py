"""Named line of a picture, without NumPy, for texts about pictures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

Spot = tuple[float, float]


@dataclass(frozen=True)
class Named:
    """A line with its name; its pieces are joined points in the axes' own units."""

    name: str
    colour: str
    pieces: Sequence[Sequence[Spot]]
