"""The free motions of many rigid bodies at once, in balls about pairs of doubles.

The bodies have three different moments about the axes of the body, and are not on their
separatrix. The legend is that of moduli, where FLINT's balls have one body at a time. Written in
the momentum H = I w and in K = 1/J, with g_ab = |K_a - K_b| and so on,

    A = g_ac H_a^2 + g_bc H_b^2,    C = g_ab H_b^2 + g_ac H_c^2,    N = g_ab H_a^2 - g_bc H_c^2,
    lam^2 = g_ab A,    m = g_bc C/(g_ab A),    m' = g_ac N/(g_ab A),

the motion is H_a = (A/g_ac)^(1/2) dn u, H_b = -sig (C/g_ab)^(1/2) sn u, H_c = (C/g_ac)^(1/2) cn u.

The addition theorem is that of phase. Theta functions are divided by what they are at zero, so
that no root of the nome q is taken. With w = lam agm(1, k') t,

    p = sin w - q^2 sin 3w + q^6 sin 5w - ...        sn v = (r_0 p)/(t_0 s)
    t = cos w + q^2 cos 3w + q^6 cos 5w + ...        cn v = (s_0 t)/(t_0 s)
    r, s = 1 +- 2 q cos 2w + 2 q^4 cos 4w +- ...     dn v = (s_0 r)/(r_0 s)

The square of q comes by a step of Landen, k_1' = 2 k'^(1/2)/(1 + k'), from the series
q^2 = e + 2 e^5 + 15 e^9 + ... with 2 e = (1 - k_1'^(1/2))/(1 + k_1'^(1/2)) (DLMF 20.9.5).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, Final, NamedTuple, final

import numpy as np
from flint import arb, ctx

from taylor_verify.exact.pairs import Floats, Pairs, difference

# With 2^-(4n + 1) for their factors these sum up to 1: no one exceeds 2 16^n.
_NOME: Final = (1.0, 2.0, 15.0, 150.0, 1707.0, 20910.0, 268616.0, 3567400.0)
_MEANS: Final = 8
# Angles are counted from multiples of pi over this.
_PARTS: Final = 32
# The terms of theta functions beyond those that are balls. Beyond the largest nome m' is below 10^-4.
_TAIL: Final = range(3, 8)
_LARGEST_NOME: Final = 0.45
_UNIT: Final = 2.0**-53
# The steps of differences, as powers of two of the size of the momentum.
_ROUGH: Final = -36
_SHARP: Final = -30
# Sums of small terms in doubles, and what is left out of them: for an angle below pi/64.
_OF_COSINE: Final = 2.0**-71
_OF_SINE: Final = 2.0**-73


@final
@dataclass(frozen=True)
class Tops:
    """Bodies of inverse moments ``inverse`` (3, n), exactly, that start with ``momentum`` (3, n).

    Both are of size one: what is of another size is counted in other units.
    """

    inverse: Floats
    momentum: Pairs

    def motion(self, times: Floats) -> Pairs:
        """Return the momentum (3, n, m) in body axes at the times (n, m) since the start.

        Where it is not known the radius is infinite.
        """
        orbit = self._orbit
        with np.errstate(all="ignore"):
            rows = _functions(orbit, times)
            parts = (
                np.stack([np.broadcast_to(getattr(row, name), times.shape) for row in rows])
                for name in ("hi", "lo", "rad")
            )
            back = np.argsort(orbit.axes, axis=0)[:, :, None]
            hi, lo, rad = (np.take_along_axis(part, back, axis=0) for part in parts)
            rad = np.where(orbit.is_known[:, None], rad, np.inf)
        # At the start it is the start, to the last bit.
        start = Pairs(*(np.broadcast_to(part, hi.shape[:2])[:, :, None] for part in self.momentum))
        return start.chosen(times == 0, Pairs(hi, lo, rad))

    def at(self, places: Any) -> Tops:
        """Return some of the bodies."""
        return Tops(self.inverse[:, places], self.momentum[:, places])

    def transition(self, times: Floats, is_sharp: bool = False) -> tuple[Floats, Floats]:
        """Return the momentum (3, n, m) and its derivative by the start (n, m, 3, 3), in doubles.

        H moves as H'(0) does into H'(t), and lam H(lam t) is a motion too, so that H(0) moves into
        H + t H'. The third direction is that of H x H' at the start, by a difference of two motions: to
        about 10^-10 of its square, or ``is_sharp``, at the price of a third motion, 10^-18 of its cube.
        """
        begin, K = self.momentum.hi, self.inverse
        begin_rate = cross(begin, K * begin)
        beside = cross(begin, begin_rate)
        size = np.frexp(np.sqrt(_squared(begin) / _squared(beside)))[1]
        step = np.ldexp(1.0, size + (_SHARP if is_sharp else _ROUGH))
        here, there = self.motion(times), self._moved(beside * step).motion(times)
        before = self._moved(beside * -step).motion(times) if is_sharp else here
        length = (2 * step if is_sharp else step)[:, None]
        moved = ((there.hi - before.hi) + (there.lo - before.lo)) / length
        H = here.hi
        rate = cross(H, K[:, :, None] * H)
        became = (H + times * rate, rate, moved)
        began = (begin, begin_rate, beside)
        derivative = sum(
            np.einsum("inm,jn->nmij", end, start / _squared(start))
            for end, start in zip(became, began, strict=True)
        )
        widths = here.radius() + there.radius() + before.radius()
        known: Any = np.isfinite(widths).all(axis=0)
        return H, np.where(known[:, :, None, None], derivative, np.nan)

    def _moved(self, amount: Floats) -> Tops:
        return Tops(self.inverse, self.momentum + amount)

    @cached_property
    def _orbit(self) -> _Orbit:
        with np.errstate(all="ignore"):
            return _orbit(self.inverse, self.momentum)


def cross(a: Floats, b: Floats) -> Floats:
    """Return the products of vectors (3, ...)."""
    return np.stack(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )


def _squared(vectors: Floats) -> Floats:
    found: Floats = np.sum(vectors * vectors, axis=0)
    return found


class _Orbit(NamedTuple):
    """The numbers of n orbits, in columns (n, 1).

    ``axes`` (3, n) are the places of a, b, c; ``is_known`` (n) tells the orbits that are decided.
    """

    axes: Any
    is_known: Any
    speed: Pairs
    nome: Pairs
    forms: tuple[tuple[Pairs, Pairs], ...]
    squares: tuple[Pairs, Pairs]


def _orbit(inverse: Floats, momentum: Pairs) -> _Orbit:
    order = np.argsort(inverse, axis=0)
    K = np.take_along_axis(inverse, order, axis=0)
    H = Pairs(
        *(np.take_along_axis(np.broadcast_to(part, K.shape), order, axis=0) for part in momentum)
    )
    upper, lower, g_ac = difference(K[1], K[0]), difference(K[2], K[1]), difference(K[2], K[0])
    square = H * H
    N = square[0] * upper - square[2] * lower
    # About the axis of the largest moment, or of the least.
    is_max = N.hi > 0
    axes = np.where(is_max, order, order[::-1])
    parity = np.where((axes[1] - axes[0]) % 3 == 1, 1.0, -1.0)
    H_a, H_b, H_c = H[0].chosen(is_max, H[2]), H[1], H[2].chosen(is_max, H[0])
    g_ab, g_bc = upper.chosen(is_max, lower), lower.chosen(is_max, upper)
    N = N.chosen(is_max, -N)
    sense, side = np.where(is_max, 1.0, -1.0), np.where(H_a.hi < 0, -1.0, 1.0)

    A = g_ac * (H_a * H_a) + g_bc * (H_b * H_b)
    C = g_ab * (H_b * H_b) + g_ac * (H_c * H_c)
    rate_squared = g_ab * A
    m, m_prime = g_bc * C / rate_squared, g_ac * N / rate_squared
    a_a, a_b, a_c = (A / g_ac).sqrt(), (C / g_ab).sqrt(), (C / g_ac).sqrt()
    dn, sn = H_a.scaled(side) / a_a, H_b.scaled(-sense) / a_b
    cn = H_c.scaled(side * parity) / a_c

    k_prime = m_prime.sqrt()
    nome = _nome(m, k_prime)
    zero = _thetas(_powers(nome), Pairs(np.zeros_like(K[0])), Pairs(np.ones_like(K[0])))
    alpha, beta, gamma = zero.r / zero.t, zero.s / zero.t, zero.s / zero.r
    forms = (
        ((dn * gamma, -(m * sn) * (cn * alpha) * beta), a_a.scaled(side)),
        (((sn * beta) * gamma, (alpha * cn) * dn), a_b.scaled(-sense)),
        ((cn * beta, -(sn * dn) * (alpha * gamma)), a_c.scaled(side * parity)),
    )
    is_known = (N.hi > N.rad) & (abs(H_a.hi) > H_a.rad) & (nome.hi < _LARGEST_NOME) & (K[0] > 0)
    return _Orbit(
        axes=axes,
        is_known=is_known,
        speed=_column(rate_squared.sqrt() * _mean(k_prime)),
        nome=_column(nome),
        forms=tuple((_column(one * size), _column(other * size)) for (one, other), size in forms),
        squares=(_column(cn * cn), _column((sn * gamma) * (sn * gamma))),
    )


def _column(values: Pairs) -> Pairs:
    shape = np.shape(values.hi)
    return Pairs(*(np.broadcast_to(part, shape)[:, None] for part in values))


def _mean(k_prime: Pairs) -> Pairs:
    """The arithmetic-geometric mean of 1 and k': it lies between the means of every step."""
    large, small = k_prime + 1.0, k_prime.sqrt()
    large = large.scaled(0.5)
    for _ in range(_MEANS):
        large, small = (large + small).scaled(0.5), (large * small).sqrt()
    return large.widened(abs((large - small).hi) * (1 + 4 * _UNIT) + large.rad + small.rad)


