"""The turn of a frame whose angular velocity is a straight line a + b t, in balls.

Legend: a and b as in regime, w1 = |a_perp| and s = t + lead, so that a + b t = a_perp + b s; z =
i |b| s^2/2, al = i w1^2/8|b|; M is Kummer's function 1F1. In axes 1 along a_perp and 3 along b, and
for a quaternion g with g' = g (0, a + b t)/2, put x = g0 - i g3 and y = g1 - i g2. Then

    x' = -(i/2)|b| s x - (w1/2) y,      y' = (i/2)|b| s y + (w1/2) x,

and the solution with g = 1 at s = 0 is

    P = x = e^(-z/2) M(al, 1/2, z),     Q = y = (w1 s/2) e^(-z/2) M(al + 1, 3/2, z).

Both are entire in s: there is no root and no branch, and |P|^2 + |Q|^2 = 1. The turn since t = 0 is
g(s(0))* g(s(t)). Landau and Zener's problem; the formulas follow from DLMF 13.2.1 and 13.2.39.
"""

from __future__ import annotations

from fractions import Fraction

from flint import acb, arb

from taylor_verify.exact import rotation
from taylor_verify.exact.balls import balls
from taylor_verify.exact.euler.moments.regime import Line
from taylor_verify.numbers import tensors
from taylor_verify.numbers.irrational import ball


class KummerTurn:
    """The turn since t = 0, at the precision of flint at which this was made."""

    def __init__(self, line: Line) -> None:
        self._lead = line.lead
        self._rate = ball(tensors.dot(line.b, line.b)).sqrt()
        self._axis = [component / self._rate for component in balls(line.b)]
        self._across = balls(line.across)
        ahead = tensors.cross(line.b, line.across)
        self._ahead = [component / self._rate for component in balls(ahead)]
        squared = ball(tensors.dot(line.across, line.across))
        self._parameter = acb(0, squared / (8 * self._rate))
        self._back = rotation.conjugate(self._since_nearest(line.lead))

    def quaternion(self, t: Fraction) -> list[arb]:
        """The unit quaternion at the time t, 1 at t = 0."""
        return rotation.product(self._back, self._since_nearest(t + self._lead))

    def _since_nearest(self, s: Fraction) -> list[arb]:
        """g(s): w1 and the axes 1 and 2 enter as the vectors a_perp and b x a_perp/|b| alone."""
        half = acb(0, self._rate * ball(s * s) / 4)
        damped = (-half).exp()
        p = damped * (2 * half).hypgeom_1f1(self._parameter, acb(1) / 2)
        q = ball(s / 2) * damped * (2 * half).hypgeom_1f1(self._parameter + 1, acb(3) / 2)
        vector = zip(self._across, self._ahead, self._axis, strict=True)
        return [
            p.real,
            *(q.real * e1 - q.imag * e2 - p.imag * e3 for e1, e2, e3 in vector),
        ]
