"""The functions of time of a free orbit, in balls: sn, cn, dn and the phase psi.

Legend as in moduli; K and K' the quarter periods, tau = iK'/K, q = e^{i pi tau}, and theta_i(v) are
Jacobi's functions of v = u/2K, theta_1(v) = 2 q^(1/4) (sin pi v - q^2 sin 3 pi v + ...). The angle
psi of the body about H, seen from axis c, obeys
    psi' = |H| (J_a w_a^2 + J_b w_b^2)/(J_a^2 w_a^2 + J_b^2 w_b^2),  psi(0) = 0,
and is linear in t but for the argument of a theta quotient (Jacobi, Sur la rotation d'un corps).
"""

from __future__ import annotations

from functools import cached_property

from flint import acb, arb

from taylor_verify.exact.balls import sign
from taylor_verify.exact.euler.moduli import Moduli, Triple


class Periodic:
    """Orbits about an axis: elliptic functions from theta functions, the start by addition.

    The addition theorem is that of theta functions, without a quotient:
    sn(u + v) (cn^2 u + sn^2 u dn^2 v) = sn u cn v dn v + sn v cn u dn u and so on (DLMF 22.8), times
    theta_4(v)^2; the bracket is a sum of squares.
    """

    def __init__(self, moduli: Moduli) -> None:
        self._moduli = moduli
        k, k_prime = moduli.m.sqrt(), moduli.m_prime.sqrt()
        mean, mean_prime = arb(1).agm(k_prime), arb(1).agm(k)
        self._K = arb.pi() / (2 * mean)
        self._tau = acb(0, mean / mean_prime)
        self._speed = moduli.rate / (2 * self._K)
        # sn, cn, dn are these multiples of theta_1, theta_2, theta_3 over theta_4.
        S, C, N = 1 / k.sqrt(), (k_prime / k).sqrt(), k_prime.sqrt()
        dn, sn, cn = moduli.functions
        self._squares = cn * cn, (sn * N) * (sn * N)  # of theta_4^2 and theta_3^2
        self._dn = dn * N, -moduli.m * sn * cn * S * C  # of theta_3 theta_4 and theta_1 theta_2
        self._sn = sn * C * N, S * cn * dn  # of theta_2 theta_3 and theta_1 theta_4
        self._cn = cn * C, -sn * dn * S * N  # of theta_2 theta_4 and theta_1 theta_3

    def at(self, t: arb) -> Triple:
        """(dn, sn, cn) of lam t + u_0."""
        p, q, r, s = (theta.real for theta in self._thetas(acb(self._turns(t))))
        cn2, sn2 = self._squares
        whole = 1 / (cn2 * (s * s) + sn2 * (r * r))
        return (
            (self._dn[0] * (r * s) + self._dn[1] * (p * q)) * whole,
            (self._sn[0] * (q * r) + self._sn[1] * (p * s)) * whole,
            (self._cn[0] * (q * s) + self._cn[1] * (p * r)) * whole,
        )

    def phase(self, t: arb, functions: Triple) -> tuple[arb, arb]:
        """(cos psi, sin psi) by e^{i psi} = e^{i Om t} theta_1(z)/theta_1(z_0) over its modulus.

        Where sig < 0, psi is the negative of the argument of the quotient.
        """
        rate, z0 = self._drift
        whole = self._thetas(z0 + self._turns(t))[0] * self._unwound
        return _on_circle(whole, self._moduli.sense, rate * t)

    @cached_property
    def _unwound(self) -> acb:
        return self._thetas(self._drift[1])[0].conjugate()

    def _turns(self, t: arb) -> arb:
        """lam t/2K less an even whole number, so about -1..1; whichever number, it is a period."""
        v = self._speed * t
        return v - 2 * (v.mid() / 2).floor()

    def _thetas(self, z: acb) -> tuple[acb, acb, acb, acb]:
        return acb.modular_theta(z, self._tau)

    @cached_property
    def _drift(self) -> tuple[arb, acb]:
        """Om, and z_0 = (u_0 + i beta)/2K with sc(beta | m') = nu^(-1/2)."""
        moduli, nu = self._moduli, self._moduli.nu
        beta = _carlson(nu, nu + moduli.m, nu + 1)
        y = acb(0, beta / (2 * self._K))
        slope = acb.modular_theta(y, self._tau, 1)[0] / self._thetas(y)[0]
        bend = (acb(0, 1) * slope).real * self._speed * moduli.sense
        return moduli.momentum / moduli.moments[0] + bend, acb(self._start() / (2 * self._K)) + y

    def _start(self) -> arb:
        """u_0 up to whole periods 4K, by the inverse of sn, or of sn at half the argument."""
        dn, sn, cn = self._moduli.functions
        if cn > 0:
            return sn * _carlson(cn * cn, dn * dn, arb(1))
        if cn < 0:
            return 2 * self._K - sn * _carlson(cn * cn, dn * dn, arb(1))
        # Near a quarter period; here |u_0| < 2K and sn is near +1 or -1.
        sine = ((1 - cn) / (1 + dn)).sqrt() * sign(sn)
        both = cn + dn
        return 2 * sine * _carlson(both / (1 + dn), both / (1 + cn), arb(1))


class Separatrix:
    """The orbits between: m = 1, hyperbolic functions, and a phase that is algebraic in sn."""

    def __init__(self, moduli: Moduli) -> None:
        self._moduli = moduli
        self._root = moduli.nu.sqrt()
        # psi' tends to the rate about axis b, for there 2T J_b = H^2.
        self._rate = moduli.momentum / moduli.moments[1]
        self._unwound = self._bounded(moduli.functions).conjugate()

    def at(self, t: arb) -> Triple:
        """(dn, sn, cn) of lam t + u_0."""
        _, sn, cn = self._moduli.functions
        u = self._moduli.rate * t
        S, C = u.tanh(), u.sech()
        C2, cn2 = C * C, cn * cn
        whole = 1 / (cn2 + sn * sn * C2)
        falling = cn * C * (1 - sn * S) * whole
        return falling, (sn * C2 + S * cn2) * whole, falling

    def phase(self, t: arb, functions: Triple) -> tuple[arb, arb]:
        """(cos psi, sin psi); psi = |H| t/J_b - sig [atan(nu^(1/2) sn)] from the start to t."""
        whole = self._bounded(functions) * self._unwound
        return _on_circle(whole, self._moduli.sense, self._rate * t)

    def _bounded(self, functions: Triple) -> acb:
        return acb(1, -self._root * functions[1])


def _on_circle(factor: acb, sense: int, angle: arb) -> tuple[arb, arb]:
    """Cosine and sine of ``angle`` plus ``sense`` times the argument of ``factor``."""
    x, y = factor.real, factor.imag * sense
    size = (x * x + y * y).rsqrt()
    sin, cos = angle.sin_cos()
    return (cos * x - sin * y) * size, (sin * x + cos * y) * size


def _carlson(x: arb, y: arb, z: arb) -> arb:
    """Carlson's R_F of positive numbers."""
    return acb.elliptic_rf(acb(x), acb(y), acb(z)).real
