"""The attitudes of many free rigid bodies at once, in balls about pairs of doubles.

The formulas are those of phase and theta for one body: with the angle psi of the body about H and the
tilt B,

    R(t) = R(0) P B(0)^T Rz(psi) B(t) P^T,

and e^(i psi) is e^(i Om t) theta_1(z)/theta_1(z_0) over its modulus.

All of it is written in quaternions of any length, which are made unit ones at the end: half the angle of
a vector (x, y) is that of (x + |(x, y)|, y), and no quotient is taken before. With w = pi Re z and
eta = pi Im z, theta_1(z) is the sum over k of

    (-1)^k q^(k(k+1)) [sin (2k+1)w cosh (2k+1)eta + i cos (2k+1)w sinh (2k+1)eta].
"""

from __future__ import annotations

from typing import Any, Final, NamedTuple, final

import numpy as np

from taylor_verify.exact.euler.series import carlson, exponential, sine_cosine
from taylor_verify.exact.rotation import conjugate, product
from taylor_verify.scenes.pairs import Floats, Pairs

# The terms of theta_1 that are balls, and those in doubles.
_BALLS: Final = 4
_ALL: Final = 9
_UNIT: Final = 2.0**-53


class Numbers(NamedTuple):
    """The numbers of n orbits that their turns are made of: arrays (n) of balls, and signs (n).

    ``functions`` are dn, sn, cn at the start, ``mean`` is agm(1, k'), ``speed`` lam agm(1, k'), ``steady``
    |H|/J_a. ``start`` is H along a, b, c, whose ``axes`` (3, n) and ``signs`` are those in the body.
    """

    functions: tuple[Pairs, Pairs, Pairs]
    mean: Pairs
    nome: Pairs
    m: Pairs
    nu: Pairs
    speed: Pairs
    steady: Pairs
    momentum: Pairs
    start: tuple[Pairs, Pairs, Pairs]
    sense: Floats
    signs: tuple[Floats, Floats, Floats]
    axes: Any


@final
class Turning(NamedTuple):
    """The turn of n bodies since their starts: columns (n, 1)."""

    sine: Pairs
    cosine: Pairs
    real: _Series
    imaginary: _Series
    start_half_turn: tuple[Pairs, Pairs]
    half_rate: Pairs
    sense: Floats
    momentum: Pairs
    images: list[list[Pairs]]
    attitude: Pairs

    def at(self, times: Floats, frame: list[Pairs], sine: Pairs, cosine: Pairs) -> Pairs:
        """Return unit quaternions (4, n, m), by H along a, b, c and the sine and cosine of lam agm t."""
        angle = sine * self.cosine + cosine * self.sine, cosine * self.cosine - sine * self.sine
        x, y = _half(*_bounded(self.real, self.imaginary, *angle))
        x0, y0 = self.start_half_turn
        x, y = x * x0 + y * y0, (y * x0 - x * y0).scaled(self.sense)
        s, c = sine_cosine(self.half_rate * times)
        cos, sin = c * x - s * y, s * x + c * y
        w, i, j, k = _tilt(frame, self.momentum)
        rows = [cos * w - sin * k, cos * i - sin * j, cos * j + sin * i, cos * k + sin * w]
        entries = [_dot([image[n] for image in self.images], rows) for n in range(4)]
        size = 1.0 / _dot(entries, entries).sqrt()
        parts = [entry * size for entry in entries]
        quaternion = Pairs(*(np.stack([getattr(p, name) for p in parts]) for name in _PARTS))
        start = Pairs(
            *(np.broadcast_to(p, np.shape(self.attitude.hi))[:, :, None] for p in self.attitude)
        )
        return start.chosen(times == 0, quaternion)


_PARTS: Final = ("hi", "lo", "rad")


class _Series(NamedTuple):
    """sum over k of a_k sin (2k+1)w / sin w in terms of u = 2 cos 2w and e = 1 + 2 cos 4w, and its rest."""

    constant: Pairs
    by_u: Pairs
    by_e: Pairs
    by_both: Pairs
    rest: list[Floats]


def turning(numbers: Numbers, attitude: Pairs) -> Turning:
    """Return the turns of bodies that start with these unit quaternions (4, n)."""
    dn, sn, cn = numbers.functions
    unity = Pairs(np.ones_like(sn.hi))
    sine, cosine = sine_cosine(numbers.mean * (sn * carlson(cn * cn, dn * dn, unity)))
    cosine = cosine.scaled(np.where(cn.hi < 0, -1.0, 1.0))
    nu = numbers.nu
    growth = exponential(numbers.mean * carlson(nu, nu + numbers.m, nu + 1.0))
    even, odd = _coefficients(numbers.nome, growth)
    slope = _sum([c * (2.0 * k + 1) for k, c in enumerate(even)]) / _sum(odd)
    rate = numbers.steady + (numbers.speed * (slope - 1.0)).scaled(numbers.sense)
    # sin (2k+1)w / sin w, and cos (2k+1)w / cos w with every other sign turned.
    real = _series(even, 1.0)
    imaginary = _series([c.scaled((-1.0) ** k) for k, c in enumerate(odd)], -1.0)
    back = conjugate(_tilt(list(numbers.start), numbers.momentum))
    return Turning(
        sine=_column(sine),
        cosine=_column(cosine),
        real=real,
        imaginary=imaginary,
        start_half_turn=_half(*_bounded(real, imaginary, _column(sine), _column(cosine))),
        half_rate=_column(rate.scaled(0.5)),
        sense=numbers.sense[:, None],
        momentum=_column(numbers.momentum),
        images=_images(back, numbers, attitude),
        attitude=attitude,
    )


