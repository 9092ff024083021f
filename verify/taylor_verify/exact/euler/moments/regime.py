"""A rigid body under a constant moment in body axes: which of its motions have a closed form.

Legend: I inertia tensor, M the moment, w omega, w0 at the start; J the moment of a body with three
equal ones; J_s, J_d the simple and the double moment of an axisymmetric body, e its axis (a unit
vector), sg = (J_s - J_d)/J_d, u = e.w. With phi = sg (u0 t + (e.M) t^2/2J_s), I w' = I w x w + M has
the solution

    three equal ones    w = w0 + (M/J) t
    axisymmetric        u = u0 + (e.M/J_s) t,
                        w_perp = Rot(e, phi) [w_perp0 + (1/J_d) int_0^t Rot(e, -phi) M_perp dt]

so phi' = sg u is the rate at which the transverse part turns. The attitude is closed where, seen from
a frame that turns with phi, omega is a straight line a + b t: for equal moments, and for a moment
along the axis, where

    R = R0 A(t) Rot(e, -phi),    A' = A [a + b t]x,    a = w_perp0 + (J_s/J_d) u0 e,    b = (e.M/J_d) e.

The double moment is rational, and so is a vector n along the axis: only its length is not.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction
from functools import cached_property
from typing import Final

from taylor_verify.exact.euler.regime import FreeSpin
from taylor_verify.exact.solution import NoClosedForm
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Matrix, Vector

# Kummer's series cancels about as many digits as this, and has a few times as many terms. Beyond it
# the moment is so weak that the body turns many times before the direction of omega has changed.
_MOST_TURNS: Final = 256
# Angles since the instant at which the spin, or omega, would be least: each of their digits is lost.
_LARGEST_ANGLE: Final = 10**600


class MomentRegime(StrEnum):
    """The loaded motions with a closed form; each value is the word printed as ``regime``."""

    SPHERICAL = "spherical-moment"  # three equal moments of inertia, any moment
    AXIAL = "axial-moment"  # two equal moments of inertia, M along the axis: a chirp
    TRANSVERSE = "transverse-moment"  # the same body, M across the axis: sines and cosines
    OBLIQUE = "oblique-moment"  # the same body, any other M: Fresnel's integrals


@dataclass(frozen=True)
class Line:
    """An angular velocity a + b t in a frame of its own, b not zero: rational vectors.

    ``across`` is the part of a normal to b, ``lead`` the time by which the nearest approach to zero
    is past at t = 0: a = across + lead b.
    """

    a: Vector
    b: Vector

    @cached_property
    def lead(self) -> Fraction:
        return tensors.dot(self.a, self.b) / self.pace

    @cached_property
    def across(self) -> Vector:
        return tensors.minus(self.a, tensors.scaled(self.lead, self.b))

    @cached_property
    def pace(self) -> Fraction:
        """|b|^2."""
        return tensors.dot(self.b, self.b)

    @cached_property
    def is_weak(self) -> bool:
        """True if b is too small beside a for Kummer's functions."""
        across = tensors.dot(self.across, self.across)
        # Squares of |across|^2/8|b|, the size of Kummer's parameter, and of |b| lead^2/2, his argument's.
        is_moderate = across**2 <= _MOST_TURNS**2 * 64 * self.pace
        return not (is_moderate and self.pace * self.lead**4 <= 4 * _LARGEST_ANGLE**2)


@dataclass(frozen=True)
class LoadedSpin:
    """Inertia tensor, moment (not zero) and omega at the start, all in body axes.

    Raises NoClosedForm, when made, where omega has none.
    """

    inertia: Matrix
    moment: Vector
    omega: Vector

    def __post_init__(self) -> None:
        if not any(self.moment):
            raise ValueError("expected a moment that is not zero, got 0 0 0 @ body.moment")
        if self.free.discriminant != 0:
            raise NoClosedForm(
                "a moment acts on a body with three different moments of inertia, and omega keeps no axis"
            )
        # The square of phi between t = 0 and the instant without spin, where that comes.
        if self.regime is MomentRegime.OBLIQUE and not (
            self.free.turning**4
            <= 16 * self.bending**2 * self.free.axis_squared * _LARGEST_ANGLE**2
        ):
            raise NoClosedForm("the part of the moment along the axis is too weak beside the spin")

    @cached_property
    def free(self) -> FreeSpin:
        """The body and its start without the moment: moments of inertia, axis n, |n| sg u0."""
        return FreeSpin(self.inertia, self.omega)

    @cached_property
    def regime(self) -> MomentRegime:
        """The kind of motion, decided in rationals."""
        if self.free.is_spherical:
            return MomentRegime.SPHERICAL
        if not any(tensors.cross(self.free.axis, self.moment)):
            return MomentRegime.AXIAL
        if tensors.dot(self.free.axis, self.moment) == 0:
            return MomentRegime.TRANSVERSE
        return MomentRegime.OBLIQUE

    @cached_property
    def bending(self) -> Fraction:
        """|n| sg (e.M)/2J_s, the quadratic coefficient of |n| phi."""
        pushed = tensors.dot(self.free.axis, self.moment)
        return self.free.ratio * pushed / (2 * self.free.simple_moment)

    @cached_property
    def push(self) -> Vector:
        """M_perp/J_d."""
        return tensors.scaled(1 / self.free.double_moment, self.free.across(self.moment))

    @property
    def half_way(self) -> Fraction:
        """s0 = turning/2 bending, where phi bends."""
        return self.free.turning / (2 * self.bending)

    def phi(self, t: Fraction) -> Fraction:
        """|n| phi."""
        return t * (self.free.turning + self.bending * t)

    def along(self, t: Fraction) -> Vector:
        """u e, rational."""
        gained = tensors.scaled(t / self.free.simple_moment, self.moment)
        return self.free.along(tensors.plus(self.omega, gained))

    @cached_property
    def line(self) -> Line:
        """The straight line a + b t that omega is for the frame A; NoClosedForm where there is none."""
        if self.regime not in (MomentRegime.SPHERICAL, MomentRegime.AXIAL):
            raise NoClosedForm(
                "the attitude of an axisymmetric body under a moment that is not along its axis"
            )
        free = self.free
        gyration = tensors.scaled(free.ratio, free.along(self.omega))
        b = tensors.scaled(1 / free.double_moment, self.moment)
        line = Line(tensors.plus(self.omega, gyration), b)
        if line.is_weak:
            raise NoClosedForm("the attitude under so weak a moment")
        return line
