"""Isotropic linear damping of any body: the rate of every momentum z gets the term -d z."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Final, final

from taylor_verify.models.algebra import minus, times
from taylor_verify.models.fewest_operations import Choice
from taylor_verify.models.form import Equations, Named
from taylor_verify.models.mechanics import Change, Mechanics
from taylor_verify.models.units import Units, binary
from taylor_verify.numbers.precision import Rung
from taylor_verify.scenes.bodies import DAMPING, Body
from taylor_verify.scenes.motion import State
from taylor_verify.scenes.named_numbers import Part, Value

_LETTER: Final = Part("d", DAMPING.shape, DAMPING.dimension)


@final
@dataclass(frozen=True)
class WithDamping:
    """The equations of a body, and -d z in the rate of each component of its momenta."""

    body: Equations
    momenta: tuple[str, ...]

    def __call__(self, n: Named) -> dict[str, Any]:
        rates = dict(self.body(n))
        return rates | {name: minus(rates[name], times(n["d"], n[name])) for name in self.momenta}


@final
class Damped(Mechanics[Body, State]):
    """The mechanics of a damped body, built on the mechanics of the undamped body."""

    def __init__(self, free: Mechanics[Any, Any]) -> None:
        self._free = free
        self.body_letters = (*free.body_letters, _LETTER)
        self.momenta = free.momenta

    @property
    def equations(self) -> Equations:
        return WithDamping(self._free.equations, self.states)

    def values(self, body: Body) -> Mapping[str, Value]:
        return {**self._free.values(body.undamped), _LETTER.name: body.damping}

    def body(self, values: Mapping[str, Value]) -> Body:
        free: Any = self._free.body(values)
        damped: Body = replace(free, damping=values[_LETTER.name])
        return damped

    def change(self, body: Body) -> Change:
        return self._free.change(body)

    def choice(self, numbers: Mapping[str, Fraction], rung: Rung) -> Choice:
        """Return the equations, without damping if its rounded number is zero."""
        damping = numbers[_LETTER.name]
        others = {name: value for name, value in numbers.items() if name != _LETTER.name}
        chosen = self._free.choice(others, rung)
        if not damping:
            return chosen
        return replace(
            chosen,
            equations=WithDamping(chosen.equations, self.states),
            numbers={**chosen.numbers, _LETTER.name: damping},
        )

    def units(self, body: Body, start: State, span: Fraction) -> Units:
        """Return the units, with time by the motion, or by its decay if that is faster."""
        units = self._free.units(body.undamped, start, span)
        return replace(units, time=min(units.time, 1 / binary(abs(body.damping))))

    def derived(self, body: Body, start: State) -> Mapping[str, Mapping[str, Value]]:
        return self._free.derived(body, start)
