"""A rigid body under a constant moment in balls.

Legend as in regime; |n| phi = turning t + bending t^2, c = bending/|n|, b = turning/|n|. The moment's
share of w_perp is (1/J_d) (Re Y + Im Y e x) M_perp with

    Y = e^(i phi) int_0^t e^(-i phi) dt
      = t e^(ibt/2) sinc(bt/2)                                         if c = 0,
      = e^(ics^2) [erf(r s) - erf(r s0)] pi^(1/2)/2r,  r = (ic)^(1/2),  otherwise,

s = t + b/2c, s0 = b/2c (DLMF 7.2.1). erf is odd and entire: either root r serves.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from flint import acb, arb

from taylor_verify.exact import rotation
from taylor_verify.exact.balls import balls
from taylor_verify.exact.euler.moments.kummer import KummerTurn
from taylor_verify.exact.euler.moments.regime import Line, LoadedSpin, MomentRegime
from taylor_verify.exact.euler.rotations import OneByOne, RotationBalls, Rows
from taylor_verify.numbers import tensors
from taylor_verify.numbers.irrational import ball
from taylor_verify.scenes import motion


def loaded_rotation(spin: LoadedSpin, attitude: motion.Quaternion | None = None) -> RotationBalls:
    """The motion of a body with two or three equal moments, and R from an attitude at the start.

    Raises NoClosedForm where the attitude has none.
    """
    line = None if attitude is None else spin.line
    return RotationBalls(spin.regime.value, lambda: _Course(spin, line), attitude)


class _Course(OneByOne):
    """The course at one precision of flint."""

    def __init__(self, spin: LoadedSpin, line: Line | None) -> None:
        self._spin = spin
        self._length = length = ball(spin.free.axis_squared).sqrt()
        # A transverse vector times a complex number: its imaginary part turns the vector by e x.
        self._start, self._push = (
            (balls(vector), [p / length for p in balls(tensors.cross(spin.free.axis, vector))])
            for vector in (spin.free.across(spin.omega), spin.push)
        )
        self._is_pushed = any(spin.push)
        if spin.bending and self._is_pushed:
            self._root = acb(0, ball(spin.bending) / length).sqrt()
            self._at_start = (self._root * ball(spin.half_way)).erf()
            self._factor = arb.pi().sqrt() / (2 * self._root)
        if line is not None:
            self._axis = [component / length for component in balls(spin.free.axis)]
            self._turn = KummerTurn(line)

    def at(self, t: Fraction, turned: bool) -> tuple[list[arb], Rows]:
        phi = ball(self._spin.phi(t)) / self._length
        omega = self._omega(t, phi)
        if not turned:
            return omega, []
        back = rotation.turn(self._axis, -phi / 2)
        return omega, rotation.rotation_rows(rotation.product(self._turn.quaternion(t), back))

    def _omega(self, t: Fraction, phi: arb) -> list[arb]:
        spin = self._spin
        if spin.regime is MomentRegime.SPHERICAL:
            gained = tensors.scaled(t / spin.free.double_moment, spin.moment)
            return balls(tensors.plus(spin.omega, gained))
        omega = _added(balls(spin.along(t)), acb(0, phi).exp(), *self._start)
        return _added(omega, self._gathered(t), *self._push) if self._is_pushed else omega

    def _gathered(self, t: Fraction) -> acb:
        """Y."""
        if not self._spin.bending:
            half = ball(self._spin.free.turning * t / 2) / self._length
            return acb(0, half).exp() * (half.sinc() * ball(t))
        root = self._root * ball(t + self._spin.half_way)
        return (root * root).exp() * (root.erf() - self._at_start) * self._factor


def _added(
    vector: Sequence[arb], factor: acb, along: Sequence[arb], ahead: Sequence[arb]
) -> list[arb]:
    parts = zip(vector, along, ahead, strict=True)
    return [v + factor.real * p + factor.imag * q for v, p, q in parts]
