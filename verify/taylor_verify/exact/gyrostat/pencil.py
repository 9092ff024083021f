"""A free gyrostat: what its start decides about the orbit, in exact rationals.

Legend: I inertia tensor of body and wheels, h momentum of the wheels, w = omega at the start; K = I^-1,
g = K h, and G = I w + h the whole momentum, so that w = K G - g and

    G' = G x (K G - g),        n = G.G,        E = G.K G - 2 g.G

with n and E constant: the orbit of G is where two quadrics meet. Their pencil has the quartic
D(s) = det(K - s)(n s - E) - g.adj(K - s) g, and its invariants g2 and g3 are those of Weierstrass's p in
the time itself. Everything is rational, so every decision is final.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction
from functools import cached_property
from typing import Final

from taylor_verify.exact.euler.regime import FreeSpin
from taylor_verify.exact.kirchhoff import quartic
from taylor_verify.exact.spectrum import Cubic
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Matrix, Vector, cross, dot

# The osculating plane meets the orbit four times at most, and a constant takes two orders more.
_ORDER: Final = 6


class Regime(StrEnum):
    """The kinds of a gyrostat's free motion; each value is the word printed as ``regime``."""

    REST = "rest"  # w = 0
    STEADY = "steady"  # G x w = 0: a constant spin, stable or not
    SPHERICAL = "spherical"  # three equal moments: w turns about h
    AXISYMMETRIC = (
        "axisymmetric"  # two equal moments and h along the third axis, about which w turns
    )
    PERIODIC = "periodic"  # elliptic functions
    TRIGONOMETRIC = "trigonometric"  # the double point of the curve is not on the orbit
    SEPARATRIX = "separatrix"  # the orbit runs from a steady spin back to it: hyperbolic functions
    CUSP = "cusp"  # it does so as a power of the time: rational functions


@dataclass(frozen=True)
class FreeGyrostat:
    """The inertia tensor, the momentum of the wheels and the angular velocity at the start, body axes."""

    inertia: Matrix
    rotor: Vector
    omega: Vector

    @cached_property
    def spin(self) -> FreeSpin:
        """The body and its start without wheels."""
        return FreeSpin(self.inertia, self.omega)

    @cached_property
    def K(self) -> Matrix:
        return tensors.inverse(self.inertia)

    @cached_property
    def g(self) -> Vector:
        return tensors.apply(self.K, self.rotor)

    @cached_property
    def momentum(self) -> Vector:
        """G at the start."""
        return tensors.plus(tensors.apply(self.inertia, self.omega), self.rotor)

    @cached_property
    def n(self) -> Fraction:
        return dot(self.momentum, self.momentum)

    @cached_property
    def E(self) -> Fraction:
        G = self.momentum
        return dot(G, tensors.apply(self.K, G)) - 2 * dot(self.g, G)

    @property
    def twice_energy(self) -> Fraction:
        """2T, which is E + h.K h."""
        return dot(self.omega, tensors.apply(self.inertia, self.omega))

    @cached_property
    def cubic(self) -> Cubic:
        """The trace S of K, the sum c2 of its principal minors, and its determinant."""
        return Cubic.of(self.K)

    @cached_property
    def square(self) -> Matrix:
        """K^2."""
        return tensors.product(self.K, self.K)

    @cached_property
    def invariants(self) -> tuple[Fraction, Fraction]:
        """(g2, g3) of the quartic D = -n s^4 + b1 s^3 + b2 s^2 + b3 s + b4."""
        n, E, g = self.n, self.E, self.g
        S, c2, determinant = self.cubic
        # adj(K - s) = adj K - s (S - K) + s^2, and adj K = K^2 - S K + c2.
        gg, gKg = dot(g, g), dot(g, tensors.apply(self.K, g))
        gKKg = dot(g, tensors.apply(self.square, g))
        b1 = n * S + E
        b2 = -(n * c2 + E * S + gg)
        b3 = n * determinant + E * c2 + S * gg - gKg
        b4 = -E * determinant - (gKKg - S * gKg + c2 * gg)
        return quartic.invariants((-n, b1, b2, b3, b4))

    @cached_property
    def discriminant(self) -> Fraction:
        """g2^3 - 27 g3^2."""
        g2, g3 = self.invariants
        return g2**3 - 27 * g3**2

    @cached_property
    def double_root(self) -> Fraction:
        """The repeated root of 4 X^3 - g2 X - g3 where the discriminant is zero."""
        g2, g3 = self.invariants
        return -3 * g3 / (2 * g2) if g2 else Fraction(0)

    @cached_property
    def jet(self) -> tuple[Vector, ...]:
        """The Taylor coefficients G, G', G''/2, ... of the momentum at the start, to the sixth order."""
        momenta = [self.momentum]
        omegas = [self.omega]
        for k in range(_ORDER):
            products = [cross(G, w) for G, w in zip(momenta, reversed(omegas), strict=True)]
            total = tuple(sum(column, Fraction(0)) for column in zip(*products, strict=True))
            momenta.append(tensors.scaled(Fraction(1, k + 1), total))
            omegas.append(tensors.apply(self.K, momenta[-1]))
        return tuple(momenta)

    @cached_property
    def osculating_plane(self) -> Vector:
        """nu, normal to the plane nu.(G - G(0)) = 0 that osculates the orbit of a motion not steady."""
        return tensors.minus(self.omega, tensors.scaled(self.tangent_value, self.momentum))

    @cached_property
    def tangent_value(self) -> Fraction:
        """s = G'.K G'/G'.G': the quadric of the pencil for K - s holds the tangent at the start."""
        G1 = self.jet[1]
        return dot(G1, tensors.apply(self.K, G1)) / dot(G1, G1)

    @cached_property
    def is_circle(self) -> bool:
        """True if the orbit of G lies in a plane, which no other orbit meets more than four times."""
        return not any(dot(self.osculating_plane, derivative) for derivative in self.jet[1:])

    @cached_property
    def regime(self) -> Regime:
        """The kind of motion. The order matters: each question assumes the earlier ones denied."""
        if not any(self.omega):
            return Regime.REST
        if not any(cross(self.momentum, self.omega)):
            return Regime.STEADY
        if self._precession is not None:
            return Regime.SPHERICAL if self.spin.is_spherical else Regime.AXISYMMETRIC
        if self.discriminant:
            return Regime.PERIODIC
        if not self.double_root:
            return Regime.CUSP
        return Regime.SEPARATRIX if self.double_root > 0 else Regime.TRIGONOMETRIC

    # Uniform turnings: R = R(0) Rot(u t) Rot(-v t), and w = Rot(v t) w(0).

    @property
    def outer(self) -> Vector | None:
        """u, in the body's axes at the start; None for any other motion."""
        if not any(cross(self.momentum, self.omega)):
            return self.omega
        if self._precession is None:
            return None
        return tensors.scaled(1 / self.spin.double_moment, self.momentum)

    @property
    def inner(self) -> Vector:
        """v, zero for a steady motion."""
        if self._precession is None or not any(cross(self.momentum, self.omega)):
            return tensors.ZERO_VECTOR
        return self._precession

    @cached_property
    def _precession(self) -> Vector | None:
        """v where equal moments make it constant: h/J, or along the axis of an axisymmetric body.

        None for three different moments, and for wheels that do not turn about the axis.
        """
        spin = self.spin
        if spin.is_spherical:
            return self.g
        if spin.discriminant or spin.along(self.rotor) != self.rotor:
            return None
        gyration = tensors.scaled(spin.ratio, spin.along(self.omega))
        return tensors.plus(gyration, tensors.scaled(1 / spin.double_moment, self.rotor))
