"""The place of the scalar in four numbers whose names do not say it, settled by the scene's start.

Read with the scalar first or last, the row at the start has the scene's attitude or another one. Where both
readings have it, the turn to the next row tells which of them moves as the angular velocity says.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any, Final, NamedTuple

import numpy as np

from taylor_verify.models.frame import rotation
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.columns.forms import FORMS
from taylor_verify.solvers.files.compact_rows import Floats, Rows

# A reading whose turn is so much nearer to that of the angular velocity than the other one is taken.
_NEARER: Final = 4


class Start(NamedTuple):
    """The row at the scene's start, the attitude that the scene has there, and the turn to the next row."""

    row: int
    attitude: Floats
    turn: Floats | None

    @classmethod
    def of(
        cls, scene: Scene | None, times: Sequence[Fraction], groups: Mapping[str, Rows]
    ) -> Start | None:
        """Return the start in a file with rows at these times; None where it has no such row."""
        if scene is None or scene.clock.start not in times:
            return None
        row = times.index(scene.clock.start)
        moving = scene.initial.parts()
        omega = groups["omega"][row] if "omega" in groups else moving.get("omega")
        turn = None
        if omega is not None and row + 1 < len(times):
            turn = _turn([w * (times[row + 1] - times[row]) for w in omega])
        return cls(row, matrix(scene.initial.attitude), turn)

    def fitting(self, readings: Sequence[Rows], near: float) -> list[int]:
        """Return the numbers of the readings that fit, best one where the turn tells them apart."""
        places = [self.row, self.row + 1] if self.turn is not None else [self.row]
        frames = [rotations(reading.doubles(places)) for reading in readings]
        fit = [k for k, each in enumerate(frames) if angles(each[0], self.attitude) <= near]
        if len(fit) < len(readings) or self.turn is None:
            return fit
        errors = [angles(first.T @ second, self.turn) for first, second in frames]
        best = int(np.argmin(errors))
        is_clear = all(_NEARER * errors[best] <= errors[k] for k in fit if k != best)
        return [best] if is_clear else fit


def _turn(vector: Sequence[Any]) -> Floats | None:
    """Return the rotation by a vector; None for one that is no number."""
    if not all(isinstance(part, Fraction) for part in vector):
        return None
    return matrix(FORMS["rotvec"].quaternion(vector))


def rotations(quaternions: Floats) -> Floats:
    """Return the rotations (n, 3, 3) of quaternions (n, 4) of any length, scalar first; NaN for zero."""
    with np.errstate(divide="ignore", invalid="ignore"):
        squares = np.sum(quaternions**2, axis=1)
        return np.moveaxis(np.array(rotation(list(quaternions.T))) / squares, -1, 0)


def matrix(q: Sequence[Any]) -> Floats:
    """Return the rotation of one quaternion, as `rotations` does."""
    one: Floats = rotations(np.array([[float(part) for part in q]]))[0]
    return one


def angles(left: Floats, right: Floats) -> Floats:
    """Return the angle between each two rotations that are near to each other, in radians."""
    sizes: Floats = np.linalg.norm(left - right, axis=(-2, -1)) / np.sqrt(2)
    return sizes
