"""Damping in the equations that solvers receive: where the scene has it, and nowhere else."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from taylor_verify.exact.registry import kind_of
from taylor_verify.models.damping import WithDamping
from taylor_verify.models.general import in_general_form
from taylor_verify.models.problem import NotRepresentable, pose
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

SCENES = ("euler/generic", "euler/full-tensor", "euler/gyrostat", "kirchhoff/four-real-roots")
SCENES += ("kirchhoff/general-body", "kirchhoff/constant-loads", "kirchhoff/trigonometric")


def damped(name: str, damping: Fraction) -> Scene:
    scene = load(name)
    return replace(scene, body=replace(scene.body, damping=damping))  # type: ignore[type-var]


@pytest.mark.parametrize("name", SCENES)
def test_no_damping_builds_the_same_equations(name: str) -> None:
    """With damping = 0 the problem is the one without the key: equations, parameters, units and all."""
    asked, plain = (pose(scene, rung("f64")) for scene in (damped(name, Fraction(0)), load(name)))
    assert replace(asked, scene=plain.scene).__dict__ == plain.__dict__
    assert not isinstance(asked.form.equations, WithDamping)
    assert "d" not in asked.parameter


@pytest.mark.parametrize("on", ["f32", "f64", "f80", "f128", "mp237"])
@pytest.mark.parametrize("name", SCENES)
def test_the_rates_are_those_of_the_truth(name: str, on: str) -> None:
    """-d z in the rate of every momentum, both forms alike, as the truth has it from the texts."""
    problem = pose(damped(name, Fraction(-1, 3)), rung(on))
    kind, body, units = kind_of(problem.given.body), problem.given.body, problem.units
    z = np.array(kind.momentum(body, kind.state(problem.given.initial)), dtype=object)
    equations = kind.momentum_equations(body)
    truth = equations.constant + equations.linear @ z + (equations.hessian @ z) @ z / 2
    sizes = [units.momentum] * 3 if len(z) == 3 else [units.impulse] * 3 + [units.momentum] * 3
    for posed in (problem, in_general_form(problem)):
        state = [posed.state[s] for s in posed.form.states]
        rates = dict(zip(posed.form.states, posed.form.rates(state, posed.parameters), strict=True))
        names = ("H1", "H2", "H3") if len(z) == 3 else ("x1", "x2", "x3", "y1", "y2", "y3")
        for k, component in enumerate(names):
            assert rates[component] * sizes[k] / units.time == truth[k]


def test_a_component_that_damping_alone_moves_is_a_state() -> None:
    """y3 of Clebsch's body is a constant, and no state, without damping; with damping it decays."""
    free = pose(load("kirchhoff/four-real-roots"), rung("f64"))
    asked = pose(damped("kirchhoff/four-real-roots", Fraction(1, 4)), rung("f64"))
    assert "y3" not in free.form.states
    assert "y3' = -d y3" in asked.form.text()


def test_damping_is_rounded_once() -> None:
    """The body that was given has the nearest number of the rung, counted in units of time exactly."""
    scene = damped("euler/generic", Fraction(1, 10))
    problem = pose(scene, rung("f32"))
    assert problem.given.body.damping == Fraction(float(np.float32(0.1)))
    assert problem.parameter["d"] == problem.given.body.damping * problem.units.time


def test_a_fast_decay_sets_the_unit_of_time() -> None:
    """A damping of 1000 has a unit of time to fit it, and a weak one leaves the unit as it was."""
    free = pose(load("euler/generic"), rung("f64")).units
    assert pose(damped("euler/generic", Fraction(1000)), rung("f64")).units.time == Fraction(1, 512)
    assert pose(damped("euler/generic", Fraction(1, 10**30)), rung("f64")).units == free


def test_what_a_rung_cannot_hold() -> None:
    """A damping below the least number of a rung is refused, or none: it is never another one."""
    scene = damped("euler/generic", Fraction(1, 10**60))
    try:
        problem = pose(scene, rung("f32"))
    except NotRepresentable:
        return
    assert problem.given.body.damping == 0
    assert not isinstance(problem.form.equations, WithDamping)
