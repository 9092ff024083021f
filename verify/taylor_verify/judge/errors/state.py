"""Errors of a trajectory against the truth, sample by sample, in the units of design section 6.

Of a long answer only some rows are there at a time. An error is divided by a scale that is known when all
rows have come, as the largest size of the motion is. All rows are divided by the scale of the first block,
and at the end by what is missing of the whole one. So a row takes eight bytes, equal errors stay equal, and
errors that came in one block are what they would be.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import ulp
from typing import Any, Final

import numpy as np
from mpmath import mp, mpf

from taylor_verify.judge.velocities import exact_matrix, velocity_forms
from taylor_verify.records.quantities import Measure, Quantity, state_quantities
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.mpfr import precision, sqrt, to_mpf, to_mpfr
from taylor_verify.scenes.scene import Scene

Column = np.ndarray[Any, Any]
Floats = np.ndarray[Any, np.dtype[np.float64]]

_LEAST: Final = ulp(0.0)


@dataclass(frozen=True)
class Errors:
    """The error of one quantity at every sample, as mpf or float64, in ``unit``.

    ``parts`` names the quantities of the motion that it compares, each with the scale its error is
    divided by; ``truth_radius`` is how wide the truth is, in the same unit. ``is_state`` tells the
    quantities that say where the body is from those it conserves. ``change`` is the error of the last
    sample with its sign, of a conserved number.
    """

    quantity: str
    unit: str
    values: Column
    truth_radius: Column
    parts: dict[str, Any]
    is_state: bool = False
    change: float | None = None

    @cached_property
    def doubles(self) -> Floats:
        """The values in float64, as bounds are."""
        return in_doubles(self.values)

    @cached_property
    def widths(self) -> Floats:
        """The truth's radii in float64."""
        return in_doubles(self.truth_radius)


def in_doubles(values: Column) -> Floats:
    """Return the values as float64. What is not zero does not become it."""
    if values.dtype != object:
        return values
    return np.array([float(value) or (_LEAST if value else 0.0) for value in values])


@dataclass(frozen=True)
class Distances:
    """The distances of one quantity from the truth at some samples, part by part, without a scale.

    ``widths`` are those of the truth, in the unit of the distances. ``sizes`` are what the scales are made
    of: the scale of a part is its size, or 1 where that is zero.
    """

    quantity: str
    unit: str
    distances: Mapping[str, Column]
    widths: Mapping[str, Column]
    sizes: Mapping[str, Any]

    def errors(self) -> Errors:
        """Return the errors over the scales of these samples; the larger part counts."""
        scales = {part: or_one(size) for part, size in self.sizes.items()}
        values = _larger([rows / scales[part] for part, rows in self.distances.items()])
        radius = _larger([rows / scales[part] for part, rows in self.widths.items()])
        return Errors(self.quantity, self.unit, values, radius, scales, is_state=True)


def state_errors(scene: Scene, truth: Motion, answer: Motion) -> list[Errors]:
    """Return the errors of everything tracked, evaluated at the ambient precision of mpmath."""
    return [found.errors() for found in state_distances(scene, truth, answer)]


def state_distances(
    scene: Scene, truth: Motion, answer: Motion, arc: Arc | None = None
) -> list[Distances]:
    """Return the distances of everything tracked; ``arc`` is the path before these samples."""
    found = []
    for quantity in state_quantities(scene.model, scene.track):
        if quantity.measure is Measure.ANGLE:
            found.append(_angles(quantity, truth, answer))
            continue
        is_path = quantity.measure is Measure.PATH
        length = (arc or Arc()).through(scene, truth) if is_path else None
        found.append(_vectors(quantity, truth, answer, length))
    return found


def _vectors(quantity: Quantity, truth: Motion, answer: Motion, size: Any) -> Distances:
    """Return the distances of vectors; without a ``size`` that of each part is its largest norm."""
    parts = quantity.groups
    sizes = {part: norms(truth[part]) for part in parts}
    return Distances(
        quantity.name,
        quantity.unit,
        {part: norms(answer[part] - truth[part]) for part in parts},
        {part: truth.radius_of(part) * np.array([*map(or_one, sizes[part])]) for part in parts},
        {part: largest(sizes[part]) if size is None else size for part in parts},
    )


def _larger(by_part: Sequence[Column]) -> Column:
    """Sample by sample the largest of all parts."""
    if len(by_part) == 1:
        return by_part[0]
    return np.array([largest(row) for row in zip(*by_part, strict=True)], dtype=object)


def _angles(quantity: Quantity, truth: Motion, answer: Motion) -> Distances:
    """Return the angle of R_exact^T R: |R - R_exact| in the Frobenius norm is 2 sqrt 2 sin(angle/2)."""
    name = quantity.name
    chords = norms(answer[name] - truth[name]) / (2 * mp.sqrt(2))
    angles = [2 * mp.asin(chord) if chord <= 1 else mp.pi + 0 * chord for chord in chords]
    # |R|_F is sqrt 3, so a relative radius is less than this many radians.
    widths = 2 * truth.radius_of(name)
    distances = np.array(angles, dtype=object)
    return Distances(name, quantity.unit, {name: distances}, {name: widths}, {name: mpf(1)})


@dataclass
class Arc:
    """The length of the centre's path, by the trapezium rule from the speed |U| at the samples.

    ``length`` is that so far, up to the time and the speed of ``end``.
    """

    length: Any = 0
    end: tuple[Any, Any] | None = None

    def through(self, scene: Scene, truth: Motion) -> Any:
        """Take in further samples, at the instants of the scene, and return the length so far."""
        forms = velocity_forms(scene.body).forms["linear_velocity"]
        terms = [(to_mpfr(truth[name]), to_mpfr(exact_matrix(m))) for name, m in forms.items()]
        with precision():
            U = sum(rows @ matrix.T for rows, matrix in terms)
            speeds = to_mpf(sqrt(np.sum(U * U, axis=1)))
        for elapsed, speed in zip(scene.clock.elapsed, speeds, strict=True):
            time = mp.convert(elapsed)
            # The start is not always sampled; the speed there is close enough to the first sample's.
            since, before = self.end or (mpf(0), speed)
            self.length = self.length + abs(time - since) * (before + speed) / 2
            self.end = time, speed
        return self.length


def norms(rows: Column) -> Column:
    """Return the Frobenius norm of every row (vectors or matrices) of numbers of mpmath."""
    flat = to_mpfr(rows.reshape(len(rows), -1))
    with precision():
        return to_mpf(sqrt(np.sum(flat * flat, axis=1)))


def largest(values: Any) -> Any:
    """Return the largest value, or NaN if any is NaN (Python's max would lose it)."""
    values = list(values)
    nan = next((value for value in values if value != value), None)
    return max(values) if nan is None else nan


def or_one(scale: Any) -> Any:
    """Return the scale, or 1 for one that is zero or no number."""
    return scale if scale > 0 else mpf(1)


# Rows that come in blocks.


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
            before, size = self._sizes.get(key), found.sizes[part]
            # The larger size; NaN stays.
            if before is None or size > before or size != size:
                self._sizes[key] = size
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
