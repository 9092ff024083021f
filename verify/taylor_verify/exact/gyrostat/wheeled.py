"""A gyrostat as the truth knows it: (I omega)' = (I omega + h) x omega + M, with h constant."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Final, final

import numpy as np

from taylor_verify.exact.equations import Equations, cross, exact
from taylor_verify.exact.gyrostat.invariants import energy, momentum, space_momentum, whole
from taylor_verify.exact.invariant import Array, Invariant
from taylor_verify.exact.kind import Kind
from taylor_verify.exact.parameters import Block, Parameters, entries
from taylor_verify.exact.rows import applied, norms
from taylor_verify.exact.units import Units, exponent, halved, largest
from taylor_verify.scenes import tensors
from taylor_verify.scenes.gyrostat import Gyrostat
from taylor_verify.scenes.manufactured import Manufactured
from taylor_verify.scenes.motion import Motion, Spin
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import Matrix, Vector

_ONE: Final = tensors.diagonal((Fraction(1),) * 3)
_NO_VELOCITY: Final = exact(_ONE)[:0]


@final
class Wheeled(Kind[Gyrostat, Spin]):
    """z = omega. The momentum is I omega, without h, in which omega is linear."""

    moving = ("omega",)
    momenta = ("momentum",)
    room = "taylor_verify.exact.gyrostat"

    @property
    def components(self) -> Mapping[str, tuple[str, ...]]:
        return {"omega": ("omega1", "omega2", "omega3")}

    def state(self, initial: Spin) -> Vector:
        return initial.omega

    def with_state(self, initial: Spin, z: Vector) -> Spin:
        return replace(initial, omega=z)

    def energy(self, body: Gyrostat) -> Matrix:
        return body.inertia

    def equations(self, body: Gyrostat) -> Equations:
        """omega' = K M + K(h x omega) + K((I omega) x omega)."""
        K, wheels = exact(body.inverse_inertia), exact(_cross_matrix(body.rotor))
        turned = np.tensordot(K, cross(body.inertia, _ONE), 1)
        return Equations(K @ exact(body.moment), K @ wheels, turned, exact(_ONE), _NO_VELOCITY)

    def momentum_equations(self, body: Gyrostat) -> Equations:
        """P' = M + h x K P + P x K P, for P = I omega."""
        K = body.inverse_inertia
        linear = exact(_cross_matrix(body.rotor)) @ exact(K)
        return Equations(exact(body.moment), linear, cross(_ONE, K), exact(K), _NO_VELOCITY)

    def units(self, body: Gyrostat, z: Vector) -> Units:
        """omega by its size, or what the moment makes of it; time by omega, or by the wheels."""
        K = body.inverse_inertia
        spun = halved(exponent(tensors.apply(K, body.moment)))
        omega = largest(exponent(z), spun, default=0)
        return Units(
            (omega,), 0, -largest(omega, exponent(tensors.apply(K, body.rotor)), default=0)
        )

    def momentum(self, body: Gyrostat, z: Vector) -> Vector:
        return tensors.apply(body.inertia, z)

    def momentum_rows(self, body: Gyrostat, motion: Motion) -> Array:
        return applied(body.inertia, motion["omega"])

    def of_momentum(self, body: Gyrostat, momentum: Vector) -> Vector:
        return tensors.apply(body.inverse_inertia, momentum)

    def momentum_energy(self, body: Gyrostat) -> Matrix:
        return body.inverse_inertia

    def manufactured_momentum(self, body: Gyrostat) -> Manufactured | None:
        return None if body.manufactured is None else body.manufactured.mapped(body.inertia)

    def invariants(self, scene: Scene) -> tuple[Invariant, ...]:
        body = scene.body
        assert isinstance(body, Gyrostat)
        in_body = energy(body), momentum(body)
        return (*in_body, space_momentum(body)) if "attitude" in scene.track else in_body

    def sizes(self, scene: Scene, motion: Motion) -> list[Array]:
        body = scene.body
        assert isinstance(body, Gyrostat)
        return [abs(energy(body).value(motion)), norms(whole(body, motion))]

    def parameters(self, body: Gyrostat) -> Parameters:
        sides = body.inertia, body.inertia
        return entries("inertia", body, [Block("I", "inertia", sides)])


def _cross_matrix(v: Vector) -> Matrix:
    """[v]x, so that [v]x u = v x u."""
    zero = Fraction(0)
    return ((zero, -v[2], v[1]), (v[2], zero, -v[0]), (-v[1], v[0], zero))
