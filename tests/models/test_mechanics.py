"""Bodies by their parts: complete, of the right dimensions, and known to every room that has a table."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, replace
from fractions import Fraction
from random import Random
from typing import Any

import pytest

from taylor_verify.models.general import in_general_form
from taylor_verify.models.letters import numbers_of
from taylor_verify.models.problem import Problem, pose
from taylor_verify.models.registry import mechanics
from taylor_verify.models.units import Units
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.bodies import Body, Ellipsoid, ImmersedBody
from taylor_verify.scenes.motion import State
from taylor_verify.scenes.named_numbers import Part, Parted, Shape, Value, entrywise
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify_reports.studies.portraits.latex_equations import equations

# A scene of each kind of body.
SCENES = ("euler/full-tensor", "kirchhoff/general-body", "euler/gyrostat")
# Powers of two, so that a change of units rounds nothing.
UNITS = Units(time=Fraction(1, 8), momentum=Fraction(32), impulse=Fraction(2))


def kinds(of: type[Any]) -> Iterator[type[Any]]:
    for kind in of.__subclasses__():
        yield kind
        yield from kinds(kind)


def in_units(scene: Scene) -> Scene:
    """The same motion, its body and start counted in other units of mass, length and time."""

    def counted(part: Part, value: Value) -> Value:
        if part.shape is Shape.QUATERNION:
            return value
        return entrywise(lambda entry: entry / UNITS.of(part.dimension), value)

    return replace(scene, body=scene.body.changed(counted), initial=scene.initial.changed(counted))


def rates(problem: Problem, state: dict[str, Fraction]) -> dict[str, Fraction]:
    form = problem.form
    derivatives = form.rates([state[name] for name in form.states], problem.parameters)
    return dict(zip(form.states, derivatives, strict=True))


@pytest.mark.parametrize("kind", [*kinds(Body), *kinds(State)], ids=lambda kind: kind.__name__)
def test_every_number_is_a_part(kind: type[Parted]) -> None:
    """No field of a body or state holds numbers without being listed among the parts."""
    others = {"ellipsoid", "added", "loads"}
    assert {part.key for part in kind.PARTS} == {field.name for field in fields(kind)} - others


def test_there_is_a_scene_of_every_kind_of_body() -> None:
    """Tests of a scene of each kind are tests of all kinds that there are."""
    # Other tests may make kinds of their own.
    ours = {kind for kind in kinds(Body) if kind.__module__.startswith("taylor_verify.")}
    assert {type(load(name).body) for name in SCENES} == ours


@pytest.mark.parametrize("name", SCENES)
def test_a_model_has_the_state_of_its_bodies(name: str) -> None:
    """The class of a body says the model of its scenes and the kind of their initial state."""
    scene = load(name)
    assert scene.model == scene.body.MODEL
    assert type(scene.initial) is scene.body.STATE
    assert len(scene.initial.moving) == len(scene.body.energy_matrix)
    assert scene.initial.with_moving(scene.initial.moving) == scene.initial


@pytest.mark.parametrize("name", SCENES)
def test_dimensions_are_those_of_the_equations(name: str) -> None:
    """A body and a start counted in other units have rates that are counted in them too."""
    scene, random = load(name), Random(name)
    loads = {
        load: tuple(Fraction(random.randint(1, 9)) for _ in "123")
        for load in scene.body.load_names()
    }
    scene = replace(scene, body=scene.body.with_parts(loads), track=frozenset({"attitude"}))
    kind = mechanics(scene.body)
    problems = [
        in_general_form(pose(each, rung("mp237")), zeros=True) for each in (scene, in_units(scene))
    ]
    one = Units(Fraction(1), Fraction(1))
    changed = numbers_of(in_units(scene).body, one)
    assert changed == numbers_of(scene.body, UNITS)
    here, there = (
        replace(
            p, form=replace(p.form, parameters=tuple(changed)), parameters=tuple(numbers.values())
        )
        for p, numbers in zip(problems, (numbers_of(scene.body, one), changed), strict=True)
    )
    state = {name: Fraction(random.randint(-9, 9)) for name in here.form.states}
    unit = {f"{part.name}{i}": UNITS.of(part.dimension) for part in kind.momenta for i in (1, 2, 3)}
    counted = {name: value / unit.get(name, 1) for name, value in state.items()}
    expected = {
        name: rate * UNITS.time / unit.get(name, 1) for name, rate in rates(here, state).items()
    }
    assert rates(there, counted) == expected


@pytest.mark.parametrize("name", SCENES)
def test_momenta_lead_back_to_the_state(name: str) -> None:
    """The momenta of a state, and of a motion, have that state and no other, exactly."""
    scene = load(name)
    change = mechanics(scene.body).change(scene.body)
    assert change.moving(change.momentum(scene.initial.moving)) == scene.initial.moving
    values = mechanics(scene.body).values(scene.body)
    assert mechanics(scene.body).body(values) == scene.body


@pytest.mark.parametrize("name", SCENES)
def test_every_kind_of_body_has_its_equations_in_print(name: str) -> None:
    """A page can write the equations of every kind of body."""
    assert equations(load(name))


def test_other_coefficients_are_no_longer_those_of_the_ellipsoid() -> None:
    """A load leaves a body the ellipsoid that it was given as; another coefficient does not."""
    body = Ellipsoid((Fraction(3), Fraction(2), Fraction(1)), Fraction(1), Fraction(1)).body()
    assert isinstance(body, ImmersedBody)
    pushed = body.with_parts({"force": (Fraction(1),) * 3})
    assert pushed.ellipsoid is body.ellipsoid is not None
    assert body.with_parts({"linear": body.angular}).ellipsoid is None
