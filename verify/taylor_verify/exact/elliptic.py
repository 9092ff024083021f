"""Jacobi's elliptic functions of a real argument, from the two complementary parameters m and m'.

Legend: m is the parameter, k = sqrt(m) the modulus; m' = 1 - m and k' = sqrt(m'); K is the quarter
period; a_n, b_n, c_n are the three sequences of the arithmetic-geometric mean (DLMF 22.20), and
k_n = c_n/a_n, k'_n = b_n/a_n the moduli of a descending Landen chain. Both parameters are taken
because each is needed to full *relative* accuracy where it is small: m' near a separatrix, m near a
stable equilibrium.
"""

from __future__ import annotations

from mpmath import mp, mpf

Triple = tuple[mpf, mpf, mpf]


class Landen:
    """The descending Landen chain of one parameter, at the precision at which it was made.

    Made once, it evaluates (sn, cn, dn) anywhere; whoever makes it allows for the log10 |u| digits
    that are lost far from the origin.
    Raises ValueError unless m >= 0 and m' > 0 (at m = 1 the functions are hyperbolic).
    """

    def __init__(self, m: mpf, m_prime: mpf) -> None:
        if not (m >= 0 and m_prime > 0):
            raise ValueError(f"expected 0 <= m and 0 < m', got {mp.nstr(m)}, {mp.nstr(m_prime)}")
        a, b, c_squared = mpf(1), mp.sqrt(m_prime), mp.convert(m)
        self._k_prime = b
        factor = mpf(1) / 2
        self._share = factor * c_squared  # 1 - E/K = sum 2^(n-1) c_n^2, DLMF 19.8.6
        self._moduli: list[tuple[mpf, mpf]] = []  # of step n: k_{n+1} and (k'_n)^2
        # At the foot of the chain sn, cn are sin, cos up to k_N^2, and a_N is the mean up to k_N^2.
        negligible = mp.ldexp(1, -mp.prec - 4)
        while c_squared > negligible * a**2:
            a_next = (a + b) / 2
            c = c_squared / (4 * a_next)  # not (a - b)/2: no difference of nearly equal numbers
            self._moduli.append((c / a_next, (b / a) ** 2))
            a, b, c_squared, factor = a_next, mp.sqrt(a * b), c**2, 2 * factor
            self._share += factor * c_squared
        self._mean = a
        self.quarter_period = mp.pi / (2 * a)

    def jacobi(self, u: mpf) -> Triple:
        """(sn, cn, dn)(u | m), by u = r + 2nK and, beyond K/2, by the argument K - |r|."""
        K = self.quarter_period
        half_turns = int(mp.nint(u / (2 * K)))
        r = u - 2 * half_turns * K
        sn, cn, dn = self._octant(abs(r)) if 2 * abs(r) <= K else self._beyond(K - abs(r))
        if r < 0:
            sn = -sn
        return (-sn, -cn, dn) if half_turns % 2 else (sn, cn, dn)

    def squared_sine(self, u: mpf) -> mpf:
        """m int_0^u sn^2 du = (1 - E/K) u - Z(u), with Jacobi's zeta function Z of the period 2K.

        Z(u) has the poles of the sum of Z1(v + i K1'/2) and Z1(v - i K1'/2), v = u/(1 + k1), to which
        the addition theorem gives Z(u) = 2/(1 + k1) [Z1(v) + k1 sn cn dn/(1 + k1 sn^2)] with sn, cn,
        dn of (v, k1). At the foot of the chain it vanishes.
        """
        K = self.quarter_period
        cn, sn = mp.cos_sin(self._mean * (u - 2 * mp.nint(u / (2 * K)) * K))
        dn, zeta = mpf(1), mpf(0)
        for k, m_prime in reversed(self._moduli):
            denominator = 1 + k * sn * sn
            zeta = 2 / (1 + k) * (zeta + k * sn * cn * dn / denominator)
            cn, sn = cn * dn / denominator, (1 + k) * sn / denominator
            dn = mp.sqrt(cn * cn + m_prime * sn * sn)
        return self._share * u - zeta

    def _beyond(self, v: mpf) -> Triple:
        """The three functions at K - v, for 0 <= v <= K/2."""
        sn, cn, dn = self._octant(v)
        return cn / dn, self._k_prime * sn / dn, self._k_prime / dn

    def _octant(self, v: mpf) -> Triple:
        """The three functions for 0 <= v <= K/2: only positive terms are added on the way up."""
        cn, sn = mp.cos_sin(self._mean * v)
        dn = unity = mpf(1)
        for k, m_prime in reversed(self._moduli):
            denominator = unity + k * sn * sn  # products, because mpf powers cost twice as much
            cn = cn * dn / denominator
            sn = (sn + k * sn) / denominator
            dn = mp.sqrt(cn * cn + m_prime * sn * sn)  # 1 - m sn^2 would cancel where m' is small
        return sn, cn, dn
