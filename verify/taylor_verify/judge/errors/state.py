"""Errors of a trajectory relative to the truth, at every sample.

A long answer is read in blocks of rows. An error is divided by a scale, such as the largest size of the
motion, that is known only after the last block. So all rows are divided by the scale of the first block,
and at the end by the ratio of the two scales. A row takes eight bytes, equal errors stay equal, and
errors of a single block are not changed.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from math import ulp
from typing import Any, Final

import numpy as np
from mpmath import mp, mpf

from taylor_verify.judge.velocities import exact_matrix, velocity, velocity_forms
from taylor_verify.records.quantities import GROUPS, QUANTITIES, Measure, Quantity
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.mpfr import precision, sqrt, to_mpf, to_mpfr
from taylor_verify.scenes.scene import Scene

Column = np.ndarray[Any, Any]
Floats = np.ndarray[Any, np.dtype[np.float64]]

_LEAST: Final = ulp(0.0)


@dataclass(frozen=True)
class Errors:
    """Errors of one quantity at every sample (n,), in ``unit``.

    ``parts`` maps each compared quantity of the motion to the scale of its error. ``truth_radius`` is the
    error bound of the truth, in the same unit. ``is_state`` is True for states and False for conserved
    quantities. ``change`` is the signed error of the last sample, for a conserved scalar. ``sizes`` are
    those by which each error was divided besides: of a state of a scene's own, its largest so far.
    """

    quantity: str
    unit: str
    values: Floats
    truth_radius: Floats
    parts: dict[str, Any]
    is_state: bool = False
    change: float | None = None
    sizes: Floats | float = 1.0


def in_doubles(values: Column) -> Floats:
    """Return the values as float64. A value that is not zero does not underflow to zero."""
    if values.dtype != object:
        return values
    return np.array([float(value) or (_LEAST if value else 0.0) for value in values])


@dataclass(frozen=True)
class Distances:
    """Distances of one quantity from the truth at some samples, by part, not divided by a scale.

    ``widths`` are the error bounds of the truth, in the unit of the distances. The scale of a part is its
    entry in ``sizes``, or 1 if that is zero. With ``so_far`` each distance is divided by its own size.
    """

    quantity: str
    unit: str
    distances: Mapping[str, Column]
    widths: Mapping[str, Column]
    sizes: Mapping[str, Any]
    so_far: Column | None = None


def state_errors(scene: Scene, truth: Motion, answer: Motion) -> list[Errors]:
    """Return the errors of all tracked quantities, at the ambient precision of mpmath."""
    states = States()
    for distances in state_distances(scene, truth, answer):
        states.add(distances)
    return states.errors()


def state_distances(
    scene: Scene, truth: Motion, answer: Motion, arc: Arc | None = None
) -> list[Distances]:
    """Return the distances of all tracked quantities; ``arc`` is the path before these samples."""
    distances = []
    for quantity in scene.tracked:
        if quantity.measure is Measure.ANGLE:
            distances.append(_angles(quantity, truth, answer))
            continue
        if quantity.measure is Measure.SO_FAR:
            distances.append(_so_far(quantity, truth, answer))
            continue
        is_path = quantity.measure is Measure.PATH
        length = (arc or Arc()).through(scene, truth) if is_path else None
        distances.append(_vectors(quantity, truth, answer, length))
    return distances


def _vectors(quantity: Quantity, truth: Motion, answer: Motion, size: Any) -> Distances:
    """Return the distances of vectors; without a ``size`` the size of each part is its largest norm."""
    parts = quantity.groups
    sizes = {part: norms(truth[part]) for part in parts}
    return Distances(
        quantity.name,
        quantity.unit,
        {part: norms(answer[part] - truth[part]) for part in parts},
        {part: truth.radius_of(part) * np.array([*map(or_one, sizes[part])]) for part in parts},
        {part: largest(sizes[part]) if size is None else size for part in parts},
    )


def _angles(quantity: Quantity, truth: Motion, answer: Motion) -> Distances:
    """Return the angles of R_exact^T R, from the Frobenius norm |R - R_exact| = 2 sqrt 2 sin(angle/2)."""
    name = quantity.name
    chords = norms(answer[name] - truth[name]) / (2 * mp.sqrt(2))
    angles = [2 * mp.asin(chord) if chord <= 1 else mp.pi + 0 * chord for chord in chords]
    # |R|_F is sqrt 3, so an angle in radians is at most twice the relative radius.
    widths = 2 * truth.radius_of(name)
    distances = np.array(angles, dtype=object)
    return Distances(name, quantity.unit, {name: distances}, {name: widths}, {name: mpf(1)})


def _so_far(quantity: Quantity, truth: Motion, answer: Motion) -> Distances:
    """Return the distances over the largest norm of the truth up to each row, absolute while it is zero."""
    (part,) = quantity.groups
    sizes = np.array([*map(or_one, truth.peaks[part])])
    distances = norms(answer[part] - truth[part]) / sizes
    widths = truth.radius_of(part)
    return Distances(
        quantity.name, quantity.unit, {part: distances}, {part: widths}, {part: mpf(1)}, sizes
    )


@dataclass
class Arc:
    """The length of the centre's path, by the trapezium rule from the speed |U| at the samples.

    ``length`` is the length so far, up to ``end``, a pair of time and speed.
    """

    length: Any = 0
    end: tuple[Any, Any] | None = None

    def through(self, scene: Scene, truth: Motion) -> Any:
        """Add further samples, at the instants of the scene, and return the length so far."""
        forms = velocity_forms(scene.body)["linear_velocity"]
        terms = [(to_mpfr(truth[name]), to_mpfr(exact_matrix(m))) for name, m in forms.items()]
        with precision():
            U = sum(rows @ matrix.T for rows, matrix in terms)
            speeds = to_mpf(sqrt(np.sum(U * U, axis=1)))
        for elapsed, speed in zip(scene.clock.elapsed, speeds, strict=True):
            time = mp.convert(elapsed)
            # The start is not always sampled; the speed of the first sample is close enough.
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
    """Return the scale, or 1 if it is zero or NaN."""
    return scale if scale > 0 else mpf(1)


# Rows in blocks.


def joined(first: Motion, second: Motion) -> Motion:
    """Return the rows of two motions, one after the other."""
    both = {n: np.concatenate([rows, second[n]]) for n, rows in first.quantities.items()}
    return Motion(both, np.concatenate([first.radius, second.radius]))


class Series:
    """Blocks of numbers, divided by one scale that is known after the last block, as float64."""

    def __init__(self) -> None:
        self._blocks: list[Floats] = []
        self._first: Any = None
        self._scale: Any = None

    def add(self, values: Column, scale: Any) -> None:
        """Add further numbers, and the scale of all numbers so far."""
        self._scale = scale
        if not self._blocks:
            self._first = scale
        self._blocks.append(in_doubles(values / self._first))

    def joined(self) -> tuple[Floats, Any]:
        """Return all numbers over the last scale, and that scale."""
        values = np.concatenate(self._blocks)
        if self._first != self._scale:
            values *= float(self._first / self._scale)
        # The joined array replaces the blocks, to save memory.
        self._blocks, self._first = [values], self._scale
        return values, self._scale


class States:
    """Errors of all state quantities of an answer that is read in blocks."""

    def __init__(self) -> None:
        self._about: dict[str, Distances] = {}
        # By quantity and part.
        self._sizes: dict[tuple[str, str], Any] = {}
        self._errors: defaultdict[tuple[str, str], Series] = defaultdict(Series)
        self._widths: defaultdict[tuple[str, str], Series] = defaultdict(Series)
        # Of the quantities whose every error has a size of its own.
        self._so_far: defaultdict[str, list[Column]] = defaultdict(list)

    def add(self, rows: Distances) -> dict[str, Any]:
        """Add the next rows of one quantity, and return its scales so far."""
        scales = {}
        self._about[rows.quantity] = rows
        if rows.so_far is not None:
            self._so_far[rows.quantity].append(in_doubles(rows.so_far))
        for part, distances in rows.distances.items():
            key = rows.quantity, part
            before, size = self._sizes.get(key), rows.sizes[part]
            # Keep the larger size; NaN stays NaN.
            if before is None or size > before or size != size:
                self._sizes[key] = size
            scales[part] = scale = or_one(self._sizes[key])
            self._errors[key].add(distances, scale)
            self._widths[key].add(rows.widths[part], scale)
        return scales

    def errors(self) -> list[Errors]:
        """Return the errors of all rows, in the order of the first block's quantities."""
        return [self._joined(about) for about in self._about.values()]

    def _joined(self, about: Distances) -> Errors:
        name = about.quantity
        values = {part: self._errors[name, part].joined() for part in about.distances}
        scales = {part: scale for part, (_, scale) in values.items()}
        larger = np.maximum.reduce([rows for rows, _ in values.values()])
        width = np.maximum.reduce([self._widths[name, part].joined()[0] for part in values])
        sizes = np.concatenate(self._so_far[name]) if name in self._so_far else 1.0
        return Errors(name, about.unit, larger, width, scales, is_state=True, sizes=sizes)


class VelocityErrors:
    """Errors of U or Omega, which are no states, of an answer that is read in blocks.

    ``group`` is the name of their columns.
    """

    def __init__(self, group: str) -> None:
        self.group = group
        self._states, self._sizes = States(), Series()

    def add(self, body: Body, truth: Motion, answer: Column) -> None:
        """Add the next rows of the exact motion and of the ``answer`` (n, 3)."""
        rows = velocity(self.group, body, truth.quantities)
        about, sizes = QUANTITIES[GROUPS[self.group].quantity], norms(rows)
        most = largest(sizes)
        distances = {self.group: norms(answer - rows)}
        widths = {self.group: truth.radius * or_one(most)}
        block = Distances(about.name, about.unit, distances, widths, {self.group: most})
        self._sizes.add(sizes, self._states.add(block)[self.group])

    def joined(self) -> tuple[Errors, Floats]:
        """Return the errors of all rows, and the size of the velocity there over its largest."""
        (errors,) = self._states.errors()
        return errors, self._sizes.joined()[0]
