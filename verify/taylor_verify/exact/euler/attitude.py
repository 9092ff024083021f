"""The attitude of a rigid body turning freely: R(t) takes body components to space components.

Legend as in orbit; h = H/|H| in the principal axes (a, b, c), rho^2 = h_a^2 + h_b^2. The reference
axis is c, the cn axis: h stays away from it on every orbit, so that rho never vanishes. With
B(t) the rotation that takes h to axis 3 and c into the plane of axes 2 and 3,

    R(t) = R0 P B(0)^T Rz(psi) B(t) P^T,        P = [e_a e_b e_c],
    psi' = |H| (J_a w_a^2 + J_b w_b^2)/(J_a^2 w_a^2 + J_b^2 w_b^2)
         = |H|/J_a + |H| (J_a - J_c)/(J_a J_c) nu sn^2/(1 + nu sn^2),

    nu = J_c C/(J_a A), all terms of one sign, and an elliptic integral of the third kind.
"""

from __future__ import annotations

from fractions import Fraction

from mpmath import mp, mpf

from taylor_verify.exact.elliptic import Triple
from taylor_verify.exact.euler.orbit import Orbit
from taylor_verify.exact.euler.regime import FreeSpin
from taylor_verify.exact.frames import Frame, product, transposed


class Triaxial:
    """omega and R of a body with three different moments, the separatrix included."""

    def __init__(self, spin: FreeSpin) -> None:
        self._orbit = orbit = Orbit(spin)
        J_a, _, J_c = orbit.moments
        a_a, _, a_c = orbit.amplitudes
        self._momentum = mp.sqrt(mp.convert(spin.momentum_squared))
        self._nu = (J_c * a_c / (J_a * a_a)) ** 2
        self._steady = self._momentum / J_a
        self._bend = self._momentum * orbit.gap / (J_a * J_c * orbit.rate) * self._nu
        self._axes = [list(axis) for axis in orbit.axes]
        if not orbit.on_separatrix:
            self._complete = mp.elliprj(0, orbit.m_prime, 1, 1 + self._nu) / 3
        start = orbit.functions(mpf(0))
        self._at_start = self._integral(mpf(0), start)
        self._tilted_back = product(transposed(self._axes), transposed(self._tilt(start)))

    def at(self, t: Fraction, turned: bool) -> tuple[list[mpf], Frame]:
        """omega in body axes, and the rotation since the start, at the precision of the set-up."""
        time = mp.convert(t)
        functions = self._orbit.functions(time)
        omega = self._orbit.omega(functions)
        if not turned:
            return omega, []
        grown = self._integral(time, functions) - self._at_start
        cos, sin = mp.cos_sin(self._steady * time + self._bend * grown)
        about_momentum = [[cos, -sin, mpf(0)], [sin, cos, mpf(0)], [mpf(0), mpf(0), mpf(1)]]
        body = product(self._tilt(functions), self._axes)
        return omega, product(product(self._tilted_back, about_momentum), body)

    def _integral(self, t: mpf, functions: Triple) -> mpf:
        """int_0^u sn^2/(1 + nu sn^2) du at u = lam t + u_0, by Carlson's R_J (DLMF 19.25.14)."""
        nu, orbit = self._nu, self._orbit
        sn, cn, dn = functions
        u = orbit.rate * t + orbit.phase
        if orbit.on_separatrix:
            root = mp.sqrt(nu)
            return (u - mp.atan(root * sn) / root) / (1 + nu)
        halves = int(mp.nint(u / (2 * orbit.quarter_period)))
        reduced = -sn if halves % 2 else sn
        part = reduced**3 * mp.elliprj(cn**2, dn**2, 1, 1 + nu * sn**2) / 3 if sn else mpf(0)
        return 2 * halves * self._complete + part

    def _tilt(self, functions: Triple) -> Frame:
        """B: rows are unit vectors, the last one h, the first one normal to h and to axis c."""
        sn, cn, dn = functions
        parts = zip(self._orbit.moments, self._orbit.amplitudes, (dn, sn, cn), strict=True)
        h_a, h_b, h_c = (J * size * f / self._momentum for J, size, f in parts)
        rho = mp.hypot(h_a, h_b)
        cos, sin = h_a / rho, h_b / rho
        return [[-sin, cos, mpf(0)], [-h_c * cos, -h_c * sin, rho], [h_a, h_b, h_c]]
