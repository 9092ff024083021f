"""The form of a system of equations: its states and its parameters, without their numbers.

Two scenes with the same form share one compiled integrator. Zero parameters and untracked quantities are
left out of the form.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from taylor_verify.models.algebra import ABSENT, is_absent, times
from taylor_verify.models.frame import attitude_rate, centre_rate
from taylor_verify.models.symbol import Symbol, operations, parts


class Named(dict[str, Any]):
    """Symbols by name; a name that the form does not have is an absent term."""

    def __missing__(self, name: str) -> int:
        return ABSENT

    def vector(self, letter: str) -> list[Any]:
        return [self[f"{letter}{i}"] for i in (1, 2, 3)]

    def matrix(self, letter: str) -> list[list[Any]]:
        return [[self[f"{letter}{i}{j}"] for j in (1, 2, 3)] for i in (1, 2, 3)]

    def symmetric(self, letter: str) -> list[list[Any]]:
        """A matrix of which the upper triangle alone is named."""
        return [[self[f"{letter}{min(i, j)}{max(i, j)}"] for j in (1, 2, 3)] for i in (1, 2, 3)]

    def quaternion(self) -> list[Any]:
        return [self[f"e{i}"] for i in range(4)]


Equations = Callable[[Named], Mapping[str, Any]]


@dataclass(frozen=True)
class Form:
    """Equations together with the names of the states and parameters that enter them.

    States: H1 H2 H3 (Euler) or x1 x2 x3 y1 y2 [y3] (Kirchhoff), then e0..e3 (attitude quaternion) and
    c1 c2 c3 (centre) where they are tracked.
    """

    equations: Equations
    states: tuple[str, ...]
    parameters: tuple[str, ...]

    def rates(
        self, state: Sequence[Any], parameters: Sequence[Any], time: Any = ABSENT
    ) -> list[Any]:
        """Return d state/dt, in the arithmetic of the arguments; the int 0 for a rate that is absent.

        ``time`` is that since the start, which the loads of a scene may read.
        """
        named = Named(
            zip(self.states + self.parameters, [*state, *parameters], strict=True), t=time
        )
        rates = self.equations(named)
        return [rates[name] for name in self.states]

    def text(self) -> tuple[str, ...]:
        """Return the equations as they are built, a line for each state, without absent terms.

        Long equations have a method ``lines`` that names parts of them. It returns the text of each rate
        (``H1'``) and of each part (``M1``).
        """
        if hasattr(self.equations, "lines"):
            names = self.states + self.parameters
            named = Named(zip(names, map(Symbol, names), strict=True), t=Symbol("t"))
            lines = self.equations.lines(named)
            return tuple(f"{name} = {value}" for name, value in lines.items())
        rates = zip(self.states, self.symbolic(), strict=True)
        return tuple(f"{name}' = {rate}" for name, rate in rates)

    def operations(self) -> dict[str, int]:
        """Return the number of distinct sums, products and quotients of one evaluation of the rates."""
        return operations(self.symbolic())

    def symbolic(self) -> list[Any]:
        """Return the rates as Symbols; the int 0 for a rate that is absent."""
        states, parameters = map(Symbol, self.states), map(Symbol, self.parameters)
        return self.rates(list(states), list(parameters), Symbol("t"))

    # There are few forms and many scenes: all bodies of a family have the same form.
    @lru_cache(maxsize=256)  # noqa: B019 (a form is a value, and small)
    def constants(self) -> tuple[str, ...]:
        """Return the impulses that no term changes: the components x1 to y3 whose rates are absent.

        The momentum of a rigid body always stays a state, because other steppers change it.
        """
        rates = zip(self.states, self.symbolic(), strict=True)
        return tuple(name for name, rate in rates if name[0] in "xy" and is_absent(rate))

    @lru_cache(maxsize=256)  # noqa: B019
    def entering(self) -> tuple[str, ...]:
        """Return the parameters that occur in the equations; Clebsch's r' does not if y3 = 0."""
        written = {symbol.name for symbol in parts(self.symbolic())}
        return tuple(name for name in self.parameters if name in written)


def frame_rates(n: Named, omega: Sequence[Any], U: Sequence[Any] | None) -> dict[str, Any]:
    """Return the rates of the attitude and of the centre, as far as these are states."""
    rates: dict[str, Any] = {}
    if "e0" in n:
        attitude = attitude_rate(n.quaternion(), omega)
        rates |= {f"e{i}": rate for i, rate in enumerate(attitude)}
    if "c1" in n and U is not None:
        rates |= labelled("c", centre_rate(n.quaternion(), in_unit_of_path(n, U)))
    return rates


def in_unit_of_path(n: Named, U: Sequence[Any]) -> Sequence[Any]:
    """Return s U with s the unit of length over the unit of the centre; U itself if they are equal."""
    return [times(n["s"], u) for u in U] if "s" in n else U


def labelled(letter: str, vector: Sequence[Any], mark: str = "") -> dict[str, Any]:
    """Return the components of a vector by name, counted from 1, with a mark behind the number."""
    return {f"{letter}{i}{mark}": component for i, component in enumerate(vector, start=1)}
