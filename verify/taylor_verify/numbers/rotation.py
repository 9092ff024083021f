"""Scalar products, quaternions and their rotations, in whatever numbers they are given.

A quaternion has its scalar first, and turns body axes to space axes: v -> q v q*/|q|^2.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from flint import arb

from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Matrix, Number, Vector


def scalar_product(p: Sequence[Number], q: Sequence[Number]) -> Number:
    """Return p . q of two vectors of three."""
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


def product(p: Sequence[Any], q: Sequence[Any]) -> list[Any]:
    """Return the product p q of two quaternions: the rotation q, then p."""
    a, b, c, d = p
    w, x, y, z = q
    return [
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    ]


def conjugate(q: Sequence[Number]) -> list[Number]:
    return [q[0], -q[1], -q[2], -q[3]]


def rotation_rows(q: Sequence[Number]) -> list[list[Number]]:
    """Return the matrix of v -> q v q*: a rotation times |q|^2."""
    w, x, y, z = q
    return [
        [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
    ]


def rotation_matrix(quaternion: Vector) -> Matrix:
    """Return R of a quaternion of any length: rational, being of degree 2 in q/|q|."""
    scale = 1 / tensors.dot(quaternion, quaternion)
    return tuple(tuple(scale * entry for entry in row) for row in rotation_rows(quaternion))


def turn(axis: Sequence[arb], half_angle: arb) -> list[arb]:
    """Return the rotation about a unit axis; it is continuous in the angle, and so is its sign."""
    sin, cos = half_angle.sin_cos()
    return [cos, *(sin * component for component in axis)]
