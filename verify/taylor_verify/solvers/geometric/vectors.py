"""Vectors, matrices and quaternions of Python floats.

A triple of floats costs a tenth of what a NumPy array of three does.
"""

from __future__ import annotations

from math import cos, sin, sqrt

from taylor_verify.numbers.rotation import scalar_product as dot
from taylor_verify.numbers.tensors import cross

Vector = tuple[float, float, float]
# Rows; of a system that is to be solved, columns.
Matrix = tuple[Vector, Vector, Vector]
# Scalar first, body to space.
Quaternion = tuple[float, float, float, float]

# Below this angle 1 - x^2/6 is sin(x)/x to the last bit: the next term is x^4/120 < 2^-53.
_SMALL = 1e-4


def apply(A: Matrix, b: Vector) -> Vector:
    return (dot(A[0], b), dot(A[1], b), dot(A[2], b))


def ahead(a: Vector, s: float, b: Vector) -> Vector:
    """a + s b."""
    return (a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2])


def scaled(s: float, a: Vector) -> Vector:
    return (s * a[0], s * a[1], s * a[2])


def solved(columns: Matrix, b: Vector) -> Vector:
    """Return the x with x1 c1 + x2 c2 + x3 c3 = b, by Cramer's rule; the columns are nearly orthonormal."""
    c1, c2, c3 = columns
    minor = cross(c2, c3)
    over = 1 / dot(c1, minor)
    return (dot(b, minor) * over, dot(c1, cross(b, c3)) * over, dot(c1, cross(c2, b)) * over)


def product(p: Quaternion, q: Quaternion) -> Quaternion:
    """Return the turn that is q first, and then p."""
    p0, p1, p2, p3 = p
    q0, q1, q2, q3 = q
    return (
        p0 * q0 - p1 * q1 - p2 * q2 - p3 * q3,
        p0 * q1 + p1 * q0 + p2 * q3 - p3 * q2,
        p0 * q2 + p2 * q0 + p3 * q1 - p1 * q3,
        p0 * q3 + p3 * q0 + p1 * q2 - p2 * q1,
    )


def conjugate(q: Quaternion) -> Quaternion:
    return (q[0], -q[1], -q[2], -q[3])


def sine_over(x: float) -> float:
    """sin(x)/x."""
    return sin(x) / x if abs(x) > _SMALL else 1 - x * x / 6


def exponential(theta: Vector) -> Quaternion:
    """Return the turn by the angle |theta| about theta."""
    half = sqrt(dot(theta, theta)) / 2
    s = sine_over(half) / 2
    return (cos(half), s * theta[0], s * theta[1], s * theta[2])


def cayley(c: Vector) -> Quaternion:
    """Return the turn (1 - [c]x)^-1 (1 + [c]x), by the angle 2 atan |c| about c."""
    over = 1 / sqrt(1 + dot(c, c))
    return (over, over * c[0], over * c[1], over * c[2])


def turned_back(theta: Vector, a: Vector) -> Vector:
    """exp(-[theta]x) a, as an increment: what is small is rounded as such."""
    angle = sqrt(dot(theta, theta))
    half_sine = sine_over(angle / 2)
    once = cross(a, theta)
    twice = cross(once, theta)
    return ahead(ahead(a, half_sine * half_sine / 2, twice), sine_over(angle), once)


def into(axes: Quaternion, a: Vector) -> Vector:
    """Return a vector of body axes in others, from which ``axes`` is the turn to the body's."""
    _, *rest = product(product(conjugate(axes), (0.0, *a)), axes)
    return (rest[0], rest[1], rest[2])
