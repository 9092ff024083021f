"""A rigid body under a constant moment in mpmath: omega by Fresnel's integrals.

Legend as in regime; |n| phi = turning t + bending t^2, c = bending/|n|, b = turning/|n|. With s = t +
b/2c, s0 = b/2c and Fresnel's C and S (DLMF 7.2.7, 7.2.8),

    int_0^t e^(-i phi) dt = e^(ics0^2) [G(s) - G(s0)],      G(s) = g [C(s/g) - i sgn(c) S(s/g)],

g = (pi/2|c|)^(1/2); where c = 0 it is sin(bt)/b - i (1 - cos bt)/b, and t where b = 0 too.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np
from mpmath import mp, mpc, mpf

from taylor_verify.exact.euler.moments.regime import LoadedSpin, MomentRegime, loaded
from taylor_verify.exact.euler.moments.weber import WeberTurn
from taylor_verify.exact.euler.orbit import converted, cross
from taylor_verify.exact.frames import Frame, start_frame
from taylor_verify.exact.solution import Quantities, Settled
from taylor_verify.scenes import motion, tensors
from taylor_verify.scenes.precision import floor_log2
from taylor_verify.scenes.scene import Scene

# Some hundred roundings in a row; what else is lost is counted, or left to the settling.
_OWN_GUARD_DIGITS = 8


def closed_form(scene: Scene) -> LoadedRotation:
    """The closed form of a scene with a constant moment, attitude included where it is tracked.

    Raises NoClosedForm where anything tracked has none.
    """
    return LoadedRotation(*loaded(scene))


class LoadedRotation(Settled):
    """omega(t) in body axes and, from a start, R(t) of a body with two or three equal moments."""

    route = "mpmath"

    def __init__(self, spin: LoadedSpin, attitude: motion.Quaternion | None = None) -> None:
        self.spin = spin
        self.regime = spin.regime.value
        self._attitude = attitude

    def evaluate(self, elapsed: Sequence[Fraction], digits: int) -> Quantities:
        """``omega`` (n, 3) and ``attitude`` (n, 3, 3), to about ``digits`` significant digits."""
        longest = max((abs(t) for t in elapsed), default=Fraction(0))
        lost = angle_digits(self.spin, longest)
        if self._attitude is not None:
            lost += turn_digits(self.spin, longest)
        with mp.workdps(digits + _OWN_GUARD_DIGITS + math.ceil(lost)):
            course = _Course(self.spin)
            rows = [course.omega(t) for t in elapsed]
            found: dict[str, np.ndarray[Any, Any]] = {}
            found["omega"] = np.array(rows, dtype=object).reshape(-1, 3)
            if self._attitude is not None:
                frame = _FrameCourse(self.spin, self._attitude)
                frames = [frame.at(t) for t in elapsed]
                found["attitude"] = np.array(frames, dtype=object).reshape(-1, 3, 3)
        with mp.workdps(digits):
            return {name: +values for name, values in found.items()}


def angle_digits(spin: LoadedSpin, longest: Fraction) -> float:
    """The decimal digits before the point of the angles |phi| and |c| s^2, up to this time."""
    turning, bending = abs(spin.turning), abs(spin.bending)
    largest = turning * longest + bending * longest**2
    if spin.regime is MomentRegime.OBLIQUE:
        # (b/2c)^2 |c|, and as much again for a difference of two integrals of nearly the same size.
        largest += 2 * (turning**2 / (4 * bending) + bending * longest**2)
    return _decades(1 + largest**2 / spin.axis_squared) / 2


def turn_digits(spin: LoadedSpin, longest: Fraction) -> float:
    """The same of |z| = |b| s^2/2, which bounds the angle that e^(z/2) turns by."""
    line = spin.line
    furthest = longest + abs(line.lead)
    return _decades(1 + tensors.dot(line.b, line.b) * furthest**4 / 4) / 2


class _Course:
    """omega, at the precision of mpmath at which this was made."""

    def __init__(self, spin: LoadedSpin) -> None:
        self._spin = spin
        self._length = mp.sqrt(mp.convert(spin.axis_squared))
        self._axis = [entry / self._length for entry in converted(spin.axis)]
        self._across = converted(spin.across(spin.omega))
        self._push = converted(tensors.scaled(1 / spin.double_moment, spin.across(spin.moment)))
        self._b = mp.convert(spin.turning) / self._length
        self._c = mp.convert(spin.bending) / self._length
        if spin.bending and any(self._push):
            self._scale = mp.sqrt(mp.pi / (2 * abs(self._c)))
            self._half_way = mp.convert(spin.turning / (2 * spin.bending))
            self._at_start = self._fresnel(self._half_way)

    def omega(self, t: Fraction) -> list[mpf]:
        """In body axes."""
        spin, time = self._spin, mp.convert(t)
        along = spin.along(
            tensors.plus(spin.omega, tensors.scaled(t / spin.simple_moment, spin.moment))
        )
        transverse = self._across
        if any(self._push):
            gathered = self._gathered(time)
            ahead = cross(self._axis, self._push)
            pushed = zip(transverse, self._push, ahead, strict=True)
            transverse = [w + gathered.real * p + gathered.imag * q for w, p, q in pushed]
        # Rot(e, phi) acts on all of it at once: that is the formula as it stands in regime.
        cos, sin = mp.cos_sin((self._b + self._c * time) * time)
        turned = zip(converted(along), transverse, cross(self._axis, transverse), strict=True)
        return [u + cos * w + sin * v for u, w, v in turned]

    def _gathered(self, time: mpf) -> mpc:
        """int_0^t e^(-i phi) dt."""
        if self._spin.bending:
            found = self._fresnel(time + self._half_way) - self._at_start
            return mp.expj(self._c * self._half_way**2) * found
        if self._spin.turning:
            sine = mp.sin(self._b * time / 2)
            return mpc(mp.sin(self._b * time), -2 * sine * sine) / self._b
        return mpc(time)

    def _fresnel(self, s: mpf) -> mpc:
        """G."""
        s /= self._scale
        return self._scale * mpc(mp.fresnelc(s), -mp.sign(self._c) * mp.fresnels(s))


class _FrameCourse:
    """R = R0 A(t) Rot(e, -phi), at the precision of mpmath at which this was made."""

    def __init__(self, spin: LoadedSpin, attitude: motion.Quaternion) -> None:
        self._spin = spin
        self._start = mp.matrix(start_frame(attitude))
        self._turn = WeberTurn(spin.line)
        self._length = mp.sqrt(mp.convert(spin.axis_squared))
        self._axis = [entry / self._length for entry in converted(spin.axis)]

    def at(self, t: Fraction) -> Frame:
        phi = mp.convert(t * (self._spin.turning + self._spin.bending * t)) / self._length
        back = [mp.cos(phi / 2), *(-mp.sin(phi / 2) * entry for entry in self._axis)]
        found = self._start * mp.matrix(_matrix(self._turn.quaternion(t)))
        rows: Frame = (found * mp.matrix(_matrix(back))).tolist()
        return rows


def _matrix(q: Sequence[mpf]) -> Frame:
    """The rotation of a unit quaternion, scalar first."""
    w, x, y, z = q
    return [
        [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
    ]


def _decades(ratio: Fraction) -> float:
    """An upper bound of log10(ratio), for a positive ratio of any size."""
    return (floor_log2(ratio) + 1) * math.log10(2)
