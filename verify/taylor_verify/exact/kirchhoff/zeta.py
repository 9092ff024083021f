"""Jacobi's zeta function and the integral of sn^2 along a descending Landen chain.

Legend: Z(u) = E(u) - (E/K) u has the period 2K and is odd; m = k^2, m' = 1 - m; k1 is the next
modulus of the chain, and v = u/(1 + k1) its argument. Z(u) has the poles of the sum of
Z1(v + i K1'/2) and Z1(v - i K1'/2), to which the addition theorem gives the form

    Z(u) = 2/(1 + k1) [Z1(v) + k1 sn cn dn/(1 + k1 sn^2)]     with sn, cn, dn of (v, k1).
"""

from __future__ import annotations

from typing import final

from mpmath import mp, mpf


@final
class SquaredSine:
    """m int_0^u sn^2 du = (1 - E/K) u - Z(u), at the precision at which it was made."""

    def __init__(self, m: mpf, m_prime: mpf) -> None:
        a, b, c_squared, factor = mpf(1), mp.sqrt(m_prime), +m, mpf(1) / 2
        share = factor * c_squared  # 1 - E/K = sum 2^(n-1) c_n^2, DLMF 19.8.6
        self._steps: list[tuple[mpf, mpf]] = []  # k_{n+1} and (k'_n)^2
        negligible = mp.ldexp(1, -mp.prec - 4)
        while c_squared > negligible * a**2:
            following = (a + b) / 2
            c = c_squared / (4 * following)
            self._steps.append((c / following, (b / a) ** 2))
            a, b, c_squared, factor = following, mp.sqrt(a * b), c**2, 2 * factor
            share += factor * c_squared
        self._mean = a
        self._share = share

    def at(self, u: mpf, remainder: mpf) -> mpf:
        """At u, where ``remainder`` is u less a multiple of 2K, and |remainder| <= K."""
        return self._share * u - self._zeta(remainder)

    def _zeta(self, u: mpf) -> mpf:
        """Z(u), upwards from the foot of the chain, where it vanishes."""
        cn, sn = mp.cos_sin(self._mean * u)
        dn, zeta = mpf(1), mpf(0)
        for k, m_prime in reversed(self._steps):
            divisor = 1 + k * sn * sn
            zeta = 2 / (1 + k) * (zeta + k * sn * cn * dn / divisor)
            cn, sn = cn * dn / divisor, (1 + k) * sn / divisor
            dn = mp.sqrt(cn * cn + m_prime * sn * sn)
        return zeta
