"""Unit quaternions in balls: scalar first, body to space, q v q* the rotated vector."""

from __future__ import annotations

from collections.abc import Sequence

from flint import arb

from taylor_verify.exact.balls import ball
from taylor_verify.scenes import motion, tensors

Quaternion = list[arb]  # four components
Rows = list[list[arb]]  # a 3x3 matrix


def unit(quaternion: motion.Quaternion) -> Quaternion:
    """The quotient of a rational quaternion by its norm."""
    length = ball(tensors.dot(quaternion, quaternion)).sqrt()
    return [ball(component) / length for component in quaternion]


def turn(axis: Sequence[arb], half_angle: arb) -> Quaternion:
    """The rotation about a unit axis; continuous in the angle, so that its sign is too."""
    sin, cos = half_angle.sin_cos()
    return [cos, *(sin * component for component in axis)]


def conjugate(q: Quaternion) -> Quaternion:
    return [q[0], -q[1], -q[2], -q[3]]


def product(p: Quaternion, q: Quaternion) -> Quaternion:
    """First q, then p."""
    a, b, c, d = p
    w, x, y, z = q
    return [
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    ]


def matrix(q: Quaternion) -> Rows:
    """The rotation matrix of a unit quaternion."""
    w, x, y, z = q
    return [
        [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
    ]
