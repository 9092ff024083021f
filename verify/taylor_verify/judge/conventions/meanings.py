"""Possible meanings of a group of columns, each a map to the scene's conventions.

v_space = R v_body; q is R's quaternion, scalar first. A renaming of axes applies to all groups of a file
(judge.conventions.axis_orders), and every reading includes such a renaming. A reading works on NumPy
arrays of floats and of mpf.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache, partial
from itertools import product
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.judge.conventions.axis_orders import Axes, Frames
from taylor_verify.judge.errors.state import norms
from taylor_verify.numbers.rotation import rotation_rows
from taylor_verify.records.quantities import GROUPS

Array = np.ndarray[Any, Any]
# A function of the columns of one group (n, k), and of the exact R at the same times (n, 3, 3).
Read = Callable[[Array, Array], Array]


@dataclass(frozen=True)
class Reading:
    """A way to read a group; ``words`` name its departures from the scene's conventions.

    If two readings explain a file equally well, the reading with fewer departures is taken. ``read``
    returns the group in the scene's conventions: vectors (n, 3), quaternions (n, 4) or matrices (n, 3,
    3). ``is_factor`` if it multiplies by the factor of a unit, ``in_space`` if it turns space axes.
    """

    words: tuple[str, ...]
    read: Read
    is_factor: bool = False
    in_space: bool = False

    @property
    def cost(self) -> int:
        """Number of departures."""
        return len(self.words)

    @property
    def sentence(self) -> str:
        return "; ".join(self.words)


# Words, and the factor as a multiple of pi; the scene's own unit has none.
_UNITS: Final = (
    ("", None),
    ("in degrees per unit of time", Fraction(1, 180)),
    ("in turns per unit of time", Fraction(2)),
    ("in turns per minute, the unit of time being the second", Fraction(1, 30)),
)
# A rate may have these factors by mistakes of its own, as a half of a quaternion's rate.
_LIKELY_FACTORS: Final = frozenset(Fraction(2) ** k for k in (-2, -1, 1, 2))


@lru_cache
def readings(
    group: str,
    frames: Frames = Frames(),  # noqa: B008 (frozen)
    spacing: Fraction | None = None,
) -> tuple[Reading, ...]:
    """Return all readings of a group of columns under a renaming of axes, the scene's own reading first.

    ``spacing`` is that of equally spaced rows, in which a rate may be counted.
    """
    families = {"quaternion": _quaternions, "attitude": _matrices}
    family = families.get(group, partial(_vectors, group, spacing))
    return tuple(sorted(family(frames), key=lambda reading: reading.cost))


def _vectors(group: str, spacing: Fraction | None, frames: Frames) -> Iterator[Reading]:
    about = GROUPS[group]
    together, is_placed = " ".join(about.columns), about.moves_with == "space"
    units = _UNITS if about.dimension == "rate" else _UNITS[:1]
    for unit, pis in units:
        in_unit = [f"{together} are {unit}"] * bool(unit)
        for in_space in (False,) if is_placed else (False, True):
            words = [*in_unit, *[f"{together} are in space axes"] * in_space]
            axes = frames.space if in_space or is_placed else frames.body
            read = partial(_read_vectors, axes, pis, in_space=in_space)
            yield Reading(tuple(words), read, bool(unit), in_space)
        if group == "omega" and not frames.cost:
            rates = f"{together} are rates of Euler angles, roll' pitch' yaw', and no body rates"
            yield Reading((*in_unit, rates), partial(_read_rates, frames.body, pis), bool(unit))
    if about.dimension == "rate" and spacing:
        read = partial(_read_turns, frames.body, spacing)
        turns = f"{together} are turns between two rows, in radians for each {float(spacing):.6g}"
        yield Reading((turns,), read, is_factor=True)
        if spacing in _LIKELY_FACTORS:
            words_of_factor = f"{together} have the factor {float(spacing):g}"
            yield Reading((words_of_factor,), read, is_factor=True)


def space_axes() -> Reading:
    """Return the reading of vectors that are known to be along space axes, which is no departure."""
    return Reading((), partial(_read_vectors, Frames().space, None, in_space=True))


def _read_vectors(
    axes: Axes, pis: Fraction | None, rows: Array, R: Array, *, in_space: bool
) -> Array:
    vectors = axes.vectors(rows)
    if pis is not None:
        is_exact = rows.dtype == object
        vectors = vectors * (mp.convert(pis) * mp.pi if is_exact else float(pis) * np.pi)
    # Space axes are converted by the exact attitude. R^T is a rotation, so the error has the same size.
    return np.matmul(R.transpose(0, 2, 1), vectors[:, :, None])[:, :, 0] if in_space else vectors


def _read_turns(axes: Axes, spacing: Fraction, rows: Array, _: Array) -> Array:
    turns = axes.vectors(rows)
    return turns / (mp.convert(spacing) if rows.dtype == object else float(spacing))


def _read_rates(axes: Axes, pis: Fraction | None, rows: Array, R: Array) -> Array:
    """Return omega of roll' pitch' yaw', with the angles of R = R_z(yaw) R_y(pitch) R_x(roll)."""
    rates = _read_vectors(axes, pis, in_space=False, rows=rows, R=R)
    x, y, z = R[:, 2].T
    level = norms(R[:, 2, 1:]) if R.dtype == object else np.linalg.norm(R[:, 2, 1:], axis=1)
    roll, pitch, yaw = rates.T
    omega = (roll + yaw * x, pitch * z / level + yaw * y, yaw * z - pitch * y / level)
    return np.array(omega).T


def _quaternions(frames: Frames) -> Iterator[Reading]:
    columns = "q0 q1 q2 q3"
    for last, conjugate in product((False, True), repeat=2):
        words = [f"{columns} have the scalar last: the quaternion is scalar last"] * last
        words += [f"{columns} are the conjugate: they take space to body axes"] * conjugate
        yield Reading(tuple(words), partial(_read_quaternions, frames, last, conjugate))


def _read_quaternions(frames: Frames, last: bool, conjugate: bool, rows: Array, _: Array) -> Array:
    ordered = np.roll(rows, 1, axis=1) if last else rows
    return frames.quaternions(ordered * np.array([1, -1, -1, -1] if conjugate else [1, 1, 1, 1]))


def _matrices(frames: Frames) -> Iterator[Reading]:
    yield Reading((), partial(_read_matrices, frames, (0, 1, 2)))
    words = "r11 ... r33 are transposed: they take space to body axes"
    yield Reading((words,), partial(_read_matrices, frames, (0, 2, 1)))


def _read_matrices(frames: Frames, order: tuple[int, int, int], rows: Array, _: Array) -> Array:
    return frames.attitudes(rows.reshape(-1, 3, 3).transpose(order))


def rotations(quaternions: Array) -> Array:
    """Return R(q/|q|) for every row of doubles; NaN where q is zero."""
    lengths = np.linalg.norm(quaternions, axis=1)
    lengths = np.where(lengths > 0, lengths, np.nan)
    rows = rotation_rows(list((quaternions / lengths[:, None]).T))
    return np.array(rows).transpose(2, 0, 1)