def _nome(m: Pairs, k_prime: Pairs) -> Pairs:
    whole = k_prime + 1.0
    next_prime = k_prime.sqrt().scaled(2.0) / whole
    next_k = m / (whole * whole)
    root = next_prime.sqrt() + 1.0
    e = (next_k * next_k / ((next_prime + 1.0) * (root * root))).scaled(0.5)
    fourth = (e * e) * (e * e)
    total = fourth * _NOME[-1]
    for factor in _NOME[-2:0:-1]:
        total = fourth * (total + factor)
    ratio = 16 * fourth.hi * (1 + 2.0**-20)
    rest = np.where(ratio < 0.5, 4 * e.hi * ratio ** len(_NOME), np.inf)
    return (e * (total + 1.0)).widened(rest).sqrt()


class _Powers(NamedTuple):
    """q, 2 q^4, q^9, 1 - q^2, q^6, q^2 - q^6: the factors of the first terms, and q in doubles."""

    first: Pairs
    fourth: Pairs
    ninth: Pairs
    rest: Pairs
    sixth: Pairs
    change: Pairs
    nome: Floats


def _powers(q: Pairs) -> _Powers:
    second = q * q
    fourth = second * second
    sixth = fourth * second
    eighth = fourth * fourth
    return _Powers(q, fourth.scaled(2.0), eighth * q, 1.0 - second, sixth, second - sixth, q.hi)


