"""A rigid body under a constant moment in balls: the rigorous route beside fresnel.

It shares the exact decisions of regime with that route, and no special function. Legend as in regime;
|n| phi = turning t + bending t^2, c = bending/|n|, b = turning/|n|. The moment's share of w_perp is
(1/J_d) (Re Y + Im Y e x) M_perp with

    Y = e^(i phi) int_0^t e^(-i phi) dt
      = t e^(ibt/2) sinc(bt/2)                                         if c = 0,
      = e^(ics^2) [erf(r s) - erf(r s0)] pi^(1/2)/2r,  r = (ic)^(1/2),  otherwise,

s = t + b/2c, s0 = b/2c (DLMF 7.2.1). erf is odd and entire: either root r serves.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Final

from flint import acb, arb, ctx

from taylor_verify.exact.balls import Enclosed, Enclosure, ball, balls
from taylor_verify.exact.euler import quaternion
from taylor_verify.exact.euler.moments.kummer import KummerTurn
from taylor_verify.exact.euler.moments.regime import LoadedSpin, MomentRegime, loaded
from taylor_verify.exact.euler.quaternion import Quaternion
from taylor_verify.scenes import motion, tensors
from taylor_verify.scenes.scene import Scene

# Working precisions are multiples of this, so that calls share their set-ups.
_PRECISION_STEP: Final = 32


def enclosed(scene: Scene) -> LoadedRotationBalls:
    """The rigorous motion of a scene with a constant moment, attitude included where it is tracked.

    Raises NoClosedForm where anything tracked has none.
    """
    return LoadedRotationBalls(*loaded(scene))


class LoadedRotationBalls(Enclosed):
    """omega(t) in body axes and, from a start, R(t) of a body with two or three equal moments."""

    def __init__(self, spin: LoadedSpin, attitude: motion.Quaternion | None = None) -> None:
        self.spin = spin
        self.regime = spin.regime.value
        self._attitude = attitude
        self._courses: dict[int, _Course] = {}

    def enclose(self, elapsed: Sequence[Fraction], bits: int) -> Enclosure:
        """``omega``, rows of 3, and ``attitude``, rows of 3x3, where it is tracked."""
        working = -(-bits // _PRECISION_STEP) * _PRECISION_STEP
        with ctx.workprec(working):
            if working not in self._courses:
                self._courses[working] = _Course(self.spin, self._attitude)
            course = self._courses[working]
            found: dict[str, list[list[arb]]] = {"omega": [course.omega(t) for t in elapsed]}
            if self._attitude is None:
                return found
            turns = [quaternion.matrix(course.quaternion(t)) for t in elapsed]
            return {**found, "attitude": turns}


class _Course:
    """One motion, set up at one precision of flint and good only there."""

    def __init__(self, spin: LoadedSpin, attitude: motion.Quaternion | None) -> None:
        self._spin = spin
        length = ball(spin.axis_squared).sqrt()
        self._length = length
        self._axis = [component / length for component in balls(spin.axis)]
        start, push = (spin.across(vector) for vector in (spin.omega, spin.moment))
        push = tensors.scaled(1 / spin.double_moment, push)
        # A transverse vector times a complex number: its imaginary part turns the vector by e x.
        self._start, self._push = (
            (balls(vector), [p / length for p in balls(tensors.cross(spin.axis, vector))])
            for vector in (start, push)
        )
        self._is_pushed = any(push)
        if spin.bending and self._is_pushed:
            self._root = acb(0, ball(spin.bending) / length).sqrt()
            self._at_start = (self._root * ball(self._half_way)).erf()
            self._factor = arb.pi().sqrt() / (2 * self._root)
        if attitude is not None:
            self._turn = KummerTurn(spin.line)
            self._attitude = quaternion.unit(attitude)

    @property
    def _half_way(self) -> Fraction:
        """s0 = b/2c."""
        return self._spin.turning / (2 * self._spin.bending)

    def omega(self, t: Fraction) -> list[arb]:
        """In body axes."""
        spin = self._spin
        gained = tensors.scaled(t / spin.simple_moment, spin.along(spin.moment))
        if spin.regime is MomentRegime.SPHERICAL:
            return balls(tensors.plus(spin.omega, gained))
        found = balls(tensors.plus(spin.along(spin.omega), gained))
        found = _added(found, acb(0, self._angle(t)).exp(), *self._start)
        return _added(found, self._gathered(t), *self._push) if self._is_pushed else found

    def quaternion(self, t: Fraction) -> Quaternion:
        """q of unit length, of the sign that follows from the start without a jump."""
        turned = quaternion.product(self._attitude, self._turn.quaternion(t))
        return quaternion.product(turned, quaternion.turn(self._axis, -self._angle(t) / 2))

    def _angle(self, t: Fraction) -> arb:
        """phi."""
        return ball(t * (self._spin.turning + self._spin.bending * t)) / self._length

    def _gathered(self, t: Fraction) -> acb:
        """Y."""
        if not self._spin.bending:
            half = ball(self._spin.turning * t / 2) / self._length
            return acb(0, half).exp() * (half.sinc() * ball(t))
        s = t + self._half_way
        root = self._root * ball(s)
        return (root * root).exp() * (root.erf() - self._at_start) * self._factor


def _added(
    vector: Sequence[arb], factor: acb, along: Sequence[arb], ahead: Sequence[arb]
) -> list[arb]:
    parts = zip(vector, along, ahead, strict=True)
    return [v + factor.real * p + factor.imag * q for v, p, q in parts]
