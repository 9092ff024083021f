"""The wave that carries x3 between its turning points, and the integrals of x3 along it.

Legend: x3 = (z1 b + z2 w a)/(b + w a), where (a, b) = (sn^2, cn^2) if all roots of the quartic are
real and (1 - cn, 1 + cn) if two are complex; w > 0 is a ratio of root distances, u the argument, m
and m' = 1 - m the parameters, K the quarter period. Only positive terms are added in x3 and its
distances from the poles, so that nothing is lost near a pole or a separatrix.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from fractions import Fraction
from typing import final

from mpmath import mp, mpf

from taylor_verify.exact.elliptic import Landen
from taylor_verify.exact.kirchhoff.quartic import Nutation
from taylor_verify.exact.kirchhoff.regime import TurningPoints


@dataclass(frozen=True)
class Place:
    """A point of the wave: (sn, cn, dn) at the remainder u - 2 K turns, |remainder| <= K.

    ``root_a`` and ``root_b`` are signed square roots of ``a`` and ``b``. They change sign where they
    vanish, and so stay smooth in time: dx3/dt is proportional to root_a root_b dn.
    """

    u: mpf
    turns: int
    sn: mpf
    cn: mpf
    dn: mpf
    root_a: mpf
    root_b: mpf
    a: mpf
    b: mpf


class Wave(ABC):
    """The elliptic function behind x3: u = start + rate t.

    Holds numbers of one precision, and is to be used at that precision.
    """

    weight: mpf
    rate: mpf
    start: mpf
    quarters: int  # of the period 4 K of the argument, in one period of x3

    def __init__(self, m: mpf, m_prime: mpf) -> None:
        self.m = m
        self.m_prime = m_prime
        self.landen = Landen(m, m_prime)
        self.quarter_period: mpf = self.landen.quarter_period

    @final
    @property
    def period(self) -> mpf:
        """The time in which x3 swings from one turning point to the other and back."""
        return self.quarters * self.quarter_period / self.rate

    @final
    def place(self, u: mpf) -> Place:
        turns = int(mp.nint(u / (2 * self.quarter_period)))
        sn, cn, dn = self.landen.jacobi(u - 2 * turns * self.quarter_period)
        root_a, root_b = self._roots(turns, sn, cn)
        return Place(u, turns, sn, cn, dn, root_a, root_b, root_a**2, root_b**2)

    @final
    def _begin(self, nutation: Nutation, points: TurningPoints) -> mpf:
        """The argument of the start."""
        risen, left = mp.convert(nutation.z - points.z1), mp.convert(points.z2 - nutation.z)
        return self._argument(risen, self.weight * left, nutation.speed)

    @abstractmethod
    def _argument(self, risen: mpf, left: mpf, speed: Fraction) -> mpf:
        """The u with a : b = risen : left, positive where x3 rises."""

    @abstractmethod
    def _roots(self, turns: int, sn: mpf, cn: mpf) -> tuple[mpf, mpf]:
        """root_a and root_b, from sn and cn at the remainder."""

    @abstractmethod
    def integral(self, beta: mpf) -> SquareIntegral | CosineIntegral:
        """int_0^u a/(b + beta a) du, for beta > 0."""


@final
class SquareIntegral:
    """int_0^u sn^2/(cn^2 + nu sn^2) du = sn^3 R_J(cn^2, dn^2, 1, cn^2 + nu sn^2)/3, for nu > 0.

    This is (Pi(1 - nu; u) - u)/(1 - nu), DLMF 19.25.14, without its cancellation and its pole.
    """

    def __init__(self, nu: mpf, m_prime: mpf) -> None:
        self._nu = nu
        self._complete = mp.elliprj(0, m_prime, 1, nu) / 3

    def at(self, place: Place) -> mpf:
        sn, cn, dn = place.sn, place.cn, place.dn
        whole = 2 * place.turns * self._complete
        if sn == 0:
            return whole
        divisor = cn**2 + self._nu * sn**2
        return whole + sn**3 * mp.elliprj(cn**2, dn**2, 1, divisor) / 3


@final
class SquareWave(Wave):
    """All roots real: (a, b) = (sn^2, cn^2); x3 has the period 2K."""

    quarters = 2

    def __init__(self, nutation: Nutation, points: TurningPoints) -> None:
        z1, z2, z3, z4 = points.z1, points.z2, points.z3, points.z4
        lengths = _gap(z2, z3) * _gap(z4, z1)
        from_3, from_4 = _gap(z1, z3) / _gap(z2, z3), _gap(z4, z2) / _gap(z4, z1)
        m = (z2 - z1) * _gap(z4, z3) / lengths
        super().__init__(mp.convert(m), mp.convert(from_3 * from_4))
        self.weight = mp.convert(from_3)
        self.rate = mp.sqrt(mp.convert(abs(nutation.f[0] * lengths))) / 2
        self.start = self._begin(nutation, points)

    def _argument(self, risen: mpf, left: mpf, speed: Fraction) -> mpf:
        """u in [-K, K] with sn^2 : cn^2 = risen : left, positive where x3 rises."""
        total = risen + left
        sn = mp.sqrt(risen / total) * (-1 if speed < 0 else 1)
        dn_squared = (left + self.m_prime * risen) / total
        return sn * mp.elliprf(left / total, dn_squared, 1)

    def _roots(self, turns: int, sn: mpf, cn: mpf) -> tuple[mpf, mpf]:
        return (-sn, -cn) if turns % 2 else (sn, cn)

    def integral(self, beta: mpf) -> SquareIntegral:
        return SquareIntegral(beta, self.m_prime)


def _gap(a: Fraction | None, b: Fraction | None) -> Fraction:
    """a - b; 1 where a root is infinite, for it stands above and below the line alike."""
    return Fraction(1) if a is None or b is None else a - b


@final
class CosineWave(Wave):
    """Two roots complex, middle +- i n: (a, b) = (1 - cn, 1 + cn); x3 has the period 4K.

    A and B are the distances of the pair from z2 and z1; their product enters the modulus through
    A B +- [(z1-middle)(z2-middle) + n^2], of which the smaller is n^2 (z2-z1)^2 over the larger.
    """

    quarters = 4

    def __init__(self, nutation: Nutation, points: TurningPoints) -> None:
        assert points.pair is not None
        z1, z2 = points.z1, points.z2
        middle, n_squared = points.pair
        from_2 = mp.sqrt(mp.convert((z2 - middle) ** 2 + n_squared))
        from_1 = mp.sqrt(mp.convert((z1 - middle) ** 2 + n_squared))
        area = from_1 * from_2
        inner = (z1 - middle) * (z2 - middle) + n_squared
        larger = area + abs(mp.convert(inner))
        smaller = mp.convert(n_squared * (z2 - z1) ** 2) / larger
        parameters = (smaller / (2 * area), larger / (2 * area))
        super().__init__(*(parameters if inner >= 0 else parameters[::-1]))
        self.weight = from_1 / from_2
        self.rate = mp.sqrt(abs(mp.convert(nutation.f[0])) * area)
        self.start = self._begin(nutation, points)

    def _argument(self, risen: mpf, left: mpf, speed: Fraction) -> mpf:
        """u in [-2K, 2K] with 1 - cn : 1 + cn = risen : left, positive where x3 rises."""
        total = risen + left
        sign = -1 if speed < 0 else 1
        cn, sn = (left - risen) / total, 2 * mp.sqrt(risen * left) / total
        acute = sn * mp.elliprf(cn**2, cn**2 + self.m_prime * sn**2, 1)
        return sign * (acute if cn >= 0 else 2 * self.quarter_period - acute)

    def _roots(self, turns: int, sn: mpf, cn: mpf) -> tuple[mpf, mpf]:
        # Like the sine and the cosine of half an angle, sqrt(1 - cn) and sqrt(1 + cn) change sign
        # where they vanish and exchange their roles from one multiple of 2K to the next.
        near = mp.sqrt(1 + cn)
        far = sn / near
        return ((far, near), (near, -far), (-far, -near), (-near, far))[turns % 4]

    def integral(self, beta: mpf) -> CosineIntegral:
        return CosineIntegral(beta, self.m, self.m_prime)


@final
class CosineIntegral:
    """int_0^u (1 - cn)/((1 + cn) + beta (1 - cn)) du, for beta > 0.

    The divisor times its conjugate in cn is 4 beta (1 + kappa sn^2); the integral falls into a part
    even in cn, of the third kind, and one odd in cn, an arc tangent of sn/dn, which is periodic.
    """

    def __init__(self, beta: mpf, m: mpf, m_prime: mpf) -> None:
        kappa = (1 - beta) ** 2 / (4 * beta)
        self._beta = beta
        self._even = SquareIntegral((1 + beta) ** 2 / (4 * beta), m_prime)
        self._root = mp.sqrt(m + kappa)

    def at(self, place: Place) -> mpf:
        beta = self._beta
        even = place.u - (1 - beta**2) / (4 * beta) * self._even.at(place)
        sn = -place.sn if place.turns % 2 else place.sn
        odd = mp.atan(self._root * sn / place.dn) / self._root
        return (even - odd) / (2 * beta)


@final
class Rise:
    """Z of space.py along a wave; to be used at one precision.

    Its rate has no residue at the poles of z, whatever the body is: Z is an integral of the second
    kind. With n = 1 - w, j = 4/quarters, a0 = r (p' - p) and 4 a1 = 2 r (q' - q) y3,

        a0 z^2 + 2 a1 z = a0 z1^2 + 2 a1 z1 - (j rate)^2 n/2
                          + j rate d/dt [n root_a root_b dn/(b + w a) + m int sn^2 du].
    """

    def __init__(self, nutation: Nutation, z1: Fraction, wave: Wave, scale: mpf) -> None:
        """``scale`` is r F."""
        self._wave, self._bend = wave, 1 - wave.weight
        pace = 4 * wave.rate / wave.quarters
        self._linear = (mp.convert(nutation.drift(z1)) - pace**2 * self._bend / 2) / scale
        self._pace = pace / scale
        self._at_start = self._swung(wave.place(wave.start))

    def at(self, t: mpf, place: Place) -> mpf:
        """Z at the time t, when the wave is there."""
        return self._linear * t + self._pace * (self._swung(place) - self._at_start)

    def _swung(self, place: Place) -> mpf:
        size = place.b + self._wave.weight * place.a
        periodic = self._bend * place.root_a * place.root_b * place.dn / size
        return periodic + self._wave.landen.squared_sine(place.u)