class _Thetas(NamedTuple):
    p: Pairs
    t: Pairs
    r: Pairs
    s: Pairs


def _thetas(powers: _Powers, sine: Pairs, cosine: Pairs) -> _Thetas:
    """The four functions, of the sine and the cosine of w."""
    twice = (1.0 - (sine * sine).scaled(2.0)).scaled(2.0)  # 2 cos 2w
    fourfold = twice * twice - 1.0  # 1 + 2 cos 4w
    even = powers.fourth * (fourfold - 1.0).scaled(0.5) + 1.0
    odd = twice * (powers.first + powers.ninth * (fourfold - 2.0))
    whole = powers.sixth * fourfold + powers.rest
    change = powers.change * twice
    # The rest in doubles: 2 cos 2kw, and sin (2k + 1)w / sin w, cos (2k + 1)w / cos w.
    q, u = powers.nome, twice.hi
    cosines, sines, others = [u * u - 2, u], [u + u * u - 1, u + 1], [u * u - u - 1, u - 1]
    more: list[Any] = [0.0, 0.0, 0.0, 0.0]
    error = np.zeros_like(q)
    for k in _TAIL:
        for rows in (cosines, sines, others):
            rows[:] = [u * rows[0] - rows[1], rows[0]]
        sign, square, oblong = (-1) ** k, q ** (k * k), q ** (k * (k + 1))
        if k > 3:
            more[k % 2] = more[k % 2] + square * cosines[0]
        more[2] = more[2] + sign * oblong * sines[0]
        more[3] = more[3] + oblong * others[0]
        # By the recurrence, of which each step adds some roundings, and by the power.
        error = error + oblong * ((8 * (k + 1) ** 3 + 4 * k * (k + 1)) * _UNIT)
    last = _TAIL[-1] + 1
    error = error + 4 * (2 * last + 1) * q ** (last * last)
    even, odd = even + more[0], odd + more[1]
    return _Thetas(
        p=sine * (whole - change + more[2]).widened(error),
        t=cosine * (whole + change + more[3]).widened(error),
        r=(even + odd).widened(error),
        s=(even - odd).widened(error),
    )


