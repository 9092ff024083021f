"""The free motion of a rigid body in balls: the rigorous route beside jacobi.

It shares the exact decisions of regime with that route, and no formula of orbit or attitude. Legend
as in regime and moduli; h = H/|H| in (a, b, c), rho^2 = h_a^2 + h_b^2, P = [e_a e_b e_c], and B(t) the
rotation that takes h to axis 3 and c into the plane of axes 1 and 3. With three different moments

    R(t) = R0 P B(0)^T Rz(psi) B(t) P^T.
"""

from __future__ import annotations

from functools import cached_property
from typing import final

from flint import arb, arb_mat

from taylor_verify.exact import rotation
from taylor_verify.exact.balls import balls
from taylor_verify.exact.euler.fixed_axis import FixedAxis, in_balls
from taylor_verify.exact.euler.moduli import Moduli, Triple
from taylor_verify.exact.euler.phase import Periodic, Separatrix
from taylor_verify.exact.euler.regime import CONSTANT, FreeSpin, Regime
from taylor_verify.exact.euler.rotations import OneByOne, RotationBalls, Rows
from taylor_verify.exact.solution import Time
from taylor_verify.numbers import tensors
from taylor_verify.numbers.irrational import ball
from taylor_verify.scenes import motion


def free_rotation(spin: FreeSpin, attitude: motion.Quaternion | None = None) -> RotationBalls:
    """The torque-free motion of any rigid body, and R from an attitude at the start."""
    regime = spin.regime
    if regime in CONSTANT:
        return in_balls(regime.value, FixedAxis(spin.omega), attitude)
    course = _Precession if regime is Regime.AXISYMMETRIC else Tumbling
    return RotationBalls(regime.value, lambda: course(spin), attitude)


@final
class _Precession(OneByOne):
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

    def at(self, t: Time, turned: bool) -> tuple[list[arb], Rows]:
        time = ball(t)
        sin, cos = (self._rate * time).sin_cos()
        parts = zip(self._along, self._across, self._ahead, strict=True)
        omega = [along + cos * across + sin * ahead for along, across, ahead in parts]
        if not turned:
            return omega, []
        outer = rotation.turn(self._momentum_axis, self._momentum_rate * time / 2)
        inner = rotation.turn(self._axis, -self._rate * time / 2)
        return omega, rotation.rotation_rows(rotation.product(outer, inner))


@final
class Tumbling(OneByOne):
    """A body with three different moments."""

    def __init__(self, spin: FreeSpin) -> None:
        self._moduli = moduli = Moduli(spin)
        is_separatrix = spin.regime is Regime.SEPARATRIX
        self._functions = Separatrix(moduli) if is_separatrix else Periodic(moduli)
        self._to_body = arb_mat([list(row) for row in zip(*moduli.axes, strict=True)])

    def at(self, t: Time, turned: bool) -> tuple[list[arb], Rows]:
        time = ball(t)
        functions = self._functions.at(time)
        parts = zip(self._moduli.amplitudes, functions, strict=True)
        omega = (self._to_body * arb_mat(3, 1, [size * f for size, f in parts])).entries()
        if not turned:
            return omega, []
        cos, sin = self._functions.phase(time, functions)
        pairs = zip(*self._tilt(functions), strict=True)
        tilted = [(cos * p - sin * q, sin * p + cos * q, h) for p, q, h in pairs]
        columns = arb_mat([list(column) for column in tilted])
        return omega, (self._tilted_back * (self._to_body * columns).transpose()).tolist()

    @cached_property
    def _tilted_back(self) -> arb_mat:
        """P B(0)^T."""
        return self._to_body * arb_mat(self._tilt(self._moduli.functions)).transpose()

    def _tilt(self, functions: Triple) -> Rows:
        """B: rows are unit vectors, the last one h, the second one normal to h and to axis c."""
        h_a, h_b, h_c = (h * f for h, f in zip(self._moduli.direction, functions, strict=True))
        rho = (h_a * h_a + h_b * h_b).sqrt()
        cos, sin = h_a / rho, h_b / rho
        return [[h_c * cos, h_c * sin, -rho], [-sin, cos, arb(0)], [h_a, h_b, h_c]]
