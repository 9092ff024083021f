"""The general equations of a posed body, with which the chosen, shorter ones are compared.

K  inverse inertia tensor, M moment                       (Euler)
A, B, C  the 21 coefficients of T, X and L force, couple  (Kirchhoff)
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from taylor_verify.models.form import Equations, Form
from taylor_verify.models.letters import numbers_of
from taylor_verify.models.mechanics import components
from taylor_verify.models.problem import Problem
from taylor_verify.models.registry import mechanics
from taylor_verify.models.written import Written
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.named_numbers import Shape

_ATTITUDE = ("e0", "e1", "e2", "e3")
_CENTRE = ("c1", "c2", "c3")
# Letters of the parameters of written loads.
_OF_LOADS = "gv"


def in_general_form(problem: Problem, zeros: bool = False) -> Problem:
    """Return the same body and start with the general equations; all impulses are states.

    With ``zeros`` the coefficients and loads that are zero are parameters like any other.
    """
    body = problem.given.body
    kind = mechanics(body)
    numbers = numbers_of(body, problem.units)
    equations: Equations = kind.equations
    written = problem.form.equations
    if isinstance(written, Written):
        equations = replace(written, free=equations)
        numbers |= {n: value for n, value in problem.parameter.items() if n[0] in _OF_LOADS}
    frame = tuple(name for name in problem.form.states if name[0] in "ec")
    numbers |= {n: value for n, value in problem.parameter.items() if n == "s"}
    known = {**problem.parameter, **problem.state}
    states = kind.states + frame
    names = tuple(name for name, value in numbers.items() if value or zeros or name[0] == "g")
    form = Form(equations, states, names)
    return replace(
        problem,
        form=form,
        parameters=tuple(numbers[name] for name in names),
        initial_momenta=tuple(known.get(name, Fraction(0)) for name in states),
        replaced=(),
        because=(),
    )


def whole_form(body: Body) -> Form:
    """Return the form with every coefficient and load of the body, zeros too, with attitude and centre."""
    kind = mechanics(body)
    values = kind.values(body)
    zeros = {Shape.NUMBER: 0, Shape.VECTOR: (0,) * 3}
    names = [
        name
        for letter in kind.body_letters
        if not letter.is_optional or any(values[letter.name])
        for name in components(letter, zeros.get(letter.shape, ((0,) * 3,) * 3))
    ]
    places = {"attitude": _ATTITUDE, "centre": _CENTRE}
    frame = tuple(n for part in body.STATE.PARTS for n in places.get(part.name, ()))
    return Form(kind.equations, kind.states + frame, tuple(names))
