"""The rotation matrix of a quaternion of any length, in exact rationals."""

from __future__ import annotations

from taylor_verify.scenes import tensors
from taylor_verify.scenes.motion import Quaternion
from taylor_verify.scenes.tensors import Matrix


def rotation_matrix(quaternion: Quaternion) -> Matrix:
    """R, body to space, of a quaternion (scalar first): rational, being of degree 2 in q/|q|."""
    s, a, b, c = quaternion
    norm = s * s + a * a + b * b + c * c
    rows = (
        (s * s + a * a - b * b - c * c, 2 * (a * b - s * c), 2 * (a * c + s * b)),
        (2 * (a * b + s * c), s * s - a * a + b * b - c * c, 2 * (b * c - s * a)),
        (2 * (a * c - s * b), 2 * (b * c + s * a), s * s - a * a - b * b + c * c),
    )
    return tuple(tensors.scaled(1 / norm, row) for row in rows)
