"""Motions of Clebsch's body in which x and y only turn about its axis, in balls.

Rest, steady motion and, where x = 0, Euler's top: x3 is constant, x and y (so also U and Omega) turn
about body axis 3 at a constant rate n. Seen from the frame that turns with them everything is
constant, and with a = Omega(0) + n e3,

    R(t) = R(0) exp(t [a]x) exp(-n t [e3]x),    centre(t) = centre(0) + R(0) int exp(t [a]x) U(0) dt.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any, final

from flint import arb

from taylor_verify.exact.balls import Enclosed, Enclosure, ball, balls
from taylor_verify.exact.kirchhoff.quartic import Nutation
from taylor_verify.exact.rotation import rotation_matrix
from taylor_verify.scenes import tensors
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.tensors import Vector


@final
class TurningBody(Enclosed):
    """A motion whose x and y turn about axis 3 together, at a rate that is rational."""

    def __init__(
        self, kind: str, nutation: Nutation, start: Impulse, track: frozenset[str]
    ) -> None:
        self.regime = kind
        self._start, self._track = start, track
        self._rate = nutation.turn_rate
        body, x, y = nutation.body.body(), start.linear, start.angular
        self._velocity = tensors.plus(
            tensors.apply(body.linear, x), tensors.apply(body.coupling, y)
        )
        omega = tensors.plus(
            tensors.apply(tensors.transpose(body.coupling), x), tensors.apply(body.angular, y)
        )
        self._axis = tensors.plus(omega, (Fraction(0), Fraction(0), self._rate))
        self._to_space = rotation_matrix(start.attitude)

    def enclose(self, elapsed: Sequence[Fraction], bits: int) -> Enclosure:
        rows = [self._at(t) for t in elapsed]
        names = ("linear_impulse", "angular_impulse", *sorted(self._track))
        return {name: [row[name] for row in rows] for name in names}

    def _at(self, t: Fraction) -> dict[str, Any]:
        sin, cos = ball(self._rate * t).sin_cos()
        zero, one = arb(0), arb(1)
        turn = [[cos, -sin, zero], [sin, cos, zero], [zero, zero, one]]
        start = self._start
        found: dict[str, Any] = {
            "linear_impulse": _applied(turn, balls(start.linear)),
            "angular_impulse": _applied(turn, balls(start.angular)),
        }
        if self._track:
            to_space = [balls(row) for row in self._to_space]
            # The rows of the turn are the columns of its inverse.
            columns = [_applied(to_space, _turned(self._axis, row, t)) for row in turn]
            found["attitude"] = [list(row) for row in zip(*columns, strict=True)]
            if "centre" in self._track:
                found["centre"] = self._centre(t)
        return found

    def _centre(self, t: Fraction) -> list[arb]:
        start, to_space = self._start, self._to_space
        if not any(tensors.cross(self._axis, self._velocity)):
            # A straight path is rational, and may pass through the origin of space exactly.
            path = tensors.apply(to_space, tensors.scaled(t, self._velocity))
            return balls(tensors.plus(start.centre, path))
        swept = _applied([balls(row) for row in to_space], _swept(self._axis, self._velocity, t))
        return [c + v for c, v in zip(balls(start.centre), swept, strict=True)]


def _turned(axis: Vector, v: Sequence[arb], t: Fraction) -> list[arb]:
    """exp(t [a]x) v = v + sin(|a| t)/|a| a x v + (1 - cos |a| t)/|a|^2 a x (a x v)."""
    return _combined(axis, v, lambda a, angle: (arb(1), angle.sin() / a, _versed(angle) / a**2), t)


def _swept(axis: Vector, velocity: Vector, t: Fraction) -> list[arb]:
    """int_0^t exp(s [a]x) v ds, term by term."""

    def weights(a: arb, angle: arb) -> tuple[arb, arb, arb]:
        return ball(t), _versed(angle) / a**2, (angle - angle.sin()) / a**3

    return _combined(axis, balls(velocity), weights, t)


def _combined(
    axis: Vector,
    v: Sequence[arb],
    weights: Callable[[arb, arb], tuple[arb, arb, arb]],
    t: Fraction,
) -> list[arb]:
    """The sum of v, a x v and a x (a x v), weighted by functions of |a| and |a| t."""
    if not any(axis):
        return list(v)
    size = ball(tensors.dot(axis, axis)).sqrt()
    a = balls(axis)
    once = _cross(a, v)
    twice = _cross(a, once)
    along, across, back = weights(size, size * ball(t))
    return [along * p + across * q + back * r for p, q, r in zip(v, once, twice, strict=True)]


def _versed(angle: arb) -> arb:
    """1 - cos."""
    return 2 * (angle / 2).sin() ** 2


def _cross(a: Sequence[arb], b: Sequence[arb]) -> list[arb]:
    pairs = ((1, 2), (2, 0), (0, 1))
    return [a[j] * b[k] - a[k] * b[j] for j, k in pairs]


def _applied(matrix: Sequence[Sequence[arb]], v: Sequence[arb]) -> list[arb]:
    x, y, z = v
    return [a * x + b * y + c * z for a, b, c in matrix]
