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

from collections.abc import Callable, Sequence

from mpmath import mp, mpf

from taylor_verify.exact.euler.orbit import Orbit, Precession, converted
from taylor_verify.exact.euler.regime import FreeSpin, Regime
from taylor_verify.scenes import tensors
from taylor_verify.scenes.motion import Quaternion

Frame = list[list[mpf]]  # rows of a 3x3 matrix
FrameLaw = Callable[[mpf], Frame]  # time since the start -> R


def frame_law(spin: FreeSpin, attitude: Quaternion) -> FrameLaw:
    """R as a function of time, at the ambient precision; it holds only at that precision."""
    start = rotation(attitude)
    if spin.regime in (Regime.REST, Regime.SPHERICAL, Regime.STEADY):
        omega = converted(spin.omega)
        return lambda t: _product(start, _turn(omega, mp.norm(omega) * t))
    if spin.regime is Regime.AXISYMMETRIC:
        return _precession_law(spin, start)
    return _TriaxialFrame(spin, start).at


def rotation(quaternion: Quaternion) -> Frame:
    """The rotation of a quaternion of any length but zero, rational before it is rounded."""
    w, x, y, z = quaternion
    n = tensors.dot(quaternion, quaternion)
    rows = (
        (w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z),
    )
    return [[mp.convert(entry / n) for entry in row] for row in rows]


def _precession_law(spin: FreeSpin, start: Frame) -> FrameLaw:
    """R = R0 Rot(H0, |H| t/J_d) Rot(e, -Om t): a turn about the constant H, and one about the axis."""
    precession = Precession(spin)
    momentum = converted(tensors.apply(spin.inertia, spin.omega))
    rate = mp.sqrt(mp.convert(spin.momentum_squared)) / mp.convert(spin.double_moment)

    def at(t: mpf) -> Frame:
        about_momentum = _product(start, _turn(momentum, rate * t))
        return _product(about_momentum, _turn(precession.axis, -precession.rate * t))

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
        to_space = _product(start, _transposed(self._axes))
        self._to_space = _product(to_space, _transposed(self._tilt(mpf(0))))

    def at(self, t: mpf) -> Frame:
        psi = self._steady * t + self._bend * (self._integral(t) - self._at_start)
        cos, sin = mp.cos_sin(psi)
        turn = [[cos, -sin, mpf(0)], [sin, cos, mpf(0)], [mpf(0), mpf(0), mpf(1)]]
        body = _product(self._tilt(t), self._axes)
        return _product(_product(self._to_space, turn), body)

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


def _turn(axis: Sequence[mpf], angle: mpf) -> Frame:
    """The rotation about an axis of any length (Rodrigues); the identity for a zero axis."""
    length = mp.norm(axis)
    if length == 0:
        return [[mpf(int(i == j)) for j in range(3)] for i in range(3)]
    x, y, z = (component / length for component in axis)
    cos, sin = mp.cos_sin(angle)
    rest = 2 * mp.sin(angle / 2) ** 2  # 1 - cos without cancellation
    return [
        [cos + rest * x * x, rest * x * y - sin * z, rest * x * z + sin * y],
        [rest * x * y + sin * z, cos + rest * y * y, rest * y * z - sin * x],
        [rest * x * z - sin * y, rest * y * z + sin * x, cos + rest * z * z],
    ]


def _product(p: Frame, q: Frame) -> Frame:
    columns = _transposed(q)
    return [[mp.fdot(row, column) for column in columns] for row in p]


def _transposed(frame: Frame) -> Frame:
    return [list(row) for row in zip(*frame, strict=True)]
