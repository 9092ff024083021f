"""A triaxial body under a moment whose omega keeps its axis: two routes to its turn about that.

With w0 and M along one principal axis w = w0 + (M/J) t; where I w0 x w0 = -M it is w0 for ever. With a
vector n along the axis and w = w0 + a t, the body turns by the angle

    theta = (n.w0 t + n.a t^2/2)/|n|,    R = R0 Rot(n/|n|, theta).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any, Final, final

import numpy as np
from flint import arb
from mpmath import mp, mpf

from taylor_verify.exact.balls import Enclosed, Enclosure, ball, balls
from taylor_verify.exact.euler import quaternion
from taylor_verify.exact.euler.moments.washboard.board import Washboard, WashboardRegime
from taylor_verify.exact.euler.orbit import converted
from taylor_verify.exact.rotation import rotation_matrix
from taylor_verify.exact.solution import Quantities, Settled
from taylor_verify.scenes import motion, tensors
from taylor_verify.scenes.precision import floor_log2
from taylor_verify.scenes.tensors import ZERO_VECTOR, Vector

_GUARD_DIGITS: Final = 10


class _Axis:
    """n and a, rational, and what follows from them without a root."""

    def __init__(self, board: Washboard) -> None:
        self._omega = board.omega
        self.vector = board.omega if board.is_steady else board.moment
        self._gain = (
            ZERO_VECTOR if board.is_steady else tensors.scaled(1 / board.axial_moment, board.moment)
        )
        self.squared = tensors.dot(self.vector, self.vector)
        kind = WashboardRegime.STEADY if board.is_steady else WashboardRegime.STRAIGHT
        self.regime = kind.value

    def omega(self, t: Fraction) -> Vector:
        return tensors.plus(self._omega, tensors.scaled(t, self._gain))

    def turned(self, t: Fraction) -> Fraction:
        """|n| theta."""
        return t * tensors.dot(self.vector, self.omega(t / 2))


@final
class FixedAxisBalls(Enclosed):
    """omega(t) in body axes and, from a start, R(t) as a product of quaternions."""

    def __init__(self, board: Washboard, attitude: motion.Quaternion | None = None) -> None:
        self._axis, self._attitude = _Axis(board), attitude
        self.regime = self._axis.regime

    def enclose(self, elapsed: Sequence[Fraction], bits: int) -> Enclosure:
        """``omega``, rows of 3, and ``attitude``, rows of 3x3, where it is tracked."""
        found: dict[str, list[Any]] = {"omega": [balls(self._axis.omega(t)) for t in elapsed]}
        if self._attitude is None:
            return found
        start, length = quaternion.unit(self._attitude), ball(self._axis.squared).sqrt()
        axis = [entry / length for entry in balls(self._axis.vector)]
        found["attitude"] = [self._frame(start, axis, length, t) for t in elapsed]
        return found

    def _frame(
        self, start: quaternion.Quaternion, axis: list[arb], length: arb, t: Fraction
    ) -> quaternion.Rows:
        turn = quaternion.turn(axis, ball(self._axis.turned(t)) / (2 * length))
        return quaternion.matrix(quaternion.product(start, turn))


@final
class FixedAxis(Settled):
    """The same in mpmath, R by Rodrigues' formula."""

    route = "mpmath"

    def __init__(self, board: Washboard, attitude: motion.Quaternion | None = None) -> None:
        self._axis, self._attitude = _Axis(board), attitude
        self.regime = self._axis.regime

    def evaluate(self, elapsed: Sequence[Fraction], digits: int) -> Quantities:
        """``omega`` (n, 3) and ``attitude`` (n, 3, 3), where it is tracked."""
        angles = [self._axis.turned(t) for t in elapsed]
        largest = max((angle**2 / self._axis.squared for angle in angles), default=Fraction(0))
        lost = math.ceil((floor_log2(1 + largest) + 1) * math.log10(2) / 2)
        with mp.workdps(digits + _GUARD_DIGITS + lost):
            rows = [converted(self._axis.omega(t)) for t in elapsed]
            found: dict[str, np.ndarray[Any, Any]] = {}
            found["omega"] = np.array(rows, dtype=object).reshape(-1, 3)
            if self._attitude is not None:
                start = _array(rotation_matrix(self._attitude))
                frames = [start @ self._turn(angle) for angle in angles]
                found["attitude"] = np.array(frames, dtype=object).reshape(-1, 3, 3)
            return found

    def _turn(self, angle: Fraction) -> Any:
        """1 + sin theta [n]x + (1 - cos theta) [n]x^2, n of unit length."""
        length = mp.sqrt(mp.convert(self._axis.squared))
        x, y, z = (entry / length for entry in converted(self._axis.vector))
        theta, zero = mp.convert(angle) / length, mpf(0)
        cross = np.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]], dtype=object)
        one = _array(tensors.diagonal((Fraction(1),) * 3))
        return one + mp.sin(theta) * cross + 2 * mp.sin(theta / 2) ** 2 * (cross @ cross)


def _array(rows: tensors.Matrix) -> Any:
    return np.array([[mp.convert(entry) for entry in row] for row in rows], dtype=object)
