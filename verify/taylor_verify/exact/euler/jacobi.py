"""The angular velocity and attitude of a rigid body turning freely, in closed form, in mpmath."""

from __future__ import annotations

from fractions import Fraction
from typing import Final

from taylor_verify.exact.euler.attitude import Triaxial
from taylor_verify.exact.euler.fixed_axis import FixedAxis, FixedAxisFloats
from taylor_verify.exact.euler.orbit import Precession
from taylor_verify.exact.euler.regime import CONSTANT, FreeSpin, Regime
from taylor_verify.exact.euler.rotations import Course, Rotation, decades
from taylor_verify.scenes import tensors
from taylor_verify.scenes.motion import Quaternion

# Some hundred roundings in a row, and the constants in the bounds below.
_OWN_GUARD_DIGITS: Final = 8


def free_rotation(spin: FreeSpin, attitude: Quaternion | None = None) -> Rotation:
    """The torque-free motion of any rigid body, and R from an attitude at the start."""

    def course() -> Course:
        if spin.regime in CONSTANT:
            return FixedAxisFloats(FixedAxis(spin.omega))
        return Precession(spin) if spin.regime is Regime.AXISYMMETRIC else Triaxial(spin)

    return Rotation(spin.regime.value, course, lambda *until: lost_digits(spin, *until), attitude)


def lost_digits(spin: FreeSpin, longest: Fraction, turned: bool) -> float:
    """The decimal digits that the closed form may lose up to the time ``longest``.

    Each term is an upper bound from exact rationals; of a constant omega nothing is lost. Being
    close to the separatrix has no term of its own, because m' comes from an exact difference.
    """
    if spin.regime in CONSTANT:
        return FixedAxis(spin.omega).lost(longest, turned)
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
