"""A gyrostat in the numbers of Euler's equations: K, the momentum r of the wheels, M and H = I omega.

H' = (H + r) x K H + M. H does not include the momentum of the wheels: so omega = K H is not a difference of
large numbers, however strong the wheels are. The rounded body is exactly K^-1 with wheels r.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Final, final

from taylor_verify.models.algebra import add, apply, cross
from taylor_verify.models.euler import euler_equations
from taylor_verify.models.fewest_operations import Choice
from taylor_verify.models.form import Equations, Named, labelled
from taylor_verify.models.mechanics import Change, Mechanics
from taylor_verify.models.rigid import Rigid, chosen_equations
from taylor_verify.models.units import Units, binary, size
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import Rung
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.gyrostat import Gyrostat
from taylor_verify.scenes.motion import Spin
from taylor_verify.scenes.named_numbers import MOMENTUM, Part, Shape, Value

_RIGID: Final = Rigid()


@final
@dataclass(frozen=True)
class WithWheels:
    """Euler's equations of the body alone, and r x omega."""

    body: Equations

    def __call__(self, n: Named) -> dict[str, Any]:
        rates = dict(self.body(n))
        turned = cross(n.vector("r"), apply(n.symmetric("K"), n.vector("H")))
        H = [rates[name] for name in ("H1", "H2", "H3")]
        return rates | labelled("H", add(H, turned))


@final
class Wheeled(Mechanics[Gyrostat, Spin]):
    """Euler's equations with a constant momentum of wheels."""

    body_letters = (*Rigid.body_letters, Part("r", Shape.VECTOR, MOMENTUM))
    momenta = Rigid.momenta

    @property
    def equations(self) -> Equations:
        return WithWheels(euler_equations)

    def values(self, body: Gyrostat) -> Mapping[str, Value]:
        return {"K": body.inverse_inertia, "M": body.moment, "r": body.rotor}

    def body(self, values: Mapping[str, Value]) -> Gyrostat:
        alone = _RIGID.body(values)
        return Gyrostat(alone.inertia, values["r"], alone.moment)

    def change(self, body: Gyrostat) -> Change:
        return Change(body.inertia, body.inverse_inertia)

    def choice(self, numbers: Mapping[str, Fraction], rung: Rung) -> Choice:
        chosen = chosen_equations(numbers, rung)
        return replace(chosen, equations=WithWheels(chosen.equations))

    def units(self, body: Gyrostat, start: Spin, span: Fraction) -> Units:
        """Return the units: H by its size or its growth by the moment, time by omega or by the wheels."""
        alone = RigidBody(body.inertia, body.moment)
        units = _RIGID.units(alone, start, span)
        rate = size(tensors.apply(body.inverse_inertia, body.rotor))
        return replace(units, time=min(units.time, 1 / binary(rate))) if rate else units

    def derived(self, body: Gyrostat, start: Spin) -> Mapping[str, Mapping[str, Value]]:
        """Return K, and I omega without the wheels."""
        return _RIGID.derived(RigidBody(body.inertia, body.moment), start)
