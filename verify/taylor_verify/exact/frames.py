"""Rotation matrices in mpmath, row by row: for that route of the closed forms alone."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from flint import ctx
from mpmath import mp, mpf

from taylor_verify.exact.balls import midpoint
from taylor_verify.numbers.irrational import ball
from taylor_verify.numbers.rotation import rotation_matrix
from taylor_verify.scenes.motion import Quaternion

_SPARE_BITS: Final = 16

Frame = list[list[mpf]]  # rows of a 3x3 matrix


def start_frame(quaternion: Quaternion) -> Frame:
    """The rotation of a quaternion of any length but zero, exact before it is rounded."""
    with ctx.workprec(mp.prec + _SPARE_BITS):
        return [[midpoint(ball(entry)) for entry in row] for row in rotation_matrix(quaternion)]


def turn(axis: Sequence[mpf], angle: mpf) -> Frame:
    """The rotation about an axis of any length (Rodrigues); the identity for a zero axis."""
    length = mp.norm(axis)
    if length == 0:
        return [[mpf(int(i == j)) for j in range(3)] for i in range(3)]
    x, y, z = (component / length for component in axis)
    cos, sin = mp.cos_sin(angle)
    rest = 2 * mp.sin(angle / 2) ** 2  # 1 - cos without cancellation
    return [
        [cos + rest * x * x, rest * x * y - sin * z, rest * x * z + sin * y],
        [rest * x * y + sin * z, cos + rest * y * y, rest * y * z - sin * x],
        [rest * x * z - sin * y, rest * y * z + sin * x, cos + rest * z * z],
    ]


def product(p: Frame, q: Frame) -> Frame:
    columns = transposed(q)
    return [applied(columns, row) for row in p]


def applied(frame: Frame, vector: Sequence[mpf]) -> list[mpf]:
    """The matrix times the vector."""
    return [mp.fdot(row, vector) for row in frame]


def transposed(frame: Frame) -> Frame:
    return [list(column) for column in zip(*frame, strict=True)]
