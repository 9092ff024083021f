"""Errors of a long answer, of which only some rows are there at a time.

An error is divided by a scale that is known when all rows have come, as the largest size of the motion is.
All rows are divided by the scale of the first block, and at the end by what is missing of the whole one. So
a row takes eight bytes, equal errors stay equal, and errors that came in one block are what they would be.
"""

from __future__ import annotations

from collections import defaultdict
from typing import Any

import numpy as np

from taylor_verify.judge.errors.state import Column, Distances, Errors, Floats, in_doubles, or_one
from taylor_verify.scenes.motion import Motion


def joined(one: Motion, other: Motion) -> Motion:
    """Return the rows of a motion and those of another one behind them."""
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
        """Return all of them over the last scale, and that scale."""
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
        # By quantity and part.
        self._sizes: dict[tuple[str, str], Any] = {}
        self._errors: defaultdict[tuple[str, str], Series] = defaultdict(Series)
        self._widths: defaultdict[tuple[str, str], Series] = defaultdict(Series)

    def add(self, found: Distances) -> dict[str, Any]:
        """Take in the next rows of one quantity, and return its scales so far."""
        scales = {}
        self._about[found.quantity] = found
        for part, distances in found.distances.items():
            key = found.quantity, part
            self._sizes[key] = _larger(self._sizes.get(key), found.sizes[part])
            scales[part] = scale = or_one(self._sizes[key])
            self._errors[key].add(distances, scale)
            self._widths[key].add(found.widths[part], scale)
        return scales

    def errors(self) -> list[Errors]:
        """Return the errors of all rows, in the order in which the quantities came first."""
        return [self._joined(about) for about in self._about.values()]

    def _joined(self, about: Distances) -> Errors:
        name = about.quantity
        values = {part: self._errors[name, part].joined() for part in about.distances}
        scales = {part: scale for part, (_, scale) in values.items()}
        larger = np.maximum.reduce([rows for rows, _ in values.values()])
        width = np.maximum.reduce([self._widths[name, part].joined()[0] for part in values])
        return Errors(name, about.unit, larger, width, scales, is_state=True)


def _larger(one: Any, other: Any) -> Any:
    """The larger size; NaN stays."""
    return one if one is not None and not (other > one) and other == other else other