def _functions(orbit: _Orbit, times: Floats) -> list[Pairs]:
    """The components of H along a, b, c."""
    p, t, r, s = _thetas(_powers(orbit.nome), *_sine_cosine(orbit.speed * times))
    cosine, sine = orbit.squares
    whole = 1.0 / (cosine * (s * s) + sine * (r * r))
    pairs = ((r * s, p * t), (t * r, p * s), (t * s, p * r))
    return [
        (one * left + other * right) * whole
        for (one, other), (left, right) in zip(orbit.forms, pairs, strict=True)
    ]


def _sine_cosine(angle: Pairs) -> tuple[Pairs, Pairs]:
    circle = _circle()
    count = np.rint(angle.hi * (_PARTS / np.pi))
    r = angle - circle.part * count
    square = r * r
    y = square.hi
    fourth = y * y
    cosine = fourth * (1 / 24 - y * (1 / 720 - y * (1 / 40320 - y / 3628800)))
    sine = fourth * (1 / 120 - y * (1 / 5040 - y * (1 / 362880 - y / 39916800)))
    c = (1.0 - square.scaled(0.5) + cosine).widened(_OF_COSINE)
    s = r * (1.0 - square * circle.sixth + sine).widened(_OF_SINE)
    places = np.mod(count, 2 * _PARTS).astype(np.intp)
    C, S = circle.cosine[places], circle.sine[places]
    return S * c + C * s, C * c - S * s


class _Circle(NamedTuple):
    """pi/32, 1/6, and the sines and cosines of the multiples of pi/32."""

    part: Pairs
    sixth: Pairs
    sine: Pairs
    cosine: Pairs


@lru_cache(maxsize=1)
def _circle() -> _Circle:
    with ctx.workprec(256):
        angles = [arb(k) / _PARTS for k in range(2 * _PARTS)]
        return _Circle(
            part=_pairs([arb.pi() / _PARTS])[0],
            sixth=_pairs([1 / arb(6)])[0],
            sine=_pairs([angle.sin_pi() for angle in angles]),
            cosine=_pairs([angle.cos_pi() for angle in angles]),
        )


def _pairs(values: list[arb]) -> Pairs:
    """Numbers of at most size one, rounded twice: what is left is below 2^-104."""
    high = [float(value.mid()) for value in values]
    low = [float((value - head).mid()) for value, head in zip(values, high, strict=True)]
    return Pairs(np.array(high), np.array(low), np.full(len(high), 2.0**-104))
