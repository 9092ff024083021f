"""Theta functions and elliptic integrals of real arguments, in arrays of balls about pairs of doubles.

Theta functions are divided by what they are at zero, so that no root of the nome q is taken:

    p = sin w - q^2 sin 3w + q^6 sin 5w - ...        sn v = (r_0 p)/(t_0 s)
    t = cos w + q^2 cos 3w + q^6 cos 5w + ...        cn v = (s_0 t)/(t_0 s)
    r, s = 1 +- 2 q cos 2w + 2 q^4 cos 4w +- ...     dn v = (s_0 r)/(r_0 s)

Steps of Landen, k_1 = (1 - k')/(1 + k') and k_1' = 2 k'^(1/2)/(1 + k'), square the nome. After two of them,
q^4 = e + 2 e^5 + 15 e^9 + ... with 2 e = (1 - k_2'^(1/2))/(1 + k_2'^(1/2)) (DLMF 20.9.5).
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, Final, NamedTuple

import numpy as np
from flint import arb, ctx

from taylor_verify.scenes.pairs import Floats, Pairs

# With 2^-(4n + 1) for their factors these sum up to 1: no one exceeds 2 16^n.
_NOME: Final = (1.0, 2.0, 15.0, 150.0, 1707.0, 20910.0, 268616.0, 3567400.0)
# After two steps of Landen e is below 0.03 for every nome below 0.5. After one it is 0.2, where eight terms
# of the series are too few.
_STEPS: Final = 2
_MEANS: Final = 8
# Angles are counted from multiples of pi over this.
_PARTS: Final = 32
# The terms k of theta functions in doubles: of p and t all of these, of r and s without the first.
# Those before are balls. Beyond the largest nome m' is below 10^-4.
_TAIL: Final = range(4, 8)
_UNIT: Final = 2.0**-53
# Sums of small terms in doubles, and what is left out of them: for an angle below pi/64.
_OF_COSINE: Final = 2.0**-71
_OF_SINE: Final = 2.0**-73


# An exponential by its series, of a number so many times halved, and squared as often again.
_HALVINGS: Final = 8
_TERMS: Final = 15
# Carlson's duplications, each of which divides what is left by four.
_DUPLICATIONS: Final = 10


def mean(k_prime: Pairs) -> Pairs:
    """Return the arithmetic-geometric mean of 1 and k': it lies between the means of every step."""
    large, small = k_prime + 1.0, k_prime.sqrt()
    large = large.scaled(0.5)
    for _ in range(_MEANS):
        large, small = (large + small).scaled(0.5), (large * small).sqrt()
    return large.widened(abs((large - small).hi) * (1 + 4 * _UNIT) + large.rad + small.rad)


def nome_of(m: Pairs, k_prime: Pairs) -> Pairs:
    """Return the nome of the parameter m and the complementary modulus k'."""
    for _ in range(_STEPS):
        whole = k_prime + 1.0
        k = m / (whole * whole)
        m, k_prime = k * k, k_prime.sqrt().scaled(2.0) / whole
    root = k_prime.sqrt() + 1.0
    e = (m / ((k_prime + 1.0) * (root * root))).scaled(0.5)
    fourth = (e * e) * (e * e)
    total = fourth * _NOME[-1]
    for factor in _NOME[-2:0:-1]:
        total = fourth * (total + factor)
    ratio = 16 * fourth.hi * (1 + 2.0**-20)
    rest = np.where(ratio < 0.5, 4 * e.hi * ratio ** len(_NOME), np.inf)
    nome = (e * (total + 1.0)).widened(rest)
    for _ in range(_STEPS):
        nome = nome.sqrt()
    return nome


class Powers(NamedTuple):
    """Factors of the first terms, made of powers of the nome q, and q in doubles.

    ``even`` are 1 - 2 q^16, q^4 and q^16; ``odd`` q and q^9; ``whole`` 1 - q^2 and q^6 - q^12;
    ``change`` q^2 - q^6 + q^12 and q^12.
    """

    even: tuple[Pairs, Pairs, Pairs]
    odd: tuple[Pairs, Pairs]
    whole: tuple[Pairs, Pairs]
    change: tuple[Pairs, Pairs]
    nome: Floats


def powers(q: Pairs) -> Powers:
    """Return the factors of a nome."""
    second = q * q
    fourth = second * second
    sixth = fourth * second
    eighth = fourth * fourth
    twelfth, sixteenth = eighth * fourth, eighth * eighth
    short = sixth - twelfth
    return Powers(
        even=(1.0 - sixteenth.scaled(2.0), fourth, sixteenth),
        odd=(q, eighth * q),
        whole=(1.0 - second, short),
        change=(second - short, twelfth),
        nome=q.hi,
    )


