"""The general equations of a posed body: what the chosen, shorter ones are held and counted against.

K  inverse inertia tensor, M moment                       (Euler)
A, B, C  the 21 coefficients of T, X and L force, couple  (Kirchhoff)
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from taylor_verify.models.form import Equations, Form, euler_equations, kirchhoff_equations
from taylor_verify.models.manufactured import Loaded
from taylor_verify.models.problem import Problem
from taylor_verify.records.quantities import IMPULSES
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.tensors import Matrix, Vector

_ATTITUDE = ("e0", "e1", "e2", "e3")
_CENTRE = ("c1", "c2", "c3")
# Letters of what a manufactured motion is made of.
_OF_MOTION = "hknabfg"
_MOMENTUM = ("H1", "H2", "H3")


def in_general_form(problem: Problem, zeros: bool = False) -> Problem:
    """The same body and start by the general equations, all impulses states.

    With ``zeros`` the coefficients and loads that are zero are parameters like any other.
    """
    numbers = _coefficients(problem)
    equations, own = _of(problem.scene.model)
    motion = problem.given.body.manufactured
    if motion is not None:
        equations = Loaded(equations, len(motion.waves))
        own += tuple(name for name in problem.form.states if name[0] in "uv")
        numbers |= {n: value for n, value in problem.parameter.items() if n[0] in _OF_MOTION}
    frame = tuple(name for name in problem.form.states if name[0] in "ec")
    known = {**problem.parameter, **problem.state}
    states = own + frame
    names = tuple(name for name, value in numbers.items() if value or zeros)
    form = Form(equations, states, names)
    return replace(
        problem,
        form=form,
        parameters=tuple(numbers[name] for name in names),
        initial_momenta=tuple(known.get(name, Fraction(0)) for name in states),
        replaced=(),
        because=(),
    )


def whole_form(model: str) -> Form:
    """All that a model has: every coefficient and load, attitude and, in a fluid, the centre."""
    equations, own = _of(model)
    matrices = ("K",) if model == "euler" else ("A", "B", "C")
    names = [f"{m}{i}{j}" for m in matrices for i, j in _places(m)]
    names += [f"{v}{i}" for v in ("M" if model == "euler" else "XL") for i in (1, 2, 3)]
    frame = _ATTITUDE if model == "euler" else _ATTITUDE + _CENTRE
    return Form(equations, own + frame, tuple(names))


def _of(model: str) -> tuple[Equations, tuple[str, ...]]:
    if model == "euler":
        return euler_equations, _MOMENTUM
    return kirchhoff_equations, IMPULSES


def _coefficients(problem: Problem) -> dict[str, Fraction]:
    """Every coefficient and load of the body that the problem is of, in its units."""
    body, units = problem.given.body, problem.units
    per_time = units.momentum / units.time
    if isinstance(body, RigidBody):
        found = _entries("K", body.inverse_inertia, units.inverse_inertia)
        return found | _components("M", body.moment, per_time)
    return {
        **_entries("A", body.linear, units.inverse_mass),
        **_entries("B", body.coupling, units.coupling),
        **_entries("C", body.angular, units.inverse_inertia),
        **_components("X", body.force, units.impulse / units.time),
        **_components("L", body.couple, per_time),
    }


def _entries(letter: str, matrix: Matrix, unit: Fraction) -> dict[str, Fraction]:
    return {f"{letter}{i}{j}": matrix[i - 1][j - 1] / unit for i, j in _places(letter)}


def _components(letter: str, vector: Vector, unit: Fraction) -> dict[str, Fraction]:
    return {f"{letter}{i}": entry / unit for i, entry in enumerate(vector, start=1)}


def _places(letter: str) -> list[tuple[int, int]]:
    """Of B every place; the others are symmetric, and named by their upper triangle."""
    return [(i, j) for i in (1, 2, 3) for j in (1, 2, 3) if letter == "B" or i <= j]
