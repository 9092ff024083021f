"""The free motion of a rigid body in balls: the rigorous route beside jacobi.

It shares the exact decisions of regime with that route, and no formula of orbit or attitude. Legend
as in regime; e is the axis of an axisymmetric body, J_s and J_d the moments about it and across.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any, Final, Protocol

import numpy as np
from flint import arb, ctx

from taylor_verify.exact.balls import Enclosed, Enclosure, ball, balls
from taylor_verify.exact.euler import quaternion
from taylor_verify.exact.euler.quaternion import Quaternion, Rows
from taylor_verify.exact.euler.regime import FreeSpin, Regime
from taylor_verify.exact.euler.top import top
from taylor_verify.exact.euler.tumbling import Tumbling
from taylor_verify.exact.solution import NoClosedForm
from taylor_verify.scenes import motion, tensors
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.scene import Scene

_STEADY: Final = (Regime.REST, Regime.SPHERICAL, Regime.STEADY)

# Working precisions are multiples of this, so that calls share their set-ups.
_PRECISION_STEP: Final = 32


def enclosed(scene: Scene) -> FreeRotationBalls:
    """The rigorous motion of a torque-free scene, attitude included where it is tracked.

    Raises NoClosedForm for a constant moment.
    """
    body, start = top(scene)
    if not body.is_free:
        raise NoClosedForm("a moment acts on the body")
    free = FreeSpin(body.inertia, start.omega)
    return FreeRotationBalls(free, start.attitude, "attitude" in scene.track)


class Course(Protocol):
    """One motion, set up at one precision of flint and good only there."""

    def at(self, t: arb, tracks_attitude: bool) -> tuple[list[arb], Rows | None]:
        """omega in body axes, and R where it is tracked."""
        ...

    def quaternion(self, t: arb) -> Quaternion:
        """q of unit length, of the sign that follows from the start without a jump."""
        ...


class FreeRotationBalls(Enclosed):
    """The torque-free motion of any rigid body: omega(t) in body axes, and R(t) from a start."""

    def __init__(
        self, spin: FreeSpin, attitude: motion.Quaternion, tracks_attitude: bool = True
    ) -> None:
        self.spin = spin
        self.regime = spin.regime.value
        self._attitude = attitude
        self._tracks_attitude = tracks_attitude
        self._courses: dict[int, Course] = {}

    def enclose(self, elapsed: Sequence[Fraction], bits: int) -> Enclosure:
        """``omega``, rows of 3, and ``attitude``, rows of 3x3, where it is tracked."""
        working = _stepped(bits)
        with ctx.workprec(working):
            course = self.course(working)
            found = [course.at(ball(t), self._tracks_attitude) for t in elapsed]
        omegas = [omega for omega, _ in found]
        if not self._tracks_attitude:
            return {"omega": omegas}
        return {"omega": omegas, "attitude": [rows for _, rows in found]}

    def quaternion(self, elapsed: Sequence[Fraction], digits: int) -> Motion:
        """``quaternion`` (n, 4), scalar first, of unit length, with a proven radius.

        It starts as the scene's own over its norm; its sign follows the motion without a jump.
        """
        return _Continuous(self).motion(elapsed, digits)

    def course(self, bits: int) -> Course:
        """The motion set up at the ambient precision of flint, which is ``bits``."""
        if bits not in self._courses:
            self._courses[bits] = _course(self.spin, quaternion.unit(self._attitude))
        return self._courses[bits]


class _Continuous(Enclosed):
    """The same motion told as a quaternion."""

    def __init__(self, rotation: FreeRotationBalls) -> None:
        self.regime = rotation.regime
        self._rotation = rotation

    def enclose(self, elapsed: Sequence[Fraction], bits: int) -> Enclosure:
        working = _stepped(bits)
        with ctx.workprec(working):
            course = self._rotation.course(working)
            return {"quaternion": [course.quaternion(ball(t)) for t in elapsed]}


def quaternions(scene: Scene, elapsed: Sequence[Fraction], digits: int) -> np.ndarray[Any, Any]:
    """The attitude at these times since the start as quaternions without a jump of sign.

    Object array (n, 4) of mpf, scalar first, unit length, error at most 10^-digits.
    Raises NoClosedForm for a constant moment.
    """
    return enclosed(scene).quaternion(elapsed, digits)["quaternion"]


def _stepped(bits: int) -> int:
    return -(-bits // _PRECISION_STEP) * _PRECISION_STEP


def _course(spin: FreeSpin, start: Quaternion) -> Course:
    if spin.regime in _STEADY:
        return _Steady(spin, start)
    if spin.regime is Regime.AXISYMMETRIC:
        return _Precession(spin, start)
    return Tumbling(spin, start)


class _Steady:
    """omega stays: a turn about one axis, or rest."""

    def __init__(self, spin: FreeSpin, start: Quaternion) -> None:
        self._start = start
        self._omega = balls(spin.omega)
        self._speed = ball(tensors.dot(spin.omega, spin.omega)).sqrt()
        self._axis = [w / self._speed for w in self._omega] if any(spin.omega) else self._omega

    def at(self, t: arb, tracks_attitude: bool) -> tuple[list[arb], Rows | None]:
        return self._omega, quaternion.matrix(self.quaternion(t)) if tracks_attitude else None

    def quaternion(self, t: arb) -> Quaternion:
        return quaternion.product(self._start, quaternion.turn(self._axis, self._speed * t / 2))


class _Precession:
    """An axisymmetric body: a turn about the constant H at H/J_d, after one about its own axis.

    In body axes omega turns about e at Om = (J_s - J_d)(e.w)/J_d. The projector (I - J_d)/(J_s - J_d)
    onto e is rational, and so are the parts of omega along e and across.
    """

    def __init__(self, spin: FreeSpin, start: Quaternion) -> None:
        double, simple = spin.double_moment, spin.simple_moment
        projector = [
            [(entry - (double if i == j else 0)) / (simple - double) for j, entry in enumerate(row)]
            for i, row in enumerate(spin.inertia)
        ]
        longest = max(range(3), key=lambda i: projector[i][i])
        column = tuple(projector[longest])
        length = ball(column[longest]).sqrt()
        self._axis = [component / length for component in balls(column)]
        along = tensors.scaled(tensors.dot(column, spin.omega) / column[longest], column)
        across = tensors.plus(spin.omega, tensors.scaled(Fraction(-1), along))
        ahead = tensors.cross(column, across)
        self._along, self._across = balls(along), balls(across)
        self._ahead = [component / length for component in balls(ahead)]
        turning = (simple - double) / double * tensors.dot(column, spin.omega)
        self._rate = ball(turning) / length

        momentum = ball(spin.momentum_squared).sqrt()
        self._momentum_axis = [component / momentum for component in balls(spin.momentum)]
        self._momentum_rate = momentum / ball(double)
        self._start = start

    def at(self, t: arb, tracks_attitude: bool) -> tuple[list[arb], Rows | None]:
        sin, cos = (self._rate * t).sin_cos()
        parts = zip(self._along, self._across, self._ahead, strict=True)
        omega = [along + cos * across + sin * ahead for along, across, ahead in parts]
        return omega, quaternion.matrix(self.quaternion(t)) if tracks_attitude else None

    def quaternion(self, t: arb) -> Quaternion:
        outer = quaternion.turn(self._momentum_axis, self._momentum_rate * t / 2)
        inner = quaternion.turn(self._axis, -self._rate * t / 2)
        return quaternion.product(self._start, quaternion.product(outer, inner))
