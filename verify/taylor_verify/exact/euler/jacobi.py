"""The free motion of a rigid body in mpmath: omega, and R(t) from body axes to space axes.

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
from typing import Final

from mpmath import mp, mpf

from taylor_verify.exact.elliptic import Triple
from taylor_verify.exact.euler.fixed_axis import FixedAxis, in_mpmath
from taylor_verify.exact.euler.orbit import Orbit, converted
from taylor_verify.exact.euler.regime import CONSTANT, FreeSpin, Regime
from taylor_verify.exact.euler.rotations import Rotation, decades
from taylor_verify.exact.frames import Frame, product, transposed, turn
from taylor_verify.exact.solution import Time
from taylor_verify.numbers import tensors
from taylor_verify.scenes.motion import Quaternion

# Some hundred roundings in a row, and the constants in the bounds below.
_OWN_GUARD_DIGITS: Final = 8


def free_rotation(spin: FreeSpin, attitude: Quaternion | None = None) -> Rotation:
    """The torque-free motion of any rigid body, and R from an attitude at the start."""

    regime = spin.regime
    if regime in CONSTANT:
        return in_mpmath(regime.value, FixedAxis(spin.omega), attitude)
    course = Precession if regime is Regime.AXISYMMETRIC else Triaxial
    return Rotation(
        regime.value, lambda: course(spin), lambda *until: lost_digits(spin, *until), attitude
    )


def lost_digits(spin: FreeSpin, longest: Fraction, turned: bool) -> float:
    """The decimal digits that the closed form may lose up to the time ``longest``.

    Each term is an upper bound from exact rationals. Being close to the separatrix has no term of its
    own, because m' comes from an exact difference. omega is not constant.
    """
    H2, tr, det = spin.momentum_squared, spin.trace, spin.determinant
    # The phase lam t (or the angle of precession) is reduced by whole periods, and
    # lam <= H/J_min <= H tr^2/det.
    lost = decades(1 + H2 * (longest * tr**2 / det) ** 2) / 2
    # The least moment has an absolute error of an ulp of the largest, and J_min/J_max > det/tr^3.
    lost += decades(tr**3 / det)
    # Where omega is almost steady, its weak components across the nearest principal axis are found
    # with an absolute error of an ulp of |omega|. They decide C there, or the phase at a saddle.
    across = tensors.dot(spin.torque, spin.torque) / tensors.dot(spin.omega, spin.omega) ** 2
    lost += decades(tr**2 / across) / 2
    if spin.regime is not Regime.AXISYMMETRIC and not tensors.is_diagonal(spin.inertia):
        # An eigenvector is a vector product of size gap gap', with an error of an ulp of tr^2; the
        # product of all three gaps is disc^(1/2), and the third is below tr.
        lost += decades(tr**6 / spin.discriminant) / 2
    if turned:
        # The angle is |omega| t at most.
        lost += decades(1 + tensors.dot(spin.omega, spin.omega) * longest**2) / 2
    if turned and spin.regime in (Regime.MIN_AXIS, Regime.MAX_AXIS):
        # Beside the separatrix cn^2 in R_J is small and known to an ulp of one; a quarter of the digits
        # of m' is what that was seen to cost, and the rest is the settling's.
        closeness = abs(spin.separation) / (spin.twice_energy * spin.trace) ** 3
        lost += decades(1 + 1 / closeness) / 4
    return _OWN_GUARD_DIGITS + lost


class Precession:
    """An axisymmetric body: omega turns about the axis of symmetry e at the rate Om.

    w(t) = w_par + cos(Om t) w_perp + sin(Om t) e x w_perp, Om = (J_s - J_d)(e.w)/J_d, where J_d is
    the double moment and J_s the simple one; R = R0 Rot(H0, |H| t/J_d) Rot(e, -Om t).
    """

    def __init__(self, spin: FreeSpin) -> None:
        length = mp.sqrt(mp.convert(spin.axis_squared))
        self.rate = mp.convert(spin.turning) / length
        self.axis = [entry / length for entry in converted(spin.axis)]
        across = spin.across(spin.omega)
        self._along, self._across = converted(spin.along(spin.omega)), converted(across)
        ahead = tensors.cross(spin.axis, across)
        self._ahead = [entry / length for entry in converted(ahead)]
        self._momentum = converted(spin.momentum)
        momentum = mp.sqrt(mp.convert(spin.momentum_squared))
        self._momentum_rate = momentum / mp.convert(spin.double_moment)

    def at(self, t: Time, turned: bool) -> tuple[list[mpf], Frame]:
        """omega in body axes, and the rotation since the start, at the precision of the set-up."""
        time = mp.convert(t)
        cos, sin = mp.cos_sin(self.rate * time)
        parts = zip(self._along, self._across, self._ahead, strict=True)
        omega = [along + cos * across + sin * ahead for along, across, ahead in parts]
        if not turned:
            return omega, []
        about_momentum = turn(self._momentum, self._momentum_rate * time)
        return omega, product(about_momentum, turn(self.axis, -self.rate * time))


class Triaxial:
    """A body with three different moments, the separatrix included."""

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

    def at(self, t: Time, turned: bool) -> tuple[list[mpf], Frame]:
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
