"""Motions in which x and y only turn about a body axis, or stay as they are, in balls.

Steady screws of any body, tau = 0; rest and steady motion of Clebsch's body and, where x = 0, Euler's top:
x and y (so also U and Omega) turn about the axis at the constant rate tau |n|, n being along it. Seen from
the frame that turns with them everything is constant, and with a = Omega(0) + tau n,

    R(t) = R(0) exp(t [a]x) exp(-tau t [n]x),    centre(t) = centre(0) + R(0) int exp(t [a]x) U(0) dt.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any, Final, final

from flint import arb, arb_mat

from taylor_verify.exact.balls import Enclosed, Enclosure, ball_matrix, balls
from taylor_verify.exact.kirchhoff.solid import velocities
from taylor_verify.exact.solution import Time, beside
from taylor_verify.numbers import tensors
from taylor_verify.numbers.irrational import ball
from taylor_verify.numbers.rotation import rotation_matrix
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse

_UNIT: Final = tensors.diagonal((Fraction(1),) * 3)


@dataclass(frozen=True)
class Turning:
    """A motion whose x and y turn about the axis n together, or stay as they are.

    The rate tau and n are rational, of any length.
    """

    kind: str
    body: ImmersedBody
    start: Impulse
    track: frozenset[str]
    tau: Fraction = Fraction(0)
    n: Vector = _UNIT[2]

    @cached_property
    def U(self) -> Vector:
        """The velocity of the origin at the start."""
        return velocities(self.body, self.start)[0]

    @cached_property
    def a(self) -> Vector:
        """Omega(0) + tau n: the rate at which the axes turn in which nothing changes."""
        Omega = velocities(self.body, self.start)[1]
        return tensors.plus(Omega, tensors.scaled(self.tau, self.n))


@final
class TurningBody(Enclosed):
    """Such a motion in balls."""

    def __init__(self, turning: Turning) -> None:
        self.regime = turning.kind
        self._turning, self._start, self._n = turning, turning.start, turning.n
        self._to_space = rotation_matrix(turning.start.attitude)

    def enclose(self, elapsed: Sequence[Time], bits: int) -> Enclosure:
        rows = [self._at(t) for t in elapsed]
        names = ("linear_impulse", "angular_impulse", *sorted(self._turning.track))
        return {name: [row[name] for row in rows] for name in names}

    def _at(self, t: Time) -> dict[str, Any]:
        length = ball(tensors.dot(self._n, self._n)).sqrt()
        sine, cosine = (ball(beside(t, ball)(self._turning.tau) * t) * length).sin_cos()

        def turned(v: Vector) -> list[arb]:
            parts = zip(*self._parts(v), strict=True)
            return [ball(a) + cosine * ball(b) + sine / length * ball(c) for a, b, c in parts]

        quantities: dict[str, Any] = {
            "linear_impulse": turned(self._start.linear),
            "angular_impulse": turned(self._start.angular),
        }
        if self._turning.track:
            to_space, (rotation, swept) = ball_matrix(self._to_space), self._exponential(t)
            # The rows of the inverse are the images of e1, e2, e3.
            back = arb_mat([turned(unit) for unit in _UNIT])
            quantities["attitude"] = (to_space * rotation * back).tolist()
            if "centre" in self._turning.track:
                quantities["centre"] = self._centre(t, to_space * swept)
        return quantities

    def _parts(self, v: Vector) -> tuple[Vector, Vector, Vector]:
        """The part of v along n, the rest, and n x v."""
        share = tensors.dot(self._n, v) / tensors.dot(self._n, self._n)
        along = tensors.scaled(share, self._n)
        return along, tensors.minus(v, along), tensors.cross(self._n, v)

    def _exponential(self, t: Time) -> tuple[arb_mat, arb_mat]:
        """exp(t [a]x) and its integral from 0 to t, polynomials of [a]x."""
        a1, a2, a3 = balls(self._turning.a)
        once = arb_mat([[0, -a3, a2], [a3, 0, -a1], [-a2, a1, 0]])
        identity, time = arb_mat([[1, 0, 0], [0, 1, 0], [0, 0, 1]]), ball(t)
        if not any(self._turning.a):
            return identity, identity * time
        twice = once * once
        a = ball(tensors.dot(self._turning.a, self._turning.a)).sqrt()
        sine, versed = (a * time).sin() / a, 2 * ((a * time / 2).sin() / a) ** 2
        return (
            identity + once * sine + twice * versed,
            identity * time + once * versed + twice * ((time - sine) / a**2),
        )

    def _centre(self, t: Time, swept: arb_mat) -> list[arb]:
        if not any(tensors.cross(self._turning.a, self._turning.U)):
            # A straight path is rational, and may pass through the origin of space exactly.
            velocity, number = tensors.apply(self._to_space, self._turning.U), beside(t, ball)
            pairs = zip(self._start.centre, velocity, strict=True)
            return [ball(number(c) + number(v) * t) for c, v in pairs]
        moved = (swept * arb_mat(3, 1, balls(self._turning.U))).entries()
        return [c + v for c, v in zip(balls(self._start.centre), moved, strict=True)]
