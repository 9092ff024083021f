"""A gyrostat in the numbers of its equations: H' = H x (K H - g) + M in the whole momentum H = I omega + h.

K  inverse inertia tensor        g = K h, so that omega = K H - g        M  moment

K, g and H are formed exactly and rounded once each. Whatever symmetric K and whatever g are stored, it is a
gyrostat: I = K^-1 and h = K^-1 g.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any, final

from taylor_verify.models.algebra import add, apply, cross, minus
from taylor_verify.models.choice import Choice
from taylor_verify.models.form import Equations, Named, frame_rates, labelled
from taylor_verify.models.manufactured import Inverse, Moved
from taylor_verify.models.mechanics import Change, Mechanics
from taylor_verify.models.units import Units, binary, largest, size
from taylor_verify.scenes import tensors
from taylor_verify.scenes.gyrostat import Gyrostat
from taylor_verify.scenes.motion import Spin
from taylor_verify.scenes.parts import MOMENT, MOMENTUM, RATE, Dimension, Part, Shape, Value
from taylor_verify.scenes.precision import Rung


def gyrostat_equations(n: Named) -> dict[str, Any]:
    """H' = H x (K H - g) + M, and the attitude where it is tracked."""
    H = n.vector("H")
    omega = [minus(a, b) for a, b in zip(apply(n.symmetric("K"), H), n.vector("g"), strict=True)]
    return labelled("H", add(cross(H, omega), n.vector("M"))) | frame_rates(n, omega, U=None)


def _moment(n: Named, momentum: Moved) -> dict[str, Any]:
    """M = H*' - H* x (K H* - g)."""
    (H, rate), K, g = momentum, n.symmetric("K"), n.vector("g")
    omega = [minus(a, b) for a, b in zip(apply(K, H), g, strict=True)]
    turned = cross(H, omega)
    return labelled("M", [minus(a, b) for a, b in zip(rate, turned, strict=True)])


@final
class Wheeled(Mechanics[Gyrostat, Spin]):
    """Euler's equations with a constant rotor momentum."""

    body_letters = (
        Part("K", Shape.SYMMETRIC, Dimension(-1, -2, 0)),
        Part("g", Shape.VECTOR, RATE),
        Part("M", Shape.VECTOR, MOMENT, is_load=True),
    )
    momenta = (Part("H", Shape.VECTOR, MOMENTUM),)
    inverse = Inverse("H", _moment)

    @property
    def equations(self) -> Equations:
        return gyrostat_equations

    def values(self, body: Gyrostat) -> Mapping[str, Value]:
        K = body.inverse_inertia
        return {"K": K, "g": tensors.apply(K, body.rotor), "M": body.moment}

    def body(self, values: Mapping[str, Value]) -> Gyrostat:
        if not tensors.is_positive_definite(values["K"]):
            raise ValueError("the inverse inertia tensor is not positive definite")
        inertia = tensors.inverse(values["K"])
        return Gyrostat(inertia, tensors.apply(inertia, values["g"]), values["M"])

    def change(self, body: Gyrostat) -> Change:
        return Change(body.inertia, body.inverse_inertia, body.rotor)

    def choice(self, numbers: Mapping[str, Fraction], rung: Rung) -> Choice:
        del rung
        return Choice(gyrostat_equations, numbers, {}, ("the rotor's momentum is part of H",))

    def units(self, body: Gyrostat, start: Spin, span: Fraction) -> Units:
        whole = self.change(body).momentum(start.omega)
        momentum = (
            size(whole) or size(body.rotor) or binary(size(body.moment) * span) or Fraction(1)
        )
        K = body.inverse_inertia
        rate = max(size(start.omega), size(tensors.apply(K, body.rotor)), largest(K) * momentum)
        return Units(time=1 / binary(rate), momentum=momentum)

    def derived(self, body: Gyrostat, start: Spin) -> Mapping[str, Mapping[str, Value]]:
        return {
            "body": {"inverse_inertia": body.inverse_inertia},
            "initial": {"angular_momentum": self.change(body).momentum(start.omega)},
        }
