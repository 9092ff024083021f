"""Variants whose price is measured: forms of one motion, and one body with more and more options."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Final

from taylor_verify.models.euler import euler_equations
from taylor_verify.models.general import in_general_form
from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import Rung
from taylor_verify.scenes.reading.reader import load

_PRINCIPAL: Final = "euler/generic"
_TENSOR: Final = "euler/full-tensor"
_CLEBSCH: Final = "kirchhoff/whole-motion"
_LOAD: Final = (Fraction(1, 64), Fraction(-1, 128), Fraction(1, 256))


@dataclass(frozen=True)
class Variant:
    """A form of a scene.

    ``against`` names the variant whose price is the unit. ``posed`` returns the problem on a rung. With
    ``literals`` the coefficients are written into the compiled code.
    """

    name: str
    against: str
    what: str
    posed: Callable[[Rung], Problem]
    literals: bool = False


def variants() -> tuple[Variant, ...]:
    """Return the variants in reading order; each comes after the one that is its unit."""
    omega, impulse = "omega", "impulse"
    whole = _of(_CLEBSCH, "attitude", "centre")
    return (
        Variant(omega, omega, "three moments, free, omega alone", _of(_PRINCIPAL)),
        Variant(
            "literals",
            omega,
            "the coefficients written into the code",
            _of(_PRINCIPAL),
            literals=True,
        ),
        Variant(
            "differences",
            omega,
            "differences of K's diagonal formed by the integrator",
            lambda rung: pose(load(_PRINCIPAL), rung).with_equations(euler_equations),
        ),
        Variant(
            "zeros",
            omega,
            "products of inertia and moment carried along, all of them zero",
            lambda rung: in_general_form(pose(load(_PRINCIPAL), rung), zeros=True),
        ),
        Variant("moment", omega, "a constant moment about all axes", _of(_PRINCIPAL, loaded=True)),
        Variant("attitude", omega, "and the attitude", _of(_PRINCIPAL, "attitude")),
        Variant("tensor", omega, "a tensor with products of inertia", _of(_TENSOR)),
        Variant("tensor, attitude", omega, "and the attitude", _of(_TENSOR, "attitude")),
        Variant(impulse, impulse, "Clebsch's body, free, x and y alone", _of(_CLEBSCH)),
        Variant(
            "impulse, literals", impulse, "as above, in the code", _of(_CLEBSCH), literals=True
        ),
        Variant("y3 a state", impulse, "the constant y3 integrated", _with_y3),
        Variant(
            "21 coefficients",
            impulse,
            "the same body by the general equations, zeros left out",
            lambda rung: in_general_form(_of(_CLEBSCH)(rung)),
        ),
        Variant(
            "21, zeros carried",
            impulse,
            "and with 15 coefficients and 6 loads that are zero",
            lambda rung: in_general_form(_of(_CLEBSCH)(rung), zeros=True),
        ),
        Variant("loads", impulse, "a constant force and couple", _of(_CLEBSCH, loaded=True)),
        Variant("impulse, attitude", impulse, "and the attitude", _of(_CLEBSCH, "attitude")),
        Variant("whole", impulse, "attitude and centre", whole),
        Variant(
            "whole, 21",
            impulse,
            "attitude and centre by the general equations, zeros left out",
            lambda rung: in_general_form(whole(rung)),
        ),
    )


def _of(name: str, *track: str, loaded: bool = False) -> Callable[[Rung], Problem]:
    """Return a function that poses a shipped scene with other tracked quantities, and with loads."""

    def posed(rung: Rung) -> Problem:
        scene = replace(load(name), track=frozenset(track))
        if loaded:
            # Loads so small that they change the motion little in the time of the scene.
            opposed = tensors.scaled(Fraction(-1), _LOAD)
            loads = dict(zip(scene.body.load_names(), (_LOAD, opposed), strict=False))
            scene = replace(scene, body=scene.body.with_parts(loads))
        return pose(scene, rung)

    return posed


def _with_y3(rung: Rung) -> Problem:
    """Return Clebsch's equations with all six impulses among the states."""
    problem = _of(_CLEBSCH)(rung)
    states = (*problem.form.states, "y3")
    parameters = tuple(name for name in problem.form.parameters if name != "y3")
    known = problem.parameter
    return replace(
        problem,
        form=replace(problem.form, states=states, parameters=parameters),
        parameters=tuple(known[name] for name in parameters),
        initial_momenta=(*problem.initial_momenta, known["y3"]),
    )
