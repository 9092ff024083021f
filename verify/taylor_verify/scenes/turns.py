"""Rotations in rationals: quaternions of any length, scalar first, and their exact matrices.

The sine and cosine of a rational angle are irrational. But the matrix of a quaternion of rational
components is rational, and orthogonal exactly, whatever the length of the quaternion. So the quaternion
of an angle is formed with some bits to spare, its largest component made 1, and the others rounded, to 20
decimals where a file is imported; everything after that is exact, and a tensor that is turned by it keeps
its principal moments.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from functools import reduce
from math import pi, remainder
from typing import Any, Final, NamedTuple

from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import exact_value, float_text
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.scenes.motion import Quaternion

DECIMALS: Final = 20
_BITS: Final = 500
# An angle written with four digits, 1.571, is as near as this to a quarter turn.
_NEAR: Final = 3e-4
AXES: Final = tensors.diagonal((Fraction(1),) * 3)


class Turn(NamedTuple):
    """A turn by an angle about an axis of any length but zero."""

    axis: Vector
    angle: Fraction
    degrees: bool = False


def combined(turns: Iterable[Turn], parts: int = 10**DECIMALS) -> Quaternion:
    """Return the product of the turns, the last one done first: each is about an axis that moves along.

    Each component is a whole number over ``parts``, at most 2^400, and the largest is 1. Turns by zero, and
    whole quarter turns in degrees about body axes, are exact.
    """
    from mpmath import mp

    with mp.workprec(_BITS):
        q = reduce(times, map(_half_angle, turns))
        largest = max(q, key=abs)
        w, x, y, z = (Fraction(round(exact_value(part / largest) * parts), parts) for part in q)
    return (w, x, y, z)


def roll_pitch_yaw(angles: Vector, degrees: bool = False) -> Quaternion:
    """Return the turns about the fixed axes x, y and z, in this order."""
    pairs = zip(reversed(AXES), reversed(angles), strict=True)
    return combined(Turn(axis, angle, degrees) for axis, angle in pairs)


def matrix(q: Quaternion) -> Matrix:
    """Return R of v = R v', exactly, for a quaternion of any length but zero."""
    s, *vector = q
    v = tuple(vector)
    square = s * s + tensors.dot(v, v)
    columns = []
    for e in AXES:
        once = tensors.cross(v, e)
        both = tensors.plus(tensors.scaled(s, once), tensors.cross(v, once))
        columns.append(tensors.plus(e, tensors.scaled(2 / square, both)))
    return tensors.transpose(tuple(columns))


def turned(tensor: Matrix, q: Quaternion) -> Matrix:
    """Return R I R^T, the components of a tensor in the axes that the turn leads to."""
    if not any(q[1:]):
        return tensor
    rotation = matrix(q)
    return tensors.product(tensors.product(rotation, tensor), tensors.transpose(rotation))


def remarks_on(name: str, angles: Vector, degrees: bool = False) -> tuple[str, ...]:
    """Return what a reader of the scene must know of these angles; nothing where all are zero."""
    if not any(angles):
        return ()
    unit = "degrees" if degrees else "radians"
    text = ", ".join(map(float_text, angles))
    remarks = [
        f"The tensor was turned by {name} = ({text}) {unit}: their quaternion is formed with {_BITS} bits, "
        f"its largest component made 1, and rounded to {DECIMALS} decimals (quarter turns in degrees are "
        "exact). The turn by it is exact, so that the principal moments are those of the file."
    ]
    if not degrees:
        remarks += [
            f"The angle {float_text(angle)} is taken as written, and is near a quarter turn but none."
            for angle in angles
            if angle and abs(remainder(float(angle), pi / 2)) < _NEAR
        ]
    return tuple(remarks)


def _half_angle(turn: Turn) -> Sequence[Any]:
    """Return the quaternion of one turn at the ambient precision of mpmath."""
    from mpmath import mp

    half = mp.convert(turn.angle) / 2
    if turn.degrees:
        half *= mp.degree
    share = mp.sin(half) / mp.sqrt(mp.convert(tensors.dot(turn.axis, turn.axis)))
    x, y, z = (share * mp.convert(entry) for entry in turn.axis)
    return (mp.cos(half), x, y, z)


def times(a: Sequence[Any], b: Sequence[Any]) -> Sequence[Any]:
    """Return the product of two quaternions, scalar first, in any arithmetic."""
    (s, x, y, z), (t, u, v, w) = a, b
    return (
        s * t - x * u - y * v - z * w,
        s * u + t * x + y * w - z * v,
        s * v + t * y + z * u - x * w,
        s * w + t * z + x * v - y * u,
    )
