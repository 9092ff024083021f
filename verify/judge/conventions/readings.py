"""The ways in which a group of columns may be meant, each as a map onto the scene's conventions.

v_space = R v_body; q is R's quaternion, scalar first. A signed permutation P takes the file's axes to
the scene's, v_scene = P v_file, so that R_scene = P R_file P^T where both frames are renamed. A
reading works on NumPy arrays of floats and of mpf alike.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from itertools import permutations, product
from typing import Any, Final

import numpy as np
from mpmath import mp

from verify.judge.errors import norms

Array = np.ndarray[Any, Any]
# The columns of one group, shaped (n, k), and the exact R at the same times, (n, 3, 3).
Read = Callable[[Array, Array], Array]


@dataclass(frozen=True)
class Reading:
    """One way to read a group; ``words`` say how it departs from the scene's conventions.

    ``cost`` counts the departures: of two readings that explain a file alike, the one with fewer is
    the explanation. ``read`` returns vectors (n, 3), or matrices (n, 3, 3) for an attitude. ``axes``
    are those of a vector.
    """

    words: tuple[str, ...]
    cost: int
    read: Read
    axes: Axes | None = None

    def is_plain(self, columns: Array) -> bool:
        """Whether it leaves columns that are zero in their order and with their sign.

        What is done to them changes nothing, so that one way stands for all.
        """
        if self.axes is None:
            return True
        zero = [i for i in range(3) if not np.any(columns[:, i])]
        kept = [i for i in self.axes.order if i in zero]
        signs = zip(self.axes.order, self.axes.signs, strict=True)
        return kept == sorted(kept) and not any(i in zero and sign < 0 for i, sign in signs)

    @property
    def sentence(self) -> str:
        return "; ".join(self.words)


@dataclass(frozen=True)
class Axes:
    """A signed permutation: component i of the scene is ``signs[i]`` times the file's ``order[i]``."""

    order: tuple[int, ...]
    signs: tuple[int, ...]

    def names(self, columns: Sequence[str]) -> str:
        """Which column, with which sign, each axis that is not in its place is."""
        told = [
            f"axis {i + 1} is {'-' if self.signs[i] < 0 else ''}{columns[self.order[i]]}"
            for i in self.moved
        ]
        return ", ".join(told)

    @property
    def moved(self) -> list[int]:
        return [i for i in range(3) if self.order[i] != i or self.signs[i] < 0]

    @property
    def is_proper(self) -> bool:
        """Whether it is a rotation: a reflection is no renaming of a frame."""
        inversions = sum(self.order[i] > self.order[k] for i in range(3) for k in range(i + 1, 3))
        return bool((-1) ** inversions * np.prod(self.signs) > 0)

    def vectors(self, rows: Array) -> Array:
        """P v for every row v."""
        found: Array = rows[:, self.order] * np.array(self.signs)
        return found

    def left(self, matrices: Array) -> Array:
        """P R for every matrix R."""
        found: Array = matrices[:, self.order, :] * np.array(self.signs)[:, None]
        return found

    def right(self, matrices: Array) -> Array:
        """R P^T for every matrix R."""
        found: Array = matrices[:, :, self.order] * np.array(self.signs)
        return found


AXES: Final = tuple(
    Axes(order, signs) for order in permutations(range(3)) for signs in product((1, -1), repeat=3)
)

# There are many ways to name axes, so that each is worth less than another convention.
_AXES_COST: Final = 2
# Words, the rational part of the factor, and the power of pi in it.
_UNITS: Final = (
    ("", Fraction(1), 0),
    ("in degrees per unit of time", Fraction(1, 180), 1),
    ("in turns per unit of time", Fraction(2), 1),
    ("in turns per minute, the unit of time being the second", Fraction(1, 30), 1),
)

_LETTERS: Final = {"omega": "w", "linear_impulse": "x", "angular_impulse": "y", "centre": "c"}


@lru_cache
def readings(group: str) -> tuple[Reading, ...]:
    """All readings of a group of columns, the scene's own first."""
    if group == "quaternion":
        found = _quaternions()
    elif group == "attitude":
        found = _matrices()
    else:
        units = _UNITS if group == "omega" else _UNITS[:1]
        found = _vectors(_LETTERS[group], units, in_space=group != "centre")
    return tuple(sorted(found, key=lambda reading: reading.cost))


