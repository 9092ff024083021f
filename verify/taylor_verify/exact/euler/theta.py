"""The free motion of a rigid body in balls: the rigorous route beside jacobi.

It shares the exact decisions of regime with that route, and no formula of orbit or attitude. Legend
as in regime.
"""

from __future__ import annotations

from fractions import Fraction

from flint import arb

from taylor_verify.exact.balls import ball, balls
from taylor_verify.exact.euler import quaternion
from taylor_verify.exact.euler.fixed_axis import FixedAxisBalls
from taylor_verify.exact.euler.quaternion import Quaternion
from taylor_verify.exact.euler.regime import CONSTANT, FreeSpin, Regime
from taylor_verify.exact.euler.rotations import Course, RotationBalls
from taylor_verify.exact.euler.tumbling import Tumbling
from taylor_verify.exact.rotation import product
from taylor_verify.scenes import motion, tensors


def free_rotation(spin: FreeSpin, attitude: motion.Quaternion | None = None) -> RotationBalls:
    """The torque-free motion of any rigid body, and R from an attitude at the start."""
    return RotationBalls(spin.regime.value, lambda: _course(spin), attitude)


def _course(spin: FreeSpin) -> Course:
    """The motion set up at the ambient precision of flint."""
    if spin.regime in CONSTANT:
        return FixedAxisBalls(spin.omega)
    return _Precession(spin) if spin.regime is Regime.AXISYMMETRIC else Tumbling(spin)


class _Precession:
    """An axisymmetric body: a turn about the constant H at H/J_d, after one about its own axis.

    In body axes omega turns about e at Om = (J_s - J_d)(e.w)/J_d.
    """

    def __init__(self, spin: FreeSpin) -> None:
        length = ball(spin.axis_squared).sqrt()
        self._axis = [component / length for component in balls(spin.axis)]
        across = spin.across(spin.omega)
        self._along, self._across = balls(spin.along(spin.omega)), balls(across)
        self._ahead = [p / length for p in balls(tensors.cross(spin.axis, across))]
        self._rate = ball(spin.turning) / length
        momentum = ball(spin.momentum_squared).sqrt()
        self._momentum_axis = [component / momentum for component in balls(spin.momentum)]
        self._momentum_rate = momentum / ball(spin.double_moment)

    def at(self, t: Fraction, turned: bool) -> tuple[list[arb], Quaternion]:
        time = ball(t)
        sin, cos = (self._rate * time).sin_cos()
        parts = zip(self._along, self._across, self._ahead, strict=True)
        omega = [along + cos * across + sin * ahead for along, across, ahead in parts]
        if not turned:
            return omega, []
        outer = quaternion.turn(self._momentum_axis, self._momentum_rate * time / 2)
        inner = quaternion.turn(self._axis, -self._rate * time / 2)
        return omega, product(outer, inner)
