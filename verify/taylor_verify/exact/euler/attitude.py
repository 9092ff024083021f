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

from collections.abc import Callable

from mpmath import mp, mpf

from taylor_verify.exact.euler.orbit import Orbit, Precession, converted
from taylor_verify.exact.euler.regime import FreeSpin, Regime
from taylor_verify.exact.frames import Frame, product, start_frame, transposed, turn
from taylor_verify.scenes import tensors
from taylor_verify.scenes.motion import Quaternion

FrameLaw = Callable[[mpf], Frame]  # time since the start -> R


def frame_law(spin: FreeSpin, attitude: Quaternion) -> FrameLaw:
    """R as a function of time, at the ambient precision; it holds only at that precision."""
    start = start_frame(attitude)
    if spin.regime in (Regime.REST, Regime.SPHERICAL, Regime.STEADY):
        omega = converted(spin.omega)
        return lambda t: product(start, turn(omega, mp.norm(omega) * t))
    if spin.regime is Regime.AXISYMMETRIC:
        return _precession_law(spin, start)
    return _TriaxialFrame(spin, start).at


def _precession_law(spin: FreeSpin, start: Frame) -> FrameLaw:
    """R = R0 Rot(H0, |H| t/J_d) Rot(e, -Om t): a turn about the constant H, and one about the axis."""
    precession = Precession(spin)
    momentum = converted(tensors.apply(spin.inertia, spin.omega))
    rate = mp.sqrt(mp.convert(spin.momentum_squared)) / mp.convert(spin.double_moment)

    def at(t: mpf) -> Frame:
        about_momentum = product(start, turn(momentum, rate * t))
        return product(about_momentum, turn(precession.axis, -precession.rate * t))

    return at


class _TriaxialFrame:
    """R(t) of a body with three different moments, the separatrix included."""

    def __init__(self, spin: FreeSpin, start: Frame) -> None:
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
        self._at_start = self._integral(mpf(0))
        to_space = product(start, transposed(self._axes))
        self._to_space = product(to_space, transposed(self._tilt(mpf(0))))

    def at(self, t: mpf) -> Frame:
        psi = self._steady * t + self._bend * (self._integral(t) - self._at_start)
        cos, sin = mp.cos_sin(psi)
        about_momentum = [[cos, -sin, mpf(0)], [sin, cos, mpf(0)], [mpf(0), mpf(0), mpf(1)]]
        body = product(self._tilt(t), self._axes)
        return product(product(self._to_space, about_momentum), body)

    def _integral(self, t: mpf) -> mpf:
        """int_0^u sn^2/(1 + nu sn^2) du at u = lam t + u_0, by Carlson's R_J (DLMF 19.25.14)."""
        nu, orbit = self._nu, self._orbit
        sn, cn, dn = orbit.functions(t)
        u = orbit.rate * t + orbit.phase
        if orbit.on_separatrix:
            root = mp.sqrt(nu)
            return (u - mp.atan(root * sn) / root) / (1 + nu)
        halves = int(mp.nint(u / (2 * orbit.quarter_period)))
        reduced = -sn if halves % 2 else sn
        part = reduced**3 * mp.elliprj(cn**2, dn**2, 1, 1 + nu * sn**2) / 3 if sn else mpf(0)
        return 2 * halves * self._complete + part

    def _tilt(self, t: mpf) -> Frame:
        """B: rows are unit vectors, the last one h, the first one normal to h and to axis c."""
        sn, cn, dn = self._orbit.functions(t)
        parts = zip(self._orbit.moments, self._orbit.amplitudes, (dn, sn, cn), strict=True)
        h_a, h_b, h_c = (J * size * f / self._momentum for J, size, f in parts)
        rho = mp.hypot(h_a, h_b)
        cos, sin = h_a / rho, h_b / rho
        return [[-sin, cos, mpf(0)], [-h_c * cos, -h_c * sin, rho], [h_a, h_b, h_c]]
