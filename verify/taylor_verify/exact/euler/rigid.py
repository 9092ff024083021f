"""A rigid body as the truth knows it: (I omega)' = (I omega) x omega + M, Heinbockel (2.2.72)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Final, final

import numpy as np

from taylor_verify.exact import clocks
from taylor_verify.exact.equations import Equations, cross, exact, nothing
from taylor_verify.exact.euler.invariants import energy, momentum, space_momentum
from taylor_verify.exact.invariant import Array, Invariant
from taylor_verify.exact.kind import Kind
from taylor_verify.exact.parameters import Block, Parameters, entries
from taylor_verify.exact.rows import applied, norms
from taylor_verify.exact.units import Units, exponent, halved, largest
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.manufactured import Manufactured
from taylor_verify.scenes.motion import Motion, Spin
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import Matrix, Vector

_ONE: Final = tensors.diagonal((Fraction(1),) * 3)
_NO_VELOCITY: Final = exact(_ONE)[:0]


@final
class Rigid(Kind[RigidBody, Spin]):
    """z = omega, and the momentum H = I omega, with K = I^-1."""

    moving = ("omega",)
    momenta = ("momentum",)
    room = "taylor_verify.exact.euler"

    @property
    def components(self) -> Mapping[str, tuple[str, ...]]:
        return {"omega": ("omega1", "omega2", "omega3")}

    def state(self, initial: Spin) -> Vector:
        return initial.omega

    def with_state(self, initial: Spin, z: Vector) -> Spin:
        return replace(initial, omega=z)

    def energy(self, body: RigidBody) -> Matrix:
        return body.inertia

    def equations(self, body: RigidBody) -> Equations:
        """omega' = K M + K((I omega) x omega)."""
        K = exact(body.inverse_inertia)
        turned = np.tensordot(K, cross(body.inertia, _ONE), 1)
        return Equations(K @ exact(body.moment), nothing(3), turned, exact(_ONE), _NO_VELOCITY)

    def units(self, body: RigidBody, z: Vector) -> Units:
        """omega by its size, or what the moment makes of it; time by omega, or its fastest wave."""
        spun, motion = tensors.apply(body.inverse_inertia, body.moment), body.manufactured
        if motion is None:
            omega = largest(exponent(z), halved(exponent(spun)), default=0)
            return Units((omega,), 0, -omega)
        omega = largest(exponent(motion.reach), default=0)
        rate = largest(omega, clocks.exponent(motion), default=0)
        return Units((omega,), 0, -rate)

    def momentum(self, body: RigidBody, z: Vector) -> Vector:
        return tensors.apply(body.inertia, z)

    def momentum_rows(self, body: RigidBody, motion: Motion) -> Array:
        return applied(body.inertia, motion["omega"])

    def of_momentum(self, body: RigidBody, momentum: Vector) -> Vector:
        return tensors.apply(body.inverse_inertia, momentum)

    def momentum_energy(self, body: RigidBody) -> Matrix:
        return body.inverse_inertia

    def momentum_equations(self, body: RigidBody) -> Equations:
        """H' = M + H x K H."""
        K = body.inverse_inertia
        return Equations(exact(body.moment), nothing(3), cross(_ONE, K), exact(K), _NO_VELOCITY)

    def manufactured_momentum(self, body: RigidBody) -> Manufactured | None:
        return None if body.manufactured is None else body.manufactured.mapped(body.inertia)

    def invariants(self, scene: Scene) -> tuple[Invariant, ...]:
        body = scene.body
        assert isinstance(body, RigidBody)
        in_body = energy(body), momentum(body)
        return (*in_body, space_momentum(body)) if "attitude" in scene.track else in_body

    def sizes(self, scene: Scene, motion: Motion) -> list[Array]:
        body = scene.body
        assert isinstance(body, RigidBody)
        return [abs(energy(body).value(motion)), norms(applied(body.inertia, motion["omega"]))]

    def parameters(self, body: RigidBody) -> Parameters:
        sides = body.inertia, body.inertia
        return entries("inertia", body, [Block("I", "inertia", sides)])