def _vectors(
    letter: str, units: Sequence[tuple[str, Fraction, int]], in_space: bool
) -> Iterator[Reading]:
    columns = [f"{letter}{i}" for i in (1, 2, 3)]
    together = " ".join(columns)
    for unit, rational, power in units:
        for space in (False, True) if in_space else (False,):
            for axes in AXES:
                words = (
                    *([f"{together} are {unit}"] if unit else []),
                    *([f"{together} are in space axes"] if space else []),
                    *([f"{together} have other axes: {axes.names(columns)}"] if axes.moved else []),
                )
                cost = bool(unit) + space + _AXES_COST * bool(axes.moved)
                yield Reading(words, cost, _vector_map(rational, power, space, axes), axes)


def _vector_map(rational: Fraction, power: int, space: bool, axes: Axes) -> Read:
    def read(rows: Array, R: Array) -> Array:
        found = axes.vectors(rows)
        if rational != 1:
            found = found * _number(rational, power, rows)
        # Components in space axes, taken to body axes by the exact attitude: R^T is a rotation, so
        # that the error keeps its size.
        return np.matmul(R.transpose(0, 2, 1), found[:, :, None])[:, :, 0] if space else found

    return read


def _number(rational: Fraction, power: int, like: Array) -> Any:
    if like.dtype == object:
        return mp.convert(rational) * mp.pi**power
    return float(rational) * np.pi**power


def _quaternions() -> Iterator[Reading]:
    columns = "q0 q1 q2 q3"
    for last, conjugate in product((False, True), repeat=2):
        words = (
            *([f"{columns} have the scalar last: the quaternion is scalar last"] if last else []),
            *([f"{columns} are the conjugate: they take space to body axes"] if conjugate else []),
        )
        for told, cost, renamed in _renamings():
            read = _quaternion_map(last, conjugate, renamed)
            yield Reading((*words, *told), last + conjugate + cost, read)


def _quaternion_map(last: bool, conjugate: bool, renamed: Callable[[Array], Array]) -> Read:
    def read(rows: Array, R: Array) -> Array:
        del R
        matrices = rotations(np.roll(rows, 1, axis=1) if last else rows)
        return renamed(matrices.transpose(0, 2, 1) if conjugate else matrices)

    return read


def _matrices() -> Iterator[Reading]:
    for transposed in (False, True):
        words = ["r11 ... r33 are transposed: they take space to body axes"] if transposed else []
        for told, cost, renamed in _renamings():
            read = _matrix_map(transposed, renamed)
            yield Reading((*words, *told), transposed + cost, read)


def _matrix_map(transposed: bool, renamed: Callable[[Array], Array]) -> Read:
    def read(rows: Array, R: Array) -> Array:
        del R
        matrices = rows.reshape(-1, 3, 3)
        return renamed(matrices.transpose(0, 2, 1) if transposed else matrices)

    return read


def _renamings() -> Iterator[tuple[tuple[str, ...], int, Callable[[Array], Array]]]:
    """Words, cost and map: no renaming, or that of both frames, of the body's, of space's."""
    yield (), 0, lambda matrices: matrices
    for axes in AXES:
        if not axes.moved or not axes.is_proper:
            continue
        told = axes.names(("the file's 1", "the file's 2", "the file's 3"))
        cost = _AXES_COST
        yield (f"both frames have other axes: {told}",), cost, _both(axes)
        yield (f"the body has other axes: {told}",), cost, axes.right
        yield (f"space has other axes: {told}",), cost, axes.left


def _both(axes: Axes) -> Callable[[Array], Array]:
    return lambda matrices: axes.left(axes.right(matrices))


def rotations(quaternions: Array) -> Array:
    """R(q/|q|) for every row; NaN where q is zero."""
    if quaternions.dtype == object:
        lengths = norms(quaternions)
        lengths = np.array([length if length else mp.nan for length in lengths], dtype=object)
    else:
        lengths = np.linalg.norm(quaternions, axis=1)
        lengths = np.where(lengths > 0, lengths, np.nan)
    s, a, b, c = (quaternions / lengths[:, None]).T
    rows = [
        [s * s + a * a - b * b - c * c, 2 * (a * b - s * c), 2 * (a * c + s * b)],
        [2 * (a * b + s * c), s * s - a * a + b * b - c * c, 2 * (b * c - s * a)],
        [2 * (a * c - s * b), 2 * (b * c + s * a), s * s - a * a - b * b + c * c],
    ]
    return np.array(rows).transpose(2, 0, 1)
