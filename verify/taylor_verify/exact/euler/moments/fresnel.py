"""A rigid body under a constant moment in mpmath: omega by Fresnel's integrals.

Legend as in regime; |n| phi = turning t + bending t^2, c = bending/|n|, b = turning/|n|. With s = t +
b/2c, s0 = b/2c and Fresnel's C and S (DLMF 7.2.7, 7.2.8),

    int_0^t e^(-i phi) dt = e^(ics0^2) [G(s) - G(s0)],      G(s) = g [C(s/g) - i sgn(c) S(s/g)],

g = (pi/2|c|)^(1/2); where c = 0 it is sin(bt)/b - i (1 - cos bt)/b, and t where b = 0 too.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Final

from mpmath import mp, mpc, mpf

from taylor_verify.exact.euler.moments.regime import Line, LoadedSpin, MomentRegime
from taylor_verify.exact.euler.moments.weber import WeberTurn
from taylor_verify.exact.euler.orbit import converted
from taylor_verify.exact.euler.rotations import Rotation, decades
from taylor_verify.exact.frames import Frame, product, turn
from taylor_verify.exact.rotation import cross, rotation_rows
from taylor_verify.exact.solution import NoClosedForm
from taylor_verify.scenes import motion

# Some hundred roundings in a row; what else is lost is counted, or left to the settling.
_OWN_GUARD_DIGITS: Final = 8


def loaded_rotation(spin: LoadedSpin, attitude: motion.Quaternion | None = None) -> Rotation:
    """The motion of a body with two or three equal moments, and R from an attitude at the start.

    Raises NoClosedForm where the attitude has none, and under a moment too weak for Kummer's functions.
    """
    line = None if attitude is None else spin.line
    if line is not None and line.is_weak:
        raise NoClosedForm(
            "in mpmath, the attitude under so weak a moment; the second route is taylor"
        )

    def lost(longest: Fraction, turned: bool) -> float:
        digits = _OWN_GUARD_DIGITS + _angle_digits(spin, longest)
        return digits if line is None else digits + _turn_digits(line, longest)

    return Rotation(spin.regime.value, lambda: _Course(spin, line), lost, attitude)


def _angle_digits(spin: LoadedSpin, longest: Fraction) -> float:
    """The decimal digits before the point of the angles |phi| and |c| s^2, up to this time."""
    turning, bending = abs(spin.free.turning), abs(spin.bending)
    largest = turning * longest + bending * longest**2
    if spin.regime is MomentRegime.OBLIQUE:
        # (b/2c)^2 |c|, and as much again for a difference of two integrals of nearly the same size.
        largest += 2 * (turning**2 / (4 * bending) + bending * longest**2)
    return decades(1 + largest**2 / spin.free.axis_squared) / 2


def _turn_digits(line: Line, longest: Fraction) -> float:
    """The decimal digits before the point of |z| = |b| s^2/2: e^(z/2) turns by no larger angle."""
    furthest = longest + abs(line.lead)
    return decades(1 + line.pace * furthest**4 / 4) / 2


class _Course:
    """The course at one precision of mpmath."""

    def __init__(self, spin: LoadedSpin, line: Line | None) -> None:
        self._spin = spin
        self._length = mp.sqrt(mp.convert(spin.free.axis_squared))
        self._axis = [entry / self._length for entry in converted(spin.free.axis)]
        self._across = converted(spin.free.across(spin.omega))
        self._push = converted(spin.push)
        self._b = mp.convert(spin.free.turning) / self._length
        self._c = mp.convert(spin.bending) / self._length
        if spin.bending and any(self._push):
            self._scale = mp.sqrt(mp.pi / (2 * abs(self._c)))
            self._half_way = mp.convert(spin.half_way)
            self._at_start = self._fresnel(self._half_way)
        if line is not None:
            self._turn = WeberTurn(line)

    def at(self, t: Fraction, turned: bool) -> tuple[list[mpf], Frame]:
        phi = mp.convert(self._spin.phi(t)) / self._length
        omega = self._omega(t, phi)
        if not turned:
            return omega, []
        return omega, product(rotation_rows(self._turn.quaternion(t)), turn(self._axis, -phi))

    def _omega(self, t: Fraction, phi: mpf) -> list[mpf]:
        """Rot(e, phi) acts on all of the transverse part at once, as the formula stands in regime."""
        transverse = self._across
        if any(self._push):
            gathered = self._gathered(mp.convert(t))
            pushed = zip(transverse, self._push, cross(self._axis, self._push), strict=True)
            transverse = [w + gathered.real * p + gathered.imag * q for w, p, q in pushed]
        cos, sin = mp.cos_sin(phi)
        along, ahead = converted(self._spin.along(t)), cross(self._axis, transverse)
        return [u + cos * w + sin * v for u, w, v in zip(along, transverse, ahead, strict=True)]

    def _gathered(self, time: mpf) -> mpc:
        """int_0^t e^(-i phi) dt."""
        if self._spin.bending:
            integral = self._fresnel(time + self._half_way) - self._at_start
            return mp.expj(self._c * self._half_way**2) * integral
        if self._spin.free.turning:
            sine = mp.sin(self._b * time / 2)
            return mpc(mp.sin(self._b * time), -2 * sine * sine) / self._b
        return mpc(time)

    def _fresnel(self, s: mpf) -> mpc:
        """G."""
        s /= self._scale
        return self._scale * mpc(mp.fresnelc(s), -mp.sign(self._c) * mp.fresnels(s))
