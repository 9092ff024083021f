"""The angular velocity and attitude of a rigid body turning freely, in closed form."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

import numpy as np
from mpmath import mp, mpf

from taylor_verify.exact.euler.attitude import FrameLaw, frame_law
from taylor_verify.exact.euler.orbit import Orbit, Precession, converted
from taylor_verify.exact.euler.regime import FreeSpin, Regime
from taylor_verify.exact.euler.top import top
from taylor_verify.exact.solution import NoClosedForm, Quantities, Settled, Solution
from taylor_verify.scenes import tensors
from taylor_verify.scenes.motion import Quaternion
from taylor_verify.scenes.precision import floor_log2
from taylor_verify.scenes.scene import Scene

Law = Callable[[mpf], list[mpf]]  # time since the start -> omega in body axes

_CONSTANT = (Regime.REST, Regime.SPHERICAL, Regime.STEADY)

# Some hundred roundings in a row, and the constants in the bounds below.
_OWN_GUARD_DIGITS = 8
# Working precisions are multiples of this, so that batches of samples share one set-up; it is less
# than SETTLING_STEP_DIGITS, so that two evaluations that are compared never share theirs.
_PRECISION_STEP = 10


def closed_form(scene: Scene) -> Solution:
    """The closed form of a torque-free scene, attitude included where it is tracked.

    Raises NoClosedForm for a constant moment.
    """
    body, start = top(scene)
    if not body.is_free:
        raise NoClosedForm("a moment acts on the body")
    attitude = start.attitude if "attitude" in scene.track else None
    return FreeRotation(FreeSpin(body.inertia, start.omega), attitude)


class FreeRotation(Settled):
    """The torque-free motion of any rigid body: omega(t) in body axes, and R(t) from a start."""

    route = "mpmath"

    def __init__(self, spin: FreeSpin, attitude: Quaternion | None = None) -> None:
        self.spin = spin
        self.regime = spin.regime.value
        self._attitude = attitude
        self._laws: dict[int, tuple[Law, FrameLaw | None]] = {}

    def evaluate(self, elapsed: Sequence[Fraction], digits: int) -> Quantities:
        """``omega`` (n, 3) and ``attitude`` (n, 3, 3), to about ``digits`` significant digits."""
        longest = max((abs(t) for t in elapsed), default=Fraction(0))
        guard = guard_digits(self.spin, longest)
        if self._attitude is not None:
            guard += turning_digits(self.spin, longest)
        working = math.ceil((digits + guard) / _PRECISION_STEP) * _PRECISION_STEP
        with mp.workdps(working):
            omega, frame = self._law(working)
            times = [mp.convert(t) for t in elapsed]
            found: dict[str, np.ndarray[Any, Any]] = {}
            found["omega"] = np.array([omega(t) for t in times], dtype=object).reshape(-1, 3)
            if frame is not None:
                frames = np.array([frame(t) for t in times], dtype=object)
                found["attitude"] = frames.reshape(-1, 3, 3)
        with mp.workdps(digits):
            return {name: +values for name, values in found.items()}

    def period(self, digits: int) -> mpf | None:
        """The period of omega in body axes, to about ``digits`` digits; None where it has none."""
        return self.elements(digits).get("period")

    def elements(self, digits: int) -> dict[str, mpf]:
        """The numbers of the orbit: period, rate lam, parameter m = k^2 and m_prime = 1 - k^2."""
        with mp.workdps(digits + math.ceil(guard_digits(self.spin, Fraction(0)))):
            if self.spin.regime in _CONSTANT:
                return {}
            if self.spin.regime is Regime.AXISYMMETRIC:
                rate = abs(Precession(self.spin).rate)
                return {"period": 2 * mp.pi / rate, "rate": rate}
            orbit = Orbit(self.spin)
            found = {"rate": orbit.rate, "m": orbit.m, "m_prime": orbit.m_prime}
            return found if orbit.period == mp.inf else {"period": orbit.period, **found}

    def _law(self, working: int) -> tuple[Law, FrameLaw | None]:
        """The motion set up at the ambient precision, which is ``working`` digits."""
        if working not in self._laws:
            frame = frame_law(self.spin, self._attitude) if self._attitude is not None else None
            self._laws[working] = (law(self.spin), frame)
        return self._laws[working]


def law(spin: FreeSpin) -> Law:
    """omega as a function of time, at the ambient precision; it holds only at that precision."""
    if spin.regime in _CONSTANT:
        omega = converted(spin.omega)
        return lambda t: omega
    if spin.regime is Regime.AXISYMMETRIC:
        return Precession(spin).omega
    return Orbit(spin).omega


def guard_digits(spin: FreeSpin, longest: Fraction) -> float:
    """How many decimal digits the closed form may lose up to the time ``longest``.

    Each term is an upper bound from exact rationals; for a constant omega nothing is lost. Being
    close to the separatrix has no term of its own, because m' comes from an exact difference.
    """
    if spin.regime in _CONSTANT:
        return 0
    H2, tr, det = spin.momentum_squared, spin.trace, spin.determinant
    # The phase lam t (or the angle of precession) is reduced by whole periods, and
    # lam <= H/J_min <= H tr^2/det.
    lost = _decades(1 + H2 * (longest * tr**2 / det) ** 2) / 2
    # The least moment has an absolute error of an ulp of the largest, and J_min/J_max > det/tr^3.
    lost += _decades(tr**3 / det)
    # Where omega is almost steady, its weak components across the nearest principal axis are found
    # with an absolute error of an ulp of |omega|. They decide C there, or the phase at a saddle.
    across = tensors.dot(spin.torque, spin.torque) / tensors.dot(spin.omega, spin.omega) ** 2
    lost += _decades(tr**2 / across) / 2
    if spin.regime is not Regime.AXISYMMETRIC and not tensors.is_diagonal(spin.inertia):
        # An eigenvector is a vector product of size gap gap', with an error of an ulp of tr^2; the
        # product of all three gaps is disc^(1/2), and the third is below tr.
        lost += _decades(tr**6 / spin.discriminant) / 2
    return _OWN_GUARD_DIGITS + lost


def turning_digits(spin: FreeSpin, longest: Fraction) -> float:
    """How many digits more the attitude may lose: those of the angle turned, and of R_J.

    The angle is |omega| t at most. Beside the separatrix cn^2 in R_J is small and known to an ulp of
    one; a quarter of the digits of m' is what that was seen to cost, and the rest is the settling's.
    """
    if not any(spin.omega):
        return 0
    turned = tensors.dot(spin.omega, spin.omega) * longest**2
    lost = _decades(1 + turned) / 2
    if spin.regime in (Regime.MIN_AXIS, Regime.MAX_AXIS):
        closeness = abs(spin.separation) / (spin.twice_energy * spin.trace) ** 3
        lost += _decades(1 + 1 / closeness) / 4
    return lost


def _decades(ratio: Fraction) -> float:
    """An upper bound of log10(ratio), for a positive ratio of any size."""
    return (floor_log2(ratio) + 1) * math.log10(2)
