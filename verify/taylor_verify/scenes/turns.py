"""Rotations by angles, as quaternions of any length, scalar first.

The sine and cosine of a rational angle are irrational. But a quaternion may have any length, and that of an
angle is (1, c v) with c the tangent of half the angle over the length of the axis v: one irrational number
a turn, and none for quarter turns. So products of turns are exact. Where a file is imported, the largest
component is made 1 and the others are rounded to 20 decimals; the matrix of rational components is rational
and orthogonal exactly, so that a tensor that is turned by it keeps its principal moments.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from math import pi, remainder
from typing import Any, Final, NamedTuple, final

from flint import arb

from taylor_verify.numbers import rotation, tensors
from taylor_verify.numbers.irrational import PI, Constant, Irrational, ball, generator
from taylor_verify.numbers.precision import float_text
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.scenes.loads.steps import exact_root
from taylor_verify.scenes.motion import Quaternion

DECIMALS: Final = 20
# An angle written with four digits, 1.571, is as near as this to a quarter turn.
_NEAR: Final = 3e-4
# Degrees of a quarter turn; a half turn and a whole one in quarters.
_QUARTER: Final = 90
_HALF: Final = 2
_WHOLE: Final = 4
AXES: Final = tensors.diagonal((Fraction(1),) * 3)


class Turn(NamedTuple):
    """A turn by an angle, a Fraction or an Irrational, about an axis of any length but zero."""

    axis: Vector
    angle: Any
    degrees: bool = False


@final
@dataclass(frozen=True)
class Root(Constant):
    """The square root of a positive rational number."""

    square: Fraction

    def __str__(self) -> str:
        return "roots"

    def evaluated(self) -> arb:
        return ball(self.square).sqrt()


@final
@dataclass(frozen=True)
class HalfTangent(Constant):
    """The tangent of half an angle, over the length of the axis."""

    angle: Any
    degrees: bool
    square: Fraction

    def __str__(self) -> str:
        return "tangents"

    def evaluated(self) -> arb:
        half = ball(self.angle) / 2
        if self.degrees:
            half *= arb.pi() / (_HALF * _QUARTER)
        return half.tan() / ball(self.square).sqrt()


def length(axis: Vector) -> Any:
    """Return the length of a vector exactly, as a Fraction or an Irrational."""
    square = tensors.dot(axis, axis)
    return exact_root(square) or generator((Root(square),), 0)


def product(turns: Iterable[Turn]) -> tuple[Any, ...]:
    """Return the exact quaternion of the turns, the last one done first.

    Each turn is about an axis that moves along. The sign is that of each one's cos(angle/2), sin(angle/2).
    """
    whole: Sequence[Any] = reduce(rotation.product, map(_quaternion, turns))
    return tuple(whole)


def combined(turns: Iterable[Turn]) -> Quaternion:
    """Return the product of the turns, its largest component made 1, the others rounded to 20 decimals.

    Turns by zero, and whole quarter turns in degrees about body axes, are exact.
    """
    q = product(turns)
    largest = max(q, key=lambda part: abs(float(part)))
    w, x, y, z = (round(_near(part / largest), DECIMALS) for part in q)
    return (w, x, y, z)


def roll_pitch_yaw(angles: Vector, degrees: bool = False) -> Quaternion:
    """Return the turns about the fixed axes x, y and z, in this order."""
    pairs = zip(reversed(AXES), reversed(angles), strict=True)
    return combined(Turn(axis, angle, degrees) for axis, angle in pairs)


def turned(tensor: Matrix, q: Quaternion) -> Matrix:
    """Return R I R^T, the components of a tensor in the axes that the turn leads to."""
    if not any(q[1:]):
        return tensor
    R = rotation.rotation_matrix(q)
    return tensors.product(tensors.product(R, tensor), tensors.transpose(R))


def remarks_on(name: str, angles: Vector, degrees: bool = False) -> tuple[str, ...]:
    """Return what a reader of the scene must know of these angles; nothing where all are zero."""
    if not any(angles):
        return ()
    unit = "degrees" if degrees else "radians"
    text = ", ".join(map(float_text, angles))
    remarks = [
        f"The tensor was turned by {name} = ({text}) {unit}: the largest component of their quaternion is "
        f"made 1, and the others are rounded to {DECIMALS} decimals (quarter turns in degrees are exact). "
        "The turn by it is exact, so that the principal moments are those of the file."
    ]
    if not degrees:
        remarks += [
            f"The angle {float_text(angle)} is taken as written, and is near a quarter turn but none."
            for angle in angles
            if angle and abs(remainder(float(angle), pi / 2)) < _NEAR
        ]
    return tuple(remarks)


def _quaternion(turn: Turn) -> Sequence[Any]:
    """Return a positive multiple of (cos(angle/2), sin(angle/2) v/|v|), v the axis of the turn."""
    if _quarters(turn) % _WHOLE == _HALF:
        is_first = _quarters(turn) % (2 * _WHOLE) == _HALF
        return (Fraction(0), *tensors.scaled(Fraction(1 if is_first else -1), turn.axis))
    cosine = Fraction(-1 if _half_turns(turn) % 2 else 1)
    return (cosine, *tensors.scaled(cosine * _tangent(turn), turn.axis))


def _quarters(turn: Turn) -> Any:
    """Return the angle in quarter turns if it is in degrees; radians are never whole quarters: 1/2."""
    return turn.angle / _QUARTER if turn.degrees else Fraction(1, 2)


def _half_turns(turn: Turn) -> int:
    """Return the whole number of half turns nearest to half the angle, proven."""
    whole = _WHOLE * _QUARTER if turn.degrees else 2 * PI
    return int(abs(turn.angle) / whole + Fraction(1, 2))


def _tangent(turn: Turn) -> Any:
    """Return tan(angle/2) over the length of the axis."""
    quarters = _quarters(turn)
    if not turn.angle or quarters % 2 == 0:
        return Fraction(0)
    if quarters % 2 == 1:
        return (2 - quarters % _WHOLE) / length(turn.axis)
    square = tensors.dot(turn.axis, turn.axis)
    tangent = generator((HalfTangent(abs(turn.angle), turn.degrees, square),), 0)
    return tangent if turn.angle > 0 else -tangent


def _near(number: Any) -> Fraction:
    return number.near() if isinstance(number, Irrational) else number
