"""A rigid body as the truth knows it: (I omega)' = (I omega + h) x omega + M, Heinbockel (2.2.72).

h is the momentum of wheels, zero for a body without them.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import partial
from typing import Final, final

from taylor_verify.exact.euler.invariants import energy, momentum, space_momentum, whole
from taylor_verify.exact.invariant import Array, Invariant
from taylor_verify.exact.kind import Kind
from taylor_verify.exact.quadratic_forms import Equations, cross, exact, mapped
from taylor_verify.exact.row_arithmetic import applied, norms
from taylor_verify.exact.units import Units, exponent, halved, largest
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Motion, Spin
from taylor_verify.scenes.scene import Scene

_ONE: Final = tensors.diagonal((Fraction(1),) * 3)
_NO_VELOCITY: Final = exact(_ONE)[:0]


@final
class Rigid(Kind[RigidBody, Spin]):
    """z = omega. The momentum is I omega, without h, in which omega is linear; K = I^-1."""

    moving = ("omega",)
    momenta = ("momentum",)
    room = "taylor_verify.exact.euler"

    def state(self, initial: Spin) -> Vector:
        return initial.omega

    def with_state(self, initial: Spin, z: Vector) -> Spin:
        return replace(initial, omega=z)

    def energy(self, body: RigidBody) -> Matrix:
        return body.inertia

    def equations(self, body: RigidBody) -> Equations:
        """omega' = K M + K(h x omega) + K((I omega) x omega) - c omega."""
        K = exact(body.inverse_inertia)
        linear = K @ exact(tensors.cross_matrix(body.rotor))
        turned = mapped(K, cross(body.inertia, _ONE))
        undamped = Equations(K @ exact(body.moment), linear, turned, exact(_ONE), _NO_VELOCITY)
        return undamped.damped(body.damping)

    def pushed(self, body: RigidBody) -> Matrix:
        return body.inverse_inertia

    def units(self, body: RigidBody, z: Vector) -> Units:
        """omega by its size, or what the moment makes of it; time by omega, h or c."""
        K = body.inverse_inertia
        wheels = exponent(tensors.apply(K, body.rotor))
        spun = halved(exponent(tensors.apply(K, body.moment)))
        omega = largest(exponent(z), spun, default=0)
        return Units((omega,), 0, -largest(omega, wheels, exponent((body.damping,)), default=0))

    def momentum(self, body: RigidBody, z: Vector) -> Vector:
        return tensors.apply(body.inertia, z)

    def momentum_rows(self, body: RigidBody, motion: Motion) -> Array:
        return applied(body.inertia, motion["omega"])

    def of_momentum(self, body: RigidBody, momentum: Vector) -> Vector:
        return tensors.apply(body.inverse_inertia, momentum)

    def momentum_energy(self, body: RigidBody) -> Matrix:
        return body.inverse_inertia

    def momentum_equations(self, body: RigidBody) -> Equations:
        """H' = M + h x K H + H x K H - c H, for H = I omega."""
        K = body.inverse_inertia
        linear = exact(tensors.cross_matrix(body.rotor)) @ exact(K)
        undamped = Equations(exact(body.moment), linear, cross(_ONE, K), exact(K), _NO_VELOCITY)
        return undamped.damped(body.damping)

    def invariants(self, scene: Scene) -> tuple[Invariant, ...]:
        body: RigidBody = scene.body  # type: ignore[assignment]
        H = partial(whole, body)
        in_body: tuple[Invariant, ...] = energy(body), momentum(H)
        return (*in_body, space_momentum(H)) if "attitude" in scene.track else in_body

    def sizes(self, scene: Scene, motion: Motion) -> list[Array]:
        body: RigidBody = scene.body  # type: ignore[assignment]
        return [abs(energy(body).value(motion)), norms(whole(body, motion))]
