"""Errors of a long answer, of which only some rows are there at a time.

An error is divided by a scale that is known when all rows have come, as the largest size of the motion is.
All rows are divided by the scale of the first block, and at the end by what is missing of the whole one. So
a row takes eight bytes, equal errors stay equal, and errors that came in one block are what they would be.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Final

import numpy as np

from taylor_verify.judge.errors.state import Column, Distances, Errors, Floats, in_doubles, or_one
from taylor_verify.scenes.motion import Motion

# So many rows are compared at once. A row takes some kB in numbers of mpmath.
BLOCK: Final = 4096
# Taylor series begin at the start again for every block.
BLOCK_OF_SERIES: Final = 32768


def blocks(rows: int, size: int) -> Iterator[range]:
    """Yield the places of so many rows in order, ``size`` of them at once."""
    for begin in range(0, rows, size):
        yield range(begin, min(begin + size, rows))


def joined(one: Motion, other: Motion) -> Motion:
    """The rows of a motion and those of another one behind them."""
    both = {n: np.concatenate([rows, other[n]]) for n, rows in one.quantities.items()}
    return Motion(both, np.concatenate([one.radius, other.radius]))


class Series:
    """Numbers of which blocks come one by one, over a scale of all of them, as float64."""

    def __init__(self) -> None:
        self._blocks: list[Floats] = []
        self._first: Any = None
        self._scale: Any = None

    def add(self, values: Column, scale: Any) -> None:
        """Take in further numbers, and the scale of all that have come."""
        self._scale = scale
        if not self._blocks:
            self._first = scale
        self._blocks.append(in_doubles(values / self._first))

    def joined(self) -> tuple[Floats, Any]:
        """All of them over the last scale, and that scale."""
        found = np.concatenate(self._blocks)
        if self._first != self._scale:
            found *= float(self._first / self._scale)
        # The blocks are not kept beside it.
        self._blocks, self._first = [found], self._scale
        return found, self._scale


class States:
    """The errors of all state quantities of an answer whose rows come in blocks."""

    def __init__(self) -> None:
        self._about: dict[str, Distances] = {}
        self._sizes: dict[tuple[str, str], Any] = {}
        self._errors: dict[tuple[str, str], Series] = {}
        self._widths: dict[tuple[str, str], Series] = {}

    def add(self, found: Distances) -> dict[str, Any]:
        """Take in the next rows of one quantity, and return its scales so far."""
        scales = {}
        self._about[found.quantity] = found
        for part, distances in found.distances.items():
            key = found.quantity, part
            size = _larger(self._sizes.get(key), found.sizes[part])
            self._sizes[key] = size
            scales[part] = scale = or_one(size)
            self._errors.setdefault(key, Series()).add(distances, scale)
            self._widths.setdefault(key, Series()).add(found.widths[part], scale)
        return scales

    def errors(self) -> list[Errors]:
        """The errors of all rows, in the order in which the quantities came first."""
        return [self._joined(about) for about in self._about.values()]

    def _joined(self, about: Distances) -> Errors:
        keys = [(about.quantity, part) for part in about.distances]
        values = {part: self._errors[name, part].joined() for name, part in keys}
        widths = [self._widths[key].joined()[0] for key in keys]
        scales: Mapping[str, Any] = {part: scale for part, (_, scale) in values.items()}
        larger = np.maximum.reduce([rows for rows, _ in values.values()])
        width = np.maximum.reduce(widths)
        return Errors(about.quantity, about.unit, larger, width, dict(scales), is_state=True)


def _larger(one: Any, other: Any) -> Any:
    """The larger size; NaN stays."""
    return one if one is not None and not (other > one) and other == other else other
