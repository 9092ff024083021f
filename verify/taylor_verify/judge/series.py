"""Errors of a long answer, of which only some rows are there at a time.

An error is divided by a scale that is known when all rows have come, as the largest size of the motion is.
Each block is divided by the scale so far, and by what is missing of the whole one at the end: a factor that
is 1 unless the motion grows. So it costs eight bytes for each row, and an answer in one block nothing.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Final

import numpy as np

from taylor_verify.judge.errors import Column, Distances, Errors, Floats, in_doubles, or_one
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
    """Numbers over a scale that does not shrink, in blocks, as float64."""

    def __init__(self) -> None:
        self._blocks: list[Floats] = []
        self._scales: list[Any] = []

    def add(self, values: Column, scale: Any) -> None:
        """Take in numbers that are divided by ``scale`` already, the scale of all rows so far."""
        self._blocks.append(in_doubles(values))
        self._scales.append(scale)

    def joined(self) -> tuple[Floats, Any]:
        """All of them over the last scale, and that scale."""
        last = self._scales[-1]
        for block, scale in zip(self._blocks, self._scales, strict=True):
            if scale != last:
                block *= float(scale / last)
        self._blocks = [np.concatenate(self._blocks)]
        self._scales = [last]
        return self._blocks[0], last


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
            self._errors.setdefault(key, Series()).add(distances / scale, scale)
            self._widths.setdefault(key, Series()).add(found.widths[part] / scale, scale)
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
