"""The turn of a frame whose angular velocity is a straight line a + b t, in mpmath.

Legend as in kummer; here the equations for x and y are solved one by one, each as an equation of the
second order with two constants (Weber's, DLMF 12.2.2, in other names):

    x'' + (|a + b t|^2/4 + i|b|/2) x = 0,        y'' + (|a + b t|^2/4 - i|b|/2) y = 0.

Any two solutions f and h of the first with f h' - f' h = 1 serve, their conjugates solve the second. At
t = 0, x = 1, x' = -(i/2)|b| s0, y = 0 and y' = w1/2. An even and an odd function of s, by Kummer's
transformation (DLMF 13.2.39), are

    f = e^(z/2) M(1/2 - al, 1/2, -z),        h = s e^(z/2) M(1 - al, 3/2, -z).

Under a weak moment f and h are power series, which start as 1 and t. They share no recurrence with those of
series: that one knows neither |b| nor an equation of the second order.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from fractions import Fraction
from typing import Final, Protocol, final

from mpmath import mp, mpc, mpf

from taylor_verify.exact.euler.moments.regime import Line
from taylor_verify.exact.euler.orbit import converted
from taylor_verify.scenes import tensors

# f and h are of size 1, but the terms of their series reach e^|z|. mpmath raises its own precision
# against that, as far as this many bits: enough for |z| of some thousands, beyond which it has others.
_MOST_BITS: Final = 20_000
# Of one power series bounds of |a| t/2 and |b| t^2/4: its terms reach the exponential of both.
_HALF_ANGLE: Final = 16
_GUARD_BITS: Final = 6 * _HALF_ANGLE


Values = tuple[tuple[mpc, mpc], tuple[mpc, mpc]]
"""f and f', h and h'."""


class Pair(Protocol):
    """The solutions f and h, at the precision of mpmath at which this was made."""

    start: tuple[mpc, mpc, mpc, mpc]
    """f, h, f' and h' at t = 0."""

    def at(self, t: Fraction) -> tuple[mpc, mpc]:
        """f and h."""
        ...


@final
class WeberTurn:
    """The turn since t = 0, at the precision of mpmath at which this was made."""

    def __init__(self, line: Line) -> None:
        rate = mp.sqrt(mp.convert(line.pace))
        self._axis = [component / rate for component in converted(line.b)]
        self._across = converted(line.across)
        ahead = tensors.cross(line.b, line.across)
        self._ahead = [component / rate for component in converted(ahead)]
        self._pair: Pair = SeriesPair(line) if line.is_weak else KummerPair(line)
        f, h, df, dh = self._pair.start
        slope = mpc(0, -rate * mp.convert(line.lead) / 2)
        self._x = dh - slope * h, slope * f - df
        # y over w1, so that the direction of a_perp is never divided out.
        self._y = -mp.conj(h) / 2, mp.conj(f) / 2

    def quaternion(self, t: Fraction) -> list[mpf]:
        """The unit quaternion at the time t, scalar first; 1 at t = 0, without a jump of sign."""
        f, h = self._pair.at(t)
        x = self._x[0] * f + self._x[1] * h
        y = self._y[0] * mp.conj(f) + self._y[1] * mp.conj(h)
        vector = zip(self._across, self._ahead, self._axis, strict=True)
        return [
            x.real,
            *(y.real * e1 - y.imag * e2 - x.imag * e3 for e1, e2, e3 in vector),
        ]


@final
class KummerPair:
    """The even and the odd solution about the nearest approach."""

    def __init__(self, line: Line) -> None:
        self._lead = line.lead
        self._rate = mp.sqrt(mp.convert(line.pace))
        squared = mp.convert(tensors.dot(line.across, line.across))
        self._parameter = mpc(0, squared / (8 * self._rate))
        self.start = *self.at(Fraction(0)), *self._slopes(line.lead)

    def at(self, t: Fraction) -> tuple[mpc, mpc]:
        """f and h."""
        s = t + self._lead
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


@final
class SeriesPair:
    """The solutions that start as 1 and t, by power series about one time after the other."""

    start = mpc(1), mpc(0), mpc(0), mpc(1)

    def __init__(self, line: Line) -> None:
        self._line = line
        self._rate = mp.sqrt(mp.convert(line.pace))
        f, h, df, dh = self.start
        # On either side of t = 0 the times, ascending in size, and what f and h are there.
        self._sides = {side: ([Fraction(0)], [((f, df), (h, dh))]) for side in (1, -1)}

    def at(self, t: Fraction) -> tuple[mpc, mpc]:
        """f and h."""
        self._line.check_reach(t)
        side = 1 if t >= 0 else -1
        times, values = self._sides[side]
        span = Fraction(1)
        while times[-1] < abs(t):
            begin = side * times[-1]
            span = _longest(self._line.restarted(begin), span)
            times.append(times[-1] + span)
            values.append(self._carried(begin, values[-1], side * span))
        k = bisect_right(times, abs(t)) - 1
        (f, _), (h, _) = self._carried(side * times[k], values[k], t - side * times[k])
        return f, h

    def _carried(self, begin: Fraction, values: Values, span: Fraction) -> Values:
        """f, f' and h, h' a span later."""
        if not span:
            return values
        line = self._line.restarted(begin)
        squared, product = tensors.dot(line.a, line.a), tensors.dot(line.a, line.b)
        factors = (
            mpc(mp.convert(squared * span**2 / 4), self._rate * mp.convert(span**2) / 2),
            mpc(mp.convert(product * span**3 / 2)),
            mpc(mp.convert(line.pace * span**4 / 4)),
        )
        time = mp.convert(span)
        f, h = (_summed(factors, value, time * slope) for value, slope in values)
        return (f[0], f[1] / time), (h[0], h[1] / time)


def _longest(line: Line, span: Fraction) -> Fraction:
    """The longest span, of those that are this one times a power of two, for one power series."""
    while line.is_short(2 * span, _HALF_ANGLE):
        span *= 2
    while not line.is_short(span, _HALF_ANGLE):
        span /= 2
    return span


def _summed(factors: Sequence[mpc], value: mpc, slope: mpc) -> tuple[mpc, mpc]:
    """u and u' at 1 of u'' + (c0 + c1 s + c2 s^2) u = 0, from u and u' at 0.

    In integers, so many bits of which are behind the point: the series ends where its terms do.
    """
    bits = mp.prec + _GUARD_BITS
    shift = bits - mp.mag(max(abs(value), abs(slope)))
    (a, b), (c, _), (d, _) = (_integers(factor, bits) for factor in factors)
    (x, y), (p, q) = _integers(value, shift), _integers(slope, shift)
    # Terms number k - 3 to k, real and imaginary; the last one is p + i q.
    r, s, u, v, k = 0, 0, 0, 0, 1
    total, rise = (x + p, y + q), (p, q)
    while p or q or x or y or u or v:
        k += 1
        below = k * (k - 1) << bits
        # Rounded to the nearest: rounded down, the last bit of a negative term would stay for ever.
        fresh = (
            (below // 2 - a * x + b * y - c * u - d * r) // below,
            (below // 2 - a * y - b * x - c * v - d * s) // below,
        )
        r, s, u, v, x, y, (p, q) = u, v, x, y, p, q, fresh
        total = total[0] + p, total[1] + q
        rise = rise[0] + k * p, rise[1] + k * q
    return _complex(total, shift), _complex(rise, shift)


def _integers(value: mpc, bits: int) -> tuple[int, int]:
    """The real and the imaginary part times 2^bits, rounded."""
    return int(mp.nint(mp.ldexp(value.real, bits))), int(mp.nint(mp.ldexp(value.imag, bits)))


def _complex(parts: tuple[int, int], bits: int) -> mpc:
    return mpc(*(mp.ldexp(part, -bits) for part in parts))
