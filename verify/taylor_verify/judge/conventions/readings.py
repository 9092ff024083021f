"""The ways in which a group of columns may be meant, each as a map onto the scene's conventions.

v_space = R v_body; q is R's quaternion, scalar first. Axes are renamed for all groups of a file alike
(judge.conventions.axes), and every reading is one under such a renaming. A reading works on NumPy
arrays of floats and of mpf alike.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from itertools import product
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.judge.conventions.axes import Frames
from taylor_verify.judge.errors.state import norms
from taylor_verify.records.quantities import GROUPS

Array = np.ndarray[Any, Any]
# The columns of one group, shaped (n, k), and the exact R at the same times, (n, 3, 3).
Read = Callable[[Array, Array], Array]


@dataclass(frozen=True)
class Reading:
    """One way to read a group; ``words`` say how it departs from the scene's conventions.

    ``cost`` counts the departures: of two readings that explain a file alike, the one with fewer is
    the explanation. ``read`` returns the group in the scene's conventions: vectors (n, 3),
    quaternions (n, 4) or matrices (n, 3, 3).
    """

    words: tuple[str, ...]
    cost: int
    read: Read

    @property
    def sentence(self) -> str:
        return "; ".join(self.words)


# Words, the rational part of the factor, and the power of pi in it.
_UNITS: Final = (
    ("", Fraction(1), 0),
    ("in degrees per unit of time", Fraction(1, 180), 1),
    ("in turns per unit of time", Fraction(2), 1),
    ("in turns per minute, the unit of time being the second", Fraction(1, 30), 1),
)


@lru_cache
def readings(group: str, frames: Frames = Frames()) -> tuple[Reading, ...]:  # noqa: B008 (frozen)
    """All readings of a group of columns under a renaming of axes, the scene's own first."""
    if group == "quaternion":
        every = _quaternions(frames)
    elif group == "attitude":
        every = _matrices(frames)
    else:
        every = _vectors(group, frames)
    return tuple(sorted(every, key=lambda reading: reading.cost))


def _vectors(group: str, frames: Frames) -> Iterator[Reading]:
    about = GROUPS[group]
    together, is_placed = " ".join(about.columns), about.moves_with == "space"
    units = _UNITS if about.dimension == "rate" else _UNITS[:1]
    for unit, rational, power in units:
        for space in (False,) if is_placed else (False, True):
            words = (
                *([f"{together} are {unit}"] if unit else []),
                *([f"{together} are in space axes"] if space else []),
            )
            axes = frames.space if space or is_placed else frames.body
            read = _vector_map(rational, power, space, axes.vectors)
            yield Reading(words, bool(unit) + space, read)


def _vector_map(
    rational: Fraction, power: int, space: bool, renamed: Callable[[Array], Array]
) -> Read:
    def read(rows: Array, R: Array) -> Array:
        vectors = renamed(rows)
        if rational != 1:
            vectors = vectors * _number(rational, power, rows)
        # Components in space axes, taken to body axes by the exact attitude: R^T is a rotation, so
        # that the error keeps its size.
        return np.matmul(R.transpose(0, 2, 1), vectors[:, :, None])[:, :, 0] if space else vectors

    return read


def _number(rational: Fraction, power: int, like: Array) -> Any:
    if like.dtype == object:
        return mp.convert(rational) * mp.pi**power
    return float(rational) * np.pi**power


def _quaternions(frames: Frames) -> Iterator[Reading]:
    columns = "q0 q1 q2 q3"
    for last, conjugate in product((False, True), repeat=2):
        words = (
            *([f"{columns} have the scalar last: the quaternion is scalar last"] if last else []),
            *([f"{columns} are the conjugate: they take space to body axes"] if conjugate else []),
        )
        yield Reading(words, last + conjugate, _quaternion_map(last, conjugate, frames))


def _quaternion_map(last: bool, conjugate: bool, frames: Frames) -> Read:
    def read(rows: Array, R: Array) -> Array:
        del R
        ordered = np.roll(rows, 1, axis=1) if last else rows
        signs = np.array([1, -1, -1, -1] if conjugate else [1, 1, 1, 1])
        return frames.quaternions(ordered * signs)

    return read


def _matrices(frames: Frames) -> Iterator[Reading]:
    for transposed in (False, True):
        words = ("r11 ... r33 are transposed: they take space to body axes",) * transposed
        yield Reading(words, int(transposed), _matrix_map(transposed, frames))


def _matrix_map(transposed: bool, frames: Frames) -> Read:
    def read(rows: Array, R: Array) -> Array:
        del R
        matrices = rows.reshape(-1, 3, 3)
        return frames.attitudes(matrices.transpose(0, 2, 1) if transposed else matrices)

    return read


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
