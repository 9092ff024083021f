"""A rigid body turning freely: its exact invariants, and the kind of orbit they decide.

Legend: I inertia tensor, w = omega at the start, H = I w, 2T = w.I w; J1 >= J2 >= J3 the principal
moments, the roots of p(x) = det(x - I) = x^3 - (tr I) x^2 + (minors) x - det I; r = H^2/2T, which
lies between J3 and J1. Everything is rational, so every decision is final.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction
from functools import cached_property
from typing import Final

from taylor_verify.exact.spectrum import Cubic
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Matrix, Vector


class Regime(StrEnum):
    """The kinds of torque-free motion; each value is the word printed as ``regime``."""

    REST = "rest"  # w = 0
    SPHERICAL = "spherical"  # J1 = J2 = J3: w is constant
    STEADY = "steady"  # a permanent rotation about any principal axis, stable or not
    AXISYMMETRIC = "axisymmetric"  # two equal moments: w precesses uniformly about the third axis
    SEPARATRIX = "separatrix"  # H^2 = 2T J2: hyperbolic functions
    MAX_AXIS = "max-axis"  # H^2 > 2T J2: the orbit encircles the axis of J1
    MIN_AXIS = "min-axis"  # H^2 < 2T J2: the orbit encircles the axis of J3


CONSTANT: Final = (Regime.REST, Regime.SPHERICAL, Regime.STEADY)


@dataclass(frozen=True)
class FreeSpin:
    """The inertia tensor and the angular velocity at the start, both in body axes."""

    inertia: Matrix
    omega: Vector

    @cached_property
    def cubic(self) -> Cubic:
        """p."""
        return Cubic.of(self.inertia)

    @property
    def trace(self) -> Fraction:
        return self.cubic.trace

    @property
    def determinant(self) -> Fraction:
        return self.cubic.determinant

    @cached_property
    def momentum(self) -> Vector:
        """H = I w at the start, in body axes."""
        return tensors.apply(self.inertia, self.omega)

    @cached_property
    def momentum_squared(self) -> Fraction:
        return tensors.dot(self.momentum, self.momentum)

    @cached_property
    def twice_energy(self) -> Fraction:
        return tensors.dot(self.omega, self.momentum)

    @cached_property
    def torque(self) -> Vector:
        """I w' = H x w at the start: zero exactly in a permanent rotation."""
        return tensors.cross(self.momentum, self.omega)

    @cached_property
    def discriminant(self) -> Fraction:
        """((J1 - J2)(J2 - J3)(J3 - J1))^2."""
        return self.cubic.discriminant

    @cached_property
    def separation(self) -> Fraction:
        """(2T)^3 p(H^2/2T) = (H^2 - 2T J1)(H^2 - 2T J2)(H^2 - 2T J3), without a division."""
        h, t = self.momentum_squared, self.twice_energy
        trace, minors, determinant = self.cubic
        return h**3 - trace * h**2 * t + minors * h * t**2 - determinant * t**3

    @cached_property
    def is_spherical(self) -> bool:
        """True if all three moments are equal."""
        return self.cubic.spread == 0

    # Two equal moments: an axis of symmetry e. Of three equal ones every axis is one.

    @cached_property
    def double_moment(self) -> Fraction:
        """J_d, the repeated principal moment, which is always rational."""
        if self.is_spherical:
            return self.trace / 3
        return self.cubic.double_root

    @property
    def simple_moment(self) -> Fraction:
        """J_s, the moment about the axis of symmetry."""
        return self.trace - 2 * self.double_moment

    @property
    def ratio(self) -> Fraction:
        """(J_s - J_d)/J_d."""
        return (self.simple_moment - self.double_moment) / self.double_moment

    @cached_property
    def axis(self) -> Vector:
        """n, a rational vector along e: the longest column of (I - J_d)/(J_s - J_d) = e e^T."""
        if self.is_spherical:
            return (Fraction(1), Fraction(0), Fraction(0))
        double, gap = self.double_moment, self.simple_moment - self.double_moment
        # Of e e^T, the diagonal entry is the square of the column's length.
        longest = max(range(3), key=lambda i: (self.inertia[i][i] - double) / gap)
        column = enumerate(self.inertia[longest])
        return tuple((entry - double * (i == longest)) / gap for i, entry in column)

    @cached_property
    def axis_squared(self) -> Fraction:
        """|n|^2."""
        return tensors.dot(self.axis, self.axis)

    @property
    def turning(self) -> Fraction:
        """|n| Om, with Om = (e.w) (J_s - J_d)/J_d the rate at which w goes round e."""
        return self.ratio * tensors.dot(self.axis, self.omega)

    def along(self, vector: Vector) -> Vector:
        """(e.v) e, rational."""
        return tensors.scaled(tensors.dot(self.axis, vector) / self.axis_squared, self.axis)

    def across(self, vector: Vector) -> Vector:
        """v - (e.v) e, rational."""
        return tensors.minus(vector, self.along(vector))

    @cached_property
    def regime(self) -> Regime:
        """The kind of orbit. Each question assumes that the earlier ones were denied."""
        if not any(self.omega):
            return Regime.REST
        if self.is_spherical:
            return Regime.SPHERICAL
        if not any(self.torque):
            return Regime.STEADY
        if self.discriminant == 0:
            return Regime.AXISYMMETRIC
        if self.separation == 0:
            return Regime.SEPARATRIX
        return Regime.MAX_AXIS if self.separation < 0 else Regime.MIN_AXIS