def _coefficients(nome: Pairs, growth: Pairs) -> tuple[list[Pairs], list[Pairs]]:
    """(-1)^k q^(k(k+1)) times 2 cosh (2k+1)eta, and times 2 sinh (2k+1)eta."""
    shrinkage, square = 1.0 / growth, nome * nome
    up, down, factor, power = growth, shrinkage, Pairs(np.ones_like(nome.hi)), square
    up_twice, down_twice = growth * growth, shrinkage * shrinkage
    even, odd = [], []
    for k in range(_ALL):
        sign = (-1.0) ** k
        even.append(((up + down) * factor).scaled(sign))
        odd.append(((up - down) * factor).scaled(sign))
        up, down = up * up_twice, down * down_twice
        factor, power = factor * power, power * square
    # Im z is below half of Im tau, so that e^eta is below q^(-1/2).
    rest = 8 * (2 * _ALL + 1) * nome.hi ** (_ALL * _ALL) * growth.hi
    rest = np.where(nome.hi * up_twice.hi <= 1 + 2.0**-20, rest, np.inf)
    even[0], odd[0] = even[0].widened(rest), odd[0].widened(rest)
    return even, odd


def _series(a: list[Pairs], sign: float) -> _Series:
    """The factors of 1, u, e and u e; where the ``sign`` is -1, u is turned."""
    return _Series(
        constant=_column(a[0] + a[1]),
        by_u=_column((a[1] + a[2] - a[3]).scaled(sign)),
        by_e=_column(a[2] + a[3]),
        by_both=_column(a[3].scaled(sign)),
        rest=[coefficient.hi[:, None] for coefficient in a[_BALLS:]],
    )


def _bounded(real: _Series, imaginary: _Series, sine: Pairs, cosine: Pairs) -> tuple[Pairs, Pairs]:
    """-i e^(iw) theta_1, whose real part is positive."""
    u = (1.0 - (sine * sine).scaled(2.0)).scaled(2.0)
    e = u * u - 1.0
    both = u * e
    values = []
    for series, sign in ((real, 1.0), (imaginary, -1.0)):
        total = series.constant + series.by_u * u + series.by_e * e + series.by_both * both
        rest, error = _in_doubles(series.rest, sign * u.hi)
        values.append((total + rest).widened(error))
    X, Y = sine * values[0], cosine * values[1]
    return X * sine + Y * cosine, Y * sine - X * cosine


def _in_doubles(factors: list[Floats], u: Floats) -> tuple[Any, Any]:
    """The terms from the fifth one on, sin (2k+1)w / sin w by its recurrence, and a bound of the error."""
    last, current = np.ones_like(u), u + 1
    total, error = 0.0 * u, 0.0 * u
    for k in range(1, _ALL):
        if k >= _BALLS:
            factor = factors[k - _BALLS]
            total = total + factor * current
            error = error + abs(factor) * (8 * (k + 1) ** 3 * _UNIT)
        last, current = current, u * current - last
    return total, error


def _half(x: Pairs, y: Pairs) -> tuple[Pairs, Pairs]:
    """A vector with half the angle of one in the right half plane."""
    return x + (x * x + y * y).sqrt(), y


def _tilt(frame: list[Pairs], momentum: Pairs) -> list[Pairs]:
    """The quaternion of B, of any length: B^T = Rz(al) Ry(th), with th the angle from H to c."""
    h_a, h_b, h_c = frame
    rho = (h_a * h_a + h_b * h_b).sqrt()
    cos_al, cos_th = rho + h_a, momentum + h_c
    return [cos_al * cos_th, h_b * rho, -(cos_al * rho), -(h_b * cos_th)]


def _images(back: list[Pairs], numbers: Numbers, attitude: Pairs) -> list[list[Pairs]]:
    """The quaternions R(0) P B(0)^T, by that of B(0)^T, times each of 1, i, j, k; columns."""
    a, b, c, d = back
    units = [[a, b, c, d], [-b, a, d, -c], [-c, -d, a, b], [-d, c, -b, a]]
    start = [attitude[i] for i in range(4)]
    images = []
    for scalar, *vector in units:
        along = [v.scaled(sign) for v, sign in zip(vector, numbers.signs, strict=True)]
        body = in_body(along, numbers.axes)
        image = product(start, [scalar, *(body[i] for i in range(3))])
        images.append([_column(entry) for entry in image])
    return images


def in_body(rows: list[Pairs], axes: Any) -> Pairs:
    """Return components along a, b, c in the order of the axes of the body."""
    shape = np.broadcast_shapes(*(np.shape(row.hi) for row in rows))
    back = np.argsort(axes, axis=0)[(..., *(None,) * (len(shape) - 1))]
    parts = (
        np.stack([np.broadcast_to(getattr(row, name), shape) for row in rows]) for name in _PARTS
    )
    return Pairs(*(np.take_along_axis(part, back, axis=0) for part in parts))


def _dot(p: list[Pairs], q: list[Pairs]) -> Pairs:
    return _sum([a * b for a, b in zip(p, q, strict=True)])


def _sum(terms: list[Pairs]) -> Pairs:
    total = terms[0]
    for term in terms[1:]:
        total = total + term
    return total


def _column(values: Pairs) -> Pairs:
    shape = np.shape(values.hi)
    return Pairs(*(np.broadcast_to(part, shape)[:, None] for part in values))