class Thetas(NamedTuple):
    """The four functions at one argument, as the head of this file has them."""

    p: Pairs
    t: Pairs
    r: Pairs
    s: Pairs


def thetas(factors: Powers, sine: Pairs, cosine: Pairs) -> Thetas:
    """Return the four functions, by the sine and the cosine of w."""
    # With c_k = 2 cos kw: sin 5w / sin w = 1 + c_4 + c_2, sin 7w / sin w = 1 + c_4 + c_2 + c_6, and of
    # the cosines with c_2 and c_6 turned, cos 5w / cos w = 1 + c_4 - c_2.
    c_2 = (1.0 - (sine * sine).scaled(2.0)).scaled(2.0)
    squared = c_2 * c_2
    c_4, c_6, fourfold = squared - 2.0, c_2 * (squared - 3.0), squared - 1.0
    zeroth, first, second = factors.even
    even = c_4 * (second * c_4 + first) + zeroth
    odd = c_2 * factors.odd[0] + c_6 * factors.odd[1]
    whole = fourfold * factors.whole[1] + factors.whole[0]
    change = c_2 * factors.change[0] + c_6 * factors.change[1]
    # The rest in doubles: 2 cos 2kw, and sin (2k + 1)w / sin w, cos (2k + 1)w / cos w.
    q, u = factors.nome, c_2.hi
    cosines, sines, others = [c_6.hi, c_4.hi], [0.0, fourfold.hi + u], [0.0, fourfold.hi - u]
    sines[0], others[0] = sines[1] + c_6.hi, c_6.hi - others[1]
    more: list[Any] = [0.0, 0.0, 0.0, 0.0]
    error = np.zeros_like(q)
    for k in _TAIL:
        for rows in (cosines, sines, others):
            rows[:] = [u * rows[0] - rows[1], rows[0]]
        sign, power, oblong = (-1) ** k, q ** (k * k), q ** (k * (k + 1))
        if k > _TAIL[0]:
            more[k % 2] = more[k % 2] + power * cosines[0]
        more[2] = more[2] + sign * oblong * sines[0]
        more[3] = more[3] + oblong * others[0]
        # By the recurrence, of which each step adds some roundings, and by the power. With it comes the
        # error of the next term of r and s, which has a higher power.
        error = error + oblong * ((8 * (k + 1) ** 3 + 4 * k * (k + 1)) * _UNIT)
    last = _TAIL[-1] + 1
    error = error + 4 * (2 * last + 1) * q ** (last * last)
    even, odd = even + more[0], odd + more[1]
    return Thetas(
        p=sine * (whole - change + more[2]).widened(error),
        t=cosine * (whole + change + more[3]).widened(error),
        r=(even + odd).widened(error),
        s=(even - odd).widened(error),
    )


def sine_cosine(angle: Pairs) -> tuple[Pairs, Pairs]:
    """Return sine and cosine of angles."""
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
    # What is no number stays none, whatever stands in its place of the table.
    places = np.mod(np.where(np.isfinite(count), count, 0.0), 2 * _PARTS).astype(np.intp)
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


def exponential(x: Pairs) -> Pairs:
    """Return e^x of numbers between 0 and 16."""
    small = x.scaled(2.0**-_HALVINGS)
    total = Pairs(np.ones_like(x.hi))
    for k in range(_TERMS, 0, -1):
        total = total * small / float(k) + 1.0
    total = total.widened(np.where(x.hi <= 16.0, 2.0**-104, np.inf))
    for _ in range(_HALVINGS):
        total = total * total
    return total


def carlson(x: Pairs, y: Pairs, z: Pairs) -> Pairs:
    """Return R_F of positive numbers by duplication (Carlson, Numer. Math. 33, 1979)."""
    for _ in range(_DUPLICATIONS):
        root_x, root_y, root_z = x.sqrt(), y.sqrt(), z.sqrt()
        more = root_x * root_y + root_y * root_z + root_z * root_x
        x, y, z = ((argument + more).scaled(0.25) for argument in (x, y, z))
    middle = (x + y + z) / 3.0
    a, b = 1.0 - x / middle, 1.0 - y / middle
    c = -(a + b)
    second, third = a * b - c * c, a * b * c
    series = second * second / 24.0 - second / 10.0 + third / 14.0 - second * third * 3.0 / 44.0
    size = np.maximum(abs(a.hi), np.maximum(abs(b.hi), abs(c.hi))) * (1 + 2.0**-20)
    # What is left of the series is below this while it is small.
    rest = np.where(size < 0.25, 3 * size**6, np.inf)
    return (series + 1.0).widened(rest) / middle.sqrt()
