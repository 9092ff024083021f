"""A problem between two instants of its held states, and the values that are taken at one."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

from mpmath import mp

from taylor_verify.models import own, written
from taylor_verify.models.evaluated import MORE_BITS, evaluated
from taylor_verify.models.form import Named
from taylor_verify.models.problem import Problem
from taylor_verify.models.written import Written
from taylor_verify.numbers.precision import exact_value, held_exactly
from taylor_verify.numbers.tensors import ZERO_VECTOR, Vector
from taylor_verify.scenes.loads.loads import CENTRE, Loads
from taylor_verify.scenes.loads.states import Instant


def holding(problem: Problem, held: Vector) -> Problem:
    """Return the problem with other held values."""
    loads = problem.given.body.loads
    assert loads is not None
    named = own.numbers(loads, held)
    pairs = zip(problem.form.parameters, problem.parameters, strict=True)
    return replace(
        problem, held=held, parameters=tuple(named.get(name, value) for name, value in pairs)
    )


def taking(problem: Problem, instant: Instant, state: Vector) -> Vector:
    """Return all held values after an instant: those that are taken there, each rounded once.

    ``state`` is that of the form, in units. Raises ArithmeticError or ValueError where one has no value.
    """
    loads = problem.given.body.loads
    assert loads is not None
    piece, after = loads.piece(instant.time), list(problem.held)
    with mp.workprec(problem.rung.bits + MORE_BITS):
        inputs = _InScene(problem, loads, state, instant.time)
        values = evaluated(piece, [piece.values[k] for k in instant.places], inputs)
        for k, value in zip(instant.places, values, strict=True):
            after[k] = problem.rung.round(exact_value(value))
    return tuple(after)


class _InScene(dict[str, Any]):
    """Inputs of texts at a state and an elapsed time, in the scene's units."""

    def __init__(self, problem: Problem, loads: Loads, state: Vector, elapsed: Fraction) -> None:
        form, units = problem.form, problem.units
        assert isinstance(form.equations, Written)
        # Texts may read what the equations of a simple body do not have. The numbers of the loads are read
        # by the momentum of wheels alone.
        numbers = {
            name: number
            for name, number in problem.parameter.items()
            if form.equations.rotor or name[0] != "g"
        }
        numbers |= dict(zip(form.states, state, strict=True))
        numbers |= {**own.numbers(loads, problem.held), "t": elapsed / units.time}
        named = Named({name: held_exactly(value) for name, value in numbers.items()})
        self._inputs, self._loads, self._units = form.equations.inputs(named), loads, units
        self._centre = problem.given.initial.parts().get("centre", ZERO_VECTOR)

    def __missing__(self, name: str) -> Any:
        value = mp.mpf(self._inputs[own.in_form(name, self._loads)])
        value *= held_exactly(written.unit_of(name, self._loads, self._units))
        return value + held_exactly(self._centre[int(name[1]) - 1]) if name in CENTRE else value
