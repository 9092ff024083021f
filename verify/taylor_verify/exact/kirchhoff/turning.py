"""Motions in which x and y only turn about body axis 3, or stay as they are, in balls.

Steady screws of any body, n = 0; rest and steady motion of Clebsch's body and, where x = 0, Euler's top:
x and y (so also U and Omega) turn about axis 3 at a constant rate n. Seen from the frame that turns with
them everything is constant, and with a = Omega(0) + n e3,

    R(t) = R(0) exp(t [a]x) exp(-n t [e3]x),    centre(t) = centre(0) + R(0) int exp(t [a]x) U(0) dt.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any, final

from flint import acb, arb, arb_mat

from taylor_verify.exact.balls import Enclosed, Enclosure, ball, ball_matrix, balls
from taylor_verify.exact.kirchhoff.solid import velocities
from taylor_verify.exact.rotation import rotation_matrix
from taylor_verify.exact.solution import Time, beside
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse


@final
class TurningBody(Enclosed):
    """A motion whose x and y turn about axis 3 together, at a rate that is rational."""

    def __init__(
        self,
        kind: str,
        body: ImmersedBody,
        start: Impulse,
        track: frozenset[str],
        rate: Fraction = Fraction(0),
    ) -> None:
        self.regime = kind
        self._start, self._track = start, track
        self._rate = rate
        self._U, Omega = velocities(body, start)
        self._axis = tensors.plus(Omega, (Fraction(0), Fraction(0), self._rate))
        self._to_space = rotation_matrix(start.attitude)

    def enclose(self, elapsed: Sequence[Time], bits: int) -> Enclosure:
        rows = [self._at(t) for t in elapsed]
        names = ("linear_impulse", "angular_impulse", *sorted(self._track))
        return {name: [row[name] for row in rows] for name in names}

    def _at(self, t: Time) -> dict[str, Any]:
        turn = acb(0, ball(beside(t, ball)(self._rate) * t)).exp()
        found: dict[str, Any] = {
            "linear_impulse": _turned(turn, balls(self._start.linear)),
            "angular_impulse": _turned(turn, balls(self._start.angular)),
        }
        if self._track:
            to_space, (rotation, swept) = ball_matrix(self._to_space), self._exponential(t)
            cos, sin = turn.real, turn.imag
            back = arb_mat([[cos, sin, 0], [-sin, cos, 0], [0, 0, 1]])
            found["attitude"] = (to_space * rotation * back).tolist()
            if "centre" in self._track:
                found["centre"] = self._centre(t, to_space * swept)
        return found

    def _exponential(self, t: Time) -> tuple[arb_mat, arb_mat]:
        """exp(t [a]x) and its integral from 0 to t, polynomials of [a]x."""
        a1, a2, a3 = balls(self._axis)
        once = arb_mat([[0, -a3, a2], [a3, 0, -a1], [-a2, a1, 0]])
        one, time = arb_mat([[1, 0, 0], [0, 1, 0], [0, 0, 1]]), ball(t)
        if not any(self._axis):
            return one, one * time
        twice = once * once
        a = ball(tensors.dot(self._axis, self._axis)).sqrt()
        sine, versed = (a * time).sin() / a, 2 * ((a * time / 2).sin() / a) ** 2
        return (
            one + once * sine + twice * versed,
            one * time + once * versed + twice * ((time - sine) / a**2),
        )

    def _centre(self, t: Time, swept: arb_mat) -> list[arb]:
        if not any(tensors.cross(self._axis, self._U)):
            # A straight path is rational, and may pass through the origin of space exactly.
            velocity, number = tensors.apply(self._to_space, self._U), beside(t, ball)
            pairs = zip(self._start.centre, velocity, strict=True)
            return [ball(number(c) + number(v) * t) for c, v in pairs]
        moved = (swept * arb_mat(3, 1, balls(self._U))).entries()
        return [c + v for c, v in zip(balls(self._start.centre), moved, strict=True)]


def _turned(turn: acb, v: Sequence[arb]) -> list[arb]:
    across = turn * acb(v[0], v[1])
    return [across.real, across.imag, v[2]]
