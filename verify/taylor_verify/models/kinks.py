"""Loads with kinks, for an integrator of smooth equations.

abs, min and max choose between two smooth branches by the sign of a difference. Here the choice becomes
parameters, s of 1 or -1, or s and z of 1 and 0, that are set anew wherever the difference crosses zero.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

from taylor_verify.models.form import Form, Named
from taylor_verify.models.own import HELD
from taylor_verify.models.written import Growing, Written
from taylor_verify.scenes.loads.steps import Step


@dataclass(frozen=True)
class Kink:
    """A kink where the step at ``place`` crosses zero, and the parameters that choose the branch there."""

    place: int
    operation: str
    names: tuple[str, ...]

    def chosen(self, sign: int) -> tuple[int, ...]:
        """Return the values of the parameters behind a crossing to this sign."""
        if self.operation == "abs":
            return (sign,)
        is_first = (sign < 0) == (self.operation == "min")
        return (int(is_first), int(not is_first))


@lru_cache
def smooth(form: Form) -> tuple[Form, tuple[Kink, ...]]:
    """Return a form without kinks, the parameters of the choice behind its own, and the kinks."""
    equations = form.equations
    if not isinstance(equations, Written) or not any(map(_is_kinked, equations.steps)):
        return form, ()
    made = _Smoothing()
    turned = equations.anew(made, made.turned)
    names = tuple(name for kink in made.kinks for name in kink.names)
    return replace(form, equations=turned, parameters=form.parameters + names), tuple(made.kinks)


def values(form: Form, state: Sequence[Any], parameters: Sequence[Any], time: Any) -> list[Any]:
    """Return the value of each step, in the arithmetic of the arguments."""
    equations = form.equations
    assert isinstance(equations, Written)
    named = Named(zip(form.states + form.parameters, [*state, *parameters], strict=True), t=time)
    return equations.values(named)


@lru_cache
def changing(form: Form) -> frozenset[int]:
    """Return the places of the steps that change on the way between two instants."""
    equations = form.equations
    places = set[int]()
    for place, step in enumerate(equations.steps if isinstance(equations, Written) else ()):
        is_read = step.operation == "input" and not step.name.startswith(HELD)
        if is_read or not places.isdisjoint(step.operands):
            places.add(place)
    return frozenset(places)


def _is_kinked(step: Step) -> bool:
    return step.operation in ("abs", "min", "max")


class _Smoothing(Growing):
    """Steps with a choice in place of each kink."""

    def __init__(self) -> None:
        super().__init__()
        self.kinks: list[Kink] = []

    def turned(self, step: Step) -> int:
        """Return the place of what a step becomes."""
        return self._chosen(step) if _is_kinked(step) else self.moved(step)

    def _chosen(self, step: Step) -> int:
        k = len(self.kinks) + 1
        operands = tuple(self.places[place] for place in step.operands)
        names: tuple[str, ...] = (f"s{k}",)
        difference = operands[0]
        if step.operation != "abs":
            names = (f"s{k}", f"z{k}")
            difference = self.add(Step("-", operands))
        self.kinks.append(Kink(difference, step.operation, names))
        parts = [
            self.add(Step("*", (self.add(Step("number", name=name)), operand)))
            for name, operand in zip(names, operands, strict=True)
        ]
        return parts[0] if len(parts) == 1 else self.add(Step("+", tuple(parts)))
