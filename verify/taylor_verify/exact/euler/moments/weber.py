"""The turn of a frame whose angular velocity is a straight line a + b t, in mpmath.

Legend as in kummer; here the equations for x and y are solved one by one, each as an equation of the
second order with two constants (Weber's, DLMF 12.2.2, in other names):

    x'' + (|a + b t|^2/4 + i|b|/2) x = 0,        y'' + (|a + b t|^2/4 - i|b|/2) y = 0.

Any two solutions f and h of the first with f h' - f' h = 1 serve, their conjugates solve the second. At
t = 0, x = 1, x' = -(i/2)|b| s0, y = 0 and y' = w1/2. An even and an odd function of s, by Kummer's
transformation (DLMF 13.2.39), are

    f = e^(z/2) M(1/2 - al, 1/2, -z),        h = s e^(z/2) M(1 - al, 3/2, -z).
"""

from __future__ import annotations

from fractions import Fraction
from typing import Final, final

from mpmath import mp, mpc, mpf

from taylor_verify.exact.euler.moments.regime import Line
from taylor_verify.exact.euler.orbit import converted
from taylor_verify.numbers import tensors

# f and h are of size 1, but the terms of their series reach e^|z|. mpmath raises its own precision
# against that, as far as this many bits: enough for |z| of some thousands, beyond which it has others.
_MOST_BITS: Final = 20_000


@final
class WeberTurn:
    """The turn since t = 0, at the precision of mpmath at which this was made."""

    def __init__(self, line: Line) -> None:
        self._lead, self._rate = line.lead, mp.sqrt(mp.convert(line.pace))
        self._axis = [component / self._rate for component in converted(line.b)]
        self._across = converted(line.across)
        ahead = tensors.cross(line.b, line.across)
        self._ahead = [component / self._rate for component in converted(ahead)]
        squared = mp.convert(tensors.dot(line.across, line.across))
        self._parameter = mpc(0, squared / (8 * self._rate))
        f, h = self._even_and_odd(line.lead)
        df, dh = self._slopes(line.lead)
        slope = mpc(0, -self._rate * mp.convert(line.lead) / 2)
        self._x = dh - slope * h, slope * f - df
        # y over w1, so that the direction of a_perp is never divided out.
        self._y = -mp.conj(h) / 2, mp.conj(f) / 2

    def quaternion(self, t: Fraction) -> list[mpf]:
        """The unit quaternion at the time t, scalar first; 1 at t = 0."""
        f, h = self._even_and_odd(t + self._lead)
        x = self._x[0] * f + self._x[1] * h
        y = self._y[0] * mp.conj(f) + self._y[1] * mp.conj(h)
        vector = zip(self._across, self._ahead, self._axis, strict=True)
        return [
            x.real,
            *(y.real * e1 - y.imag * e2 - x.imag * e3 for e1, e2, e3 in vector),
        ]

    def _even_and_odd(self, s: Fraction) -> tuple[mpc, mpc]:
        """f and h."""
        al, half, time = self._parameter, self._half(s), mp.convert(s)
        f, h = _m(0.5 - al, 0.5, -2 * half), time * _m(1 - al, 1.5, -2 * half)
        return mp.exp(half) * f, mp.exp(half) * h

    def _slopes(self, s: Fraction) -> tuple[mpc, mpc]:
        """f' and h' by M'(a, c, z) = (a/c) M(a + 1, c + 1, z) (DLMF 13.3.15)."""
        al, half, time = self._parameter, self._half(s), mp.convert(s)
        z, rate = 2 * half, mpc(0, self._rate) * time  # z' = i|b| s
        df = _m(0.5 - al, 0.5, -z) / 2 - (1 - 2 * al) * _m(1.5 - al, 1.5, -z)
        dh = (1 + z) * _m(1 - al, 1.5, -z) - 4 * z * (1 - al) / 3 * _m(2 - al, 2.5, -z)
        return rate * mp.exp(half) * df, mp.exp(half) * dh

    def _half(self, s: Fraction) -> mpc:
        """z/2."""
        return mpc(0, self._rate * mp.convert(s * s) / 4)


def _m(a: mpc, c: float | mpf, z: mpc) -> mpc:
    """Kummer's function; c is a half, held exactly by a double."""
    return mp.hyp1f1(a, c, z, maxprec=_MOST_BITS)
