"""The problem that a user's function gets: the numbers of `given` convert to arrays of doubles."""

from __future__ import annotations

from dataclasses import fields, replace
from fractions import Fraction
from typing import Any, Final

from taylor_verify.models.problem import Problem
from taylor_verify.numbers.convertible import Convertible, Number, convertible
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.instants import Instants
from taylor_verify.scenes.motion import Clock, State

_DOUBLE_BITS: Final = 53
# Made of the fields when they are first read.
_DERIVED: Final = ("elapsed", "energy_matrix", "inverse_inertia", "mass_matrix", "moving")


class Times(Convertible, Instants):
    """Instants that convert to an array of doubles."""

    def nested(self, kind: Any) -> Any:
        return [kind(Fraction(time)) for time in self]


def opened(problem: Problem) -> Problem:
    """Return the problem with numbers that convert; the same where a double cannot hold its numbers."""
    if problem.rung.bits > _DOUBLE_BITS:
        return problem
    given = problem.given
    parts = {name: _opened(getattr(given, name)) for name in ("body", "initial", "clock")}
    return replace(problem, given=replace(given, **parts))


def _opened(part: Body | State | Clock) -> Any:
    values = {field.name: getattr(part, field.name) for field in fields(part)}
    made = replace(part, **{name: _numbers(value) for name, value in values.items()})
    for name in _DERIVED:
        if hasattr(part, name):
            vars(made)[name] = _numbers(getattr(part, name))
    return made


def _numbers(value: Any) -> Any:
    """Return numbers of any shape as such that convert, and anything else as it is."""
    if isinstance(value, Instants):
        return Times(len(value), lambda k: Number(value[k]))
    return convertible(value) if isinstance(value, Fraction | tuple) else value
