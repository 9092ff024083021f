"""A body with three different moments under a constant moment: the motions with a closed form.

Legend: I inertia tensor, M the moment, w omega, w0 at the start. Let M lie along a principal axis,
I M = J M, and split w = v + nu M with v across M. With the phase sigma, sigma' = nu, sigma(0) = 0,
what is left of the equations I w' = I w x w + M across M is linear in the phase,

    dv/dsigma = B v,     B v = I^-1 ((I - J) v x M),     B^2 v = kappa v,
    kappa = |M|^2 (J (J_p + J_q) - J^2 - J_p J_q)/(J_p J_q),

with the other two moments J_p, J_q: v swings where J is the largest or the smallest of the three
(kappa < 0) and grows where it is the middle one. The work of the moment, T' = M.w = |M|^2 nu, leaves

    nu^2 = F(sigma) = nu0^2 + 2 sigma/J - (v.I v - v0.I v0)/(J |M|^2),

which is that of a bead on a tilted washboard; the time is int dsigma/nu. Let cc, ss be cos, sin of
2 Omega sigma, Omega = |kappa|^(1/2), where kappa < 0, else cosh, sinh. Then, with rational P and Q,

    F = nu0^2 + slope sigma - P (cc - 1) - Q ss/(2 Omega),     slope = 2/J.

A double root of F would be a separatrix, reached after an infinite time. There is none but at rest.
For where F and F' vanish, e^(2i Omega sigma) is algebraic by F' = 0 and sigma is so by F = 0, hence
sigma = 0 (Lindemann), and then nu = nu' = 0 at the start: w is constant.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction
from functools import cached_property

from taylor_verify.exact.euler.regime import FreeSpin
from taylor_verify.exact.solution import NoClosedForm
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Matrix, Vector


class WashboardRegime(StrEnum):
    """The motions of a triaxial body under a moment; each value is the word printed as ``regime``."""

    STEADY = "steady-moment"  # I w0 x w0 = -M: w is constant, whatever the direction of M
    STRAIGHT = "straight-moment"  # w0 and M along one principal axis: the spin grows evenly
    SWING = "washboard-swing"  # M along a principal axis: nu turns back for ever, and w recurs
    RUN = "washboard-run"  # the same, and nu changes its sign once: a spin-up


@dataclass(frozen=True)
class Washboard:
    """A tensor with three different moments, a moment (not zero) and omega at the start; body axes.

    Raises NoClosedForm, when made, where omega has none.
    """

    inertia: Matrix
    moment: Vector
    omega: Vector

    def __post_init__(self) -> None:
        if not self.is_steady and any(tensors.cross(self.moment, self._impulse)):
            raise NoClosedForm(
                "a moment that is along no principal axis acts on a body with three different "
                "moments of inertia"
            )

    @cached_property
    def is_steady(self) -> bool:
        """Return True if the gyroscopic moment balances M: omega is constant."""
        return not any(tensors.plus(self._free.torque, self.moment))

    @cached_property
    def is_straight(self) -> bool:
        """Return True if omega keeps to the axis of the moment."""
        return not any(self.across)

    @property
    def keeps_axis(self) -> bool:
        """Return True if omega keeps its direction: w = w0 + ``gain`` t."""
        return self.is_steady or self.is_straight

    @property
    def gain(self) -> Vector:
        """M/J, or 0 where omega is constant."""
        return tensors.scaled(Fraction(0) if self.is_steady else 1 / self.axial_moment, self.moment)

    @cached_property
    def _free(self) -> FreeSpin:
        return FreeSpin(self.inertia, self.omega)

    @cached_property
    def _impulse(self) -> Vector:
        """I M."""
        return tensors.apply(self.inertia, self.moment)

    @cached_property
    def moment_squared(self) -> Fraction:
        """|M|^2."""
        return tensors.dot(self.moment, self.moment)

    @cached_property
    def axial_moment(self) -> Fraction:
        """J."""
        return tensors.dot(self.moment, self._impulse) / self.moment_squared

    @cached_property
    def nu(self) -> Fraction:
        """nu0."""
        return tensors.dot(self.moment, self.omega) / self.moment_squared

    @cached_property
    def across(self) -> Vector:
        """v0."""
        return tensors.plus(self.omega, tensors.scaled(-self.nu, self.moment))

    @cached_property
    def ahead(self) -> Vector:
        """B v0: v is cc(Omega sigma) v0 + ss(Omega sigma)/Omega B v0."""
        J, v = self.axial_moment, self.across
        rest = tensors.plus(tensors.apply(self.inertia, v), tensors.scaled(-J, v))
        return tensors.apply(tensors.inverse(self.inertia), tensors.cross(rest, self.moment))

    @cached_property
    def kappa(self) -> Fraction:
        """The square of the rate in sigma at which v swings, if negative, or grows; never zero."""
        J = self.axial_moment
        both, product = self._free.trace - J, self._free.determinant / J
        return self.moment_squared * (J * both - J**2 - product) / product

    @property
    def conserved(self) -> Fraction:
        """2T J - |H|^2 at the start, conserved: M.w and M.I w grow in proportion."""
        return self._free.twice_energy * self.axial_moment - self.momentum_squared

    @property
    def momentum_squared(self) -> Fraction:
        """|H|^2 at the start."""
        return self._free.momentum_squared

    @property
    def slope(self) -> Fraction:
        """2/J, the tilt of the washboard."""
        return 2 / self.axial_moment

    @cached_property
    def even(self) -> Fraction:
        """P."""
        v, u = self.across, self.ahead
        work = self._work(v, v) + self._work(u, u) / self.kappa
        return work / 2

    @cached_property
    def odd(self) -> Fraction:
        """Q."""
        return 2 * self._work(self.across, self.ahead)

    @property
    def push(self) -> Fraction:
        """F'(0) = 2 nu'(0)."""
        return self.slope - self.odd

    @property
    def tilt_squared(self) -> Fraction:
        """slope^2 - |4 kappa| P^2 - Q^2: where kappa < 0 and this is not negative, F has no minimum."""
        return self.slope**2 + 4 * self.kappa * self.even**2 - self.odd**2

    @property
    def never_climbs(self) -> bool:
        """Return True if kappa > 0 and the part of v that grows with sigma is zero, exactly."""
        return self.kappa > 0 and self.odd**2 == 4 * self.kappa * self.even**2 and self.odd <= 0

    def _work(self, a: Vector, b: Vector) -> Fraction:
        """a.I b/(J |M|^2)."""
        product = tensors.dot(a, tensors.apply(self.inertia, b))
        return product / (self.axial_moment * self.moment_squared)
