"""A solid in an ideal fluid as the truth knows it: hydromechanics 48 (3), (4).

x' = x x Omega + X and y' = y x Omega + x x U + L, with U = A x + B y and Omega = B^T x + C y.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Final, final

import numpy as np

from taylor_verify.exact.invariant import Array, Invariant
from taylor_verify.exact.kind import Kind
from taylor_verify.exact.kirchhoff.axis_of_revolution import clebsch_about
from taylor_verify.exact.kirchhoff.integrable import fourth_integral
from taylor_verify.exact.kirchhoff.invariants import F2, FG, X_SPACE, Y_SPACE, along, axial, energy
from taylor_verify.exact.quadratic_forms import Equations, cross, exact, nothing
from taylor_verify.exact.row_arithmetic import norms
from taylor_verify.exact.units import Units, exponent, halved, largest, later
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse, Motion
from taylor_verify.scenes.scene import Scene

# x and y as linear forms of (x, y).
_UNIT: Final = tensors.diagonal((Fraction(1),) * 6)
_X, _Y = _UNIT[:3], _UNIT[3:]


@final
class Immersed(Kind[ImmersedBody, Impulse]):
    """z = (x, y), which is the momentum as well."""

    moving = ("linear_impulse", "angular_impulse")
    momenta = ("linear_impulse", "angular_impulse")
    room = "taylor_verify.exact.kirchhoff"

    def state(self, initial: Impulse) -> Vector:
        return initial.linear + initial.angular

    def with_state(self, initial: Impulse, z: Vector) -> Impulse:
        return replace(initial, linear=z[:3], angular=z[3:])

    def centre(self, initial: Impulse) -> Vector:
        return initial.centre

    def energy(self, body: ImmersedBody) -> Matrix:
        return body.energy_matrix

    def equations(self, body: ImmersedBody) -> Equations:
        U, Omega = body.energy_matrix[:3], body.energy_matrix[3:]
        hessian = np.concatenate([cross(_X, Omega), cross(_Y, Omega) + cross(_X, U)])
        loads = exact(body.force + body.couple)
        undamped = Equations(loads, nothing(6), hessian, exact(Omega), exact(U))
        return undamped.damped(body.damping)

    def pushed(self, body: ImmersedBody) -> Matrix:
        return _UNIT

    def units(self, body: ImmersedBody, z: Vector) -> Units:
        """Return units of the blocks: their sizes, or their changes in a unit of time."""
        x, y, force, couple = z[:3], z[3:], body.force, body.couple
        a, b, c = body.linear, body.coupling, body.angular
        driven = tensors.apply(body.energy_matrix, force + couple)
        omega = largest(
            exponent(tensors.apply(tensors.transpose(b), x)),
            exponent(tensors.apply(c, y)),
            halved(exponent(driven[3:])),
            default=0,
        )
        time = -largest(omega, exponent((body.damping,)), default=0)
        velocity = largest(
            exponent(tensors.apply(a, x)),
            exponent(tensors.apply(b, y)),
            later(exponent(driven[:3]), time),
            default=omega,
        )
        linear = largest(exponent(x), later(exponent(force), time), default=0)
        moment = linear + velocity + time
        angular = largest(exponent(y), later(exponent(couple), time), moment, default=0)
        return Units((linear, angular), velocity + time, time)

    def invariants(self, scene: Scene) -> tuple[Invariant, ...]:
        body = scene.body
        assert isinstance(body, ImmersedBody)
        conserved = [energy(body), F2, FG]
        about = clebsch_about(body)
        if body.axis_of_symmetry is not None:
            conserved.append(axial(body.axis_of_symmetry))
        elif about is not None:
            conserved.append(along(about[1].n))
        fourth = fourth_integral(scene)
        if fourth is not None:
            conserved.append(Invariant(fourth.name, fourth.value, fourth.scale, fourth.sensitivity))
        if "attitude" in scene.track:
            conserved.append(X_SPACE)
        if "centre" in scene.track:
            conserved.append(Y_SPACE)
        return tuple(conserved)

    def sizes(self, scene: Scene, motion: Motion) -> list[Array]:
        assert isinstance(scene.body, ImmersedBody)
        x, y = norms(motion["linear_impulse"]), norms(motion["angular_impulse"])
        result = [abs(energy(scene.body).value(motion)), x, y]
        if "centre" in scene.track:
            result.append(y + norms(motion["centre"]) * x)
        return result
