"""Turns between space, body and principal axes in plain floats; a quaternion has its scalar first."""

from __future__ import annotations

import math
from collections.abc import Sequence

from question import unit

Vector = Sequence[float]
Quaternion = Sequence[float]
Matrix = Sequence[Vector]

IDENTITY = (1.0, 0.0, 0.0, 0.0)
# Each squares what is left of the products, once they are small: a few of them reach the roundoff.
_TURNS = 15


def conjugate(q: Quaternion) -> Quaternion:
    return (q[0], -q[1], -q[2], -q[3])


def product(p: Quaternion, q: Quaternion) -> Quaternion:
    return (
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] + p[2] * q[0] + p[3] * q[1] - p[1] * q[3],
        p[0] * q[3] + p[3] * q[0] + p[1] * q[2] - p[2] * q[1],
    )


def to_space(attitude: Quaternion, vector: Vector) -> Vector:
    """Turn a vector from body to space axes, exactly, and round it once: the engine's state is judged.

    v + 2 r x (r x v + q0 v)/|q|^2, r = (q1, q2, q3), in integers; the quaternion need not be unit. NaN
    where a number is not finite, or the quaternion zero.
    """
    numbers = [*map(float, attitude), *map(float, vector)]
    if not all(map(math.isfinite, numbers)) or not any(numbers[:4]):
        return [math.nan] * 3
    (w, x, y, z), _ = _integers(numbers[:4])
    (a, b, c), n = _integers(numbers[4:])
    d, e, f = y * c - z * b + w * a, z * a - x * c + w * b, x * b - y * a + w * c
    size = w * w + x * x + y * y + z * z
    turned = (
        a * size + 2 * (y * f - z * e),
        b * size + 2 * (z * d - x * f),
        c * size + 2 * (x * e - y * d),
    )
    # Python rounds the quotient of two integers once.
    return [entry / (size * n) for entry in turned]


def _integers(numbers: Vector) -> tuple[list[int], int]:
    """Return the numbers as multiples of one fraction 1/n, and n."""
    quotients = [number.as_integer_ratio() for number in numbers]
    n = max(below for _, below in quotients)
    return [above * (n // below) for above, below in quotients], n


def to_body(attitude: Quaternion, vector: Vector) -> Vector:
    """Turn a vector from space to body axes."""
    return to_space(conjugate(attitude), vector)


def principal(inertia: Matrix) -> tuple[Vector, Quaternion]:
    """Return the principal moments, and the quaternion from the principal axes to the given ones.

    Jacobi's method, as not every engine brings a library that has eigenvectors: each turn about an axis
    takes away one product of inertia. The axes keep their order as far as they can.
    """
    tensor, turn = inertia, IDENTITY
    for _ in range(_TURNS):
        k = max(range(3), key=lambda k: abs(tensor[(k + 1) % 3][(k + 2) % 3]))
        i, j = (k + 1) % 3, (k + 2) % 3
        if not tensor[i][j]:
            break
        twice_product, difference = 2 * tensor[i][j], tensor[i][i] - tensor[j][j]
        angle = math.atan(twice_product / difference) / 2 if difference else math.pi / 4
        about = [math.cos(angle / 2), 0.0, 0.0, 0.0]
        about[1 + k] = math.sin(angle / 2)
        turn = tuple(unit(product(turn, about)))
        columns = [to_body(turn, column) for column in zip(*inertia, strict=True)]
        tensor = [to_body(turn, row) for row in zip(*columns, strict=True)]
    return [tensor[i][i] for i in range(3)], turn
