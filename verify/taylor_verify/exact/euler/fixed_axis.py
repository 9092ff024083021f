"""A rigid body whose omega keeps its axis: free, or under a moment, by two routes.

omega = w0 + a t with a along w0, or either of them zero. With a vector n along both, the body turns by

    theta = (n.w0 t + n.a t^2/2)/|n|,    R = R0 Rot(n/|n|, theta).
"""

from __future__ import annotations

from enum import StrEnum
from fractions import Fraction
from typing import Any, Final, final

from flint import arb
from mpmath import mp, mpf

from taylor_verify.exact.balls import balls
from taylor_verify.exact.euler.orbit import converted
from taylor_verify.exact.euler.regime import FreeSpin
from taylor_verify.exact.euler.rotations import OneByOne, Rotation, RotationBalls, Rows, decades
from taylor_verify.exact.frames import Frame, turn
from taylor_verify.exact.solution import Number, Time, beside, unchanged
from taylor_verify.numbers import rotation, tensors
from taylor_verify.numbers.irrational import ball
from taylor_verify.numbers.tensors import ZERO_VECTOR, Vector
from taylor_verify.scenes.motion import Quaternion

_GUARD_DIGITS: Final = 8


class FixedAxisRegime(StrEnum):
    """The motions under a constant moment that have a closed form; the words of ``regime``."""

    STEADY = "steady-moment"  # the gyroscopic moment balances M: omega is constant
    STRAIGHT = "straight-moment"  # omega and M along one principal axis: the spin grows evenly


class FixedAxis:
    """w0, a and n, rational, and what follows from them without a root."""

    def __init__(self, omega: Vector, gain: Vector = ZERO_VECTOR) -> None:
        self._omega, self._gain = omega, gain
        self.axis = gain if any(gain) else omega
        self.axis_squared = tensors.dot(self.axis, self.axis)
        self._pace, self._bend = tensors.dot(self.axis, omega), tensors.dot(self.axis, gain) / 2

    def omega(self, t: Time, number: Number) -> list[Any]:
        """omega in these numbers, from its exact value where the time is rational."""
        if not self._bend:
            return [number(w) for w in self._omega]
        like = beside(t, number)
        return [number(like(w) + like(a) * t) for w, a in zip(self._omega, self._gain, strict=True)]

    def turned(self, t: Time, number: Number = unchanged) -> Any:
        """|n| theta, likewise."""
        like = beside(t, number)
        return number(t * (like(self._pace) + like(self._bend) * t))

    def lost(self, longest: Fraction, turned: bool) -> float:
        """The decimal digits before the point of the angle up to this time, and for roundings."""
        if not turned or not self.axis_squared:
            return _GUARD_DIGITS
        furthest = max(abs(self.turned(t)) for t in (longest, -longest))
        return _GUARD_DIGITS + decades(1 + furthest**2 / self.axis_squared) / 2


def axis_under(spin: FreeSpin, moment: Vector) -> tuple[FixedAxisRegime, FixedAxis] | None:
    """The motion of a body that keeps its axis under a moment (not zero); None where it does not."""
    if not any(tensors.plus(spin.torque, moment)):
        return FixedAxisRegime.STEADY, FixedAxis(spin.omega)
    pushed = tensors.apply(tensors.inverse(spin.inertia), moment)
    if any(tensors.cross(pushed, moment)) or any(tensors.cross(spin.omega, moment)):
        return None
    return FixedAxisRegime.STRAIGHT, FixedAxis(spin.omega, pushed)


def in_balls(regime: str, axis: FixedAxis, attitude: Quaternion | None) -> RotationBalls:
    """The motion in balls."""
    return RotationBalls(regime, lambda: FixedAxisBalls(axis), attitude)


def in_mpmath(regime: str, axis: FixedAxis, attitude: Quaternion | None) -> Rotation:
    """The motion in mpmath."""
    return Rotation(regime, lambda: FixedAxisFloats(axis), axis.lost, attitude)


@final
class FixedAxisBalls(OneByOne):
    """The course in balls."""

    def __init__(self, exact: FixedAxis) -> None:
        self._exact, self._length = exact, ball(exact.axis_squared or 1).sqrt()
        self._axis = [entry / self._length for entry in balls(exact.axis)]

    def at(self, t: Time, turned: bool) -> tuple[list[arb], Rows]:
        omega, angle = self._exact.omega(t, ball), self._exact.turned(t, ball) / self._length
        half = rotation.turn(self._axis, angle / 2)
        return omega, rotation.rotation_rows(half) if turned else []


@final
class FixedAxisFloats:
    """The course in mpmath."""

    def __init__(self, exact: FixedAxis) -> None:
        self._exact, self._length = exact, mp.sqrt(mp.convert(exact.axis_squared or 1))
        self._axis = converted(exact.axis)

    def at(self, t: Time, turned: bool) -> tuple[list[mpf], Frame]:
        omega, angle = self._exact.omega(t, mp.convert), self._exact.turned(t, mp.convert)
        return omega, turn(self._axis, angle / self._length) if turned else []
