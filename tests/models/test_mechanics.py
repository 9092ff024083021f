"""Bodies by their parts: complete, of the right dimensions, known to every room or taken by none."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace
from fractions import Fraction
from random import Random
from types import SimpleNamespace
from typing import Any

import pytest
from builders.scenes import IMPULSE, LOADED, MOMENT, OMEGA, SPIN, TENSOR

import taylor_verify
from taylor_verify.exact.quadratic_forms import Equations, exact
from taylor_verify.exact.registry import KINDS, kind_of
from taylor_verify.judge.causes.likely import NOT_LOOKED_FOR, with_causes
from taylor_verify.judge.causes.material import are_known
from taylor_verify.models.general import in_general_form
from taylor_verify.models.letters import numbers_of
from taylor_verify.models.problem import Problem, pose
from taylor_verify.models.registry import mechanics
from taylor_verify.models.units import Units
from taylor_verify.numbers.precision import rung
from taylor_verify.numbers.tensors import Vector, apply, diagonal, dot
from taylor_verify.scenes.bodies import Body, Ellipsoid, ImmersedBody, RigidBody
from taylor_verify.scenes.library import names
from taylor_verify.scenes.motion import State
from taylor_verify.scenes.named_numbers import NUMBER, Part, Parted, Shape, Value, entrywise
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.process import protocol
from taylor_verify.solvers.registry import solver_named
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


# A kind that nobody knows yet

INERTIA = diagonal((Fraction(1), Fraction(2), Fraction(3)))


@dataclass(frozen=True)
class SprungBody(RigidBody):
    """A dummy: a rigid body with a part that is neither energy nor load."""

    spring: Vector = (Fraction(1), Fraction(0), Fraction(0))

    PARTS = (*RigidBody.PARTS, Part("spring", Shape.VECTOR, NUMBER))


BODIES = {
    "rigid": (RigidBody(INERTIA), True, True),
    "damped": (RigidBody(INERTIA, damping=Fraction(1)), False, True),
    "under a moment": (RigidBody(INERTIA, (Fraction(1),) * 3), False, True),
    "with wheels": (RigidBody(INERTIA, rotor=(Fraction(1),) * 3), False, True),
    "of a new kind": (SprungBody(INERTIA), False, False),
}


@pytest.mark.parametrize(("body", "is_plain", "is_known"), BODIES.values(), ids=BODIES)
def test_a_body_answers_for_itself(body: Body, is_plain: bool, is_known: bool) -> None:
    """It is plain if its energy alone moves it; causes are searched for if every part has its terms."""
    assert body.is_plain is is_plain
    assert are_known(body) is is_known


@pytest.mark.parametrize(
    "name",
    [
        *("outside:mujoco", "outside:basilisk", "outside:dop853"),
        *("geometric:splitting?step=0.1", "geometric:implicit-midpoint?step=1"),
    ],
)
def test_no_engine_and_no_method_takes_a_new_kind(name: str) -> None:
    """Whatever loads it takes, it names the part that it does not know, and takes the body without it."""
    solver: Any = solver_named(name)
    scene = replace(taylor_verify.load("euler/generic"), body=SprungBody(INERTIA))
    problem: Any = SimpleNamespace(scene=scene, given=scene, initial_momenta=(1, 1, 1))
    assert solver.unsuited(problem) == f"{solver.name} is made for a body without spring"
    problem.given = replace(scene, body=RigidBody(INERTIA))
    assert solver.unsuited(problem) == ""


def test_a_program_can_tell_a_new_kind() -> None:
    """The version of its question is beyond all that programs know."""
    assert protocol._version(SprungBody(INERTIA)) > max(protocol.VERSIONS.values())
    for body, version in (("rigid", 1), ("under a moment", 1), ("with wheels", 3), ("damped", 4)):
        assert protocol._version(BODIES[body][0]) == version


def test_causes_that_are_not_looked_for_are_told() -> None:
    """A failed answer about a new kind of body has a note in place of silence."""
    scene = taylor_verify.load("euler/generic")
    judged = taylor_verify.check(
        scene, lambda problem: [problem.given.initial.omega] * len(problem.times)
    )
    given = SimpleNamespace(body=SprungBody(INERTIA))
    problem: Any = SimpleNamespace(scene=scene, given=given)
    judged = with_causes(replace(judged, notes=()), problem, SimpleNamespace())  # type: ignore[arg-type]
    assert judged.notes == (NOT_LOOKED_FOR,)


# What the truth asks of a kind

SAMPLES = {
    "euler": (RigidBody(TENSOR, MOMENT), SPIN),
    "wheels": (RigidBody(TENSOR, MOMENT, OMEGA), SPIN),
    "kirchhoff": (LOADED, IMPULSE),
}


def exact_rates(equations: Equations, z: Sequence[Fraction]) -> list[Fraction]:
    """The right-hand side at z, exactly."""
    linear, quadratic = equations.linear @ exact(z), exact(z) @ equations.hessian @ exact(z) / 2
    return list(equations.constant + linear + quadratic)


def test_every_shipped_body_has_a_kind() -> None:
    """No scene has a body of a type without a line in the registry, and no line is without a scene."""
    assert {type(load(name).body) for name in names()} == set(KINDS)


@pytest.mark.parametrize("model", SAMPLES)
def test_the_momentum_has_the_equations_of_the_state(model: str) -> None:
    """Its rate is the momentum of the rate of z, its spin and energy are those of z; exactly."""
    body, initial = SAMPLES[model]
    kind: Any = kind_of(body)
    z = kind.state(initial)
    p = kind.momentum(body, z)
    assert kind.of_momentum(body, p) == z
    assert kind.with_state(initial, z) == initial
    by_state, by_momentum = kind.equations(body), kind.momentum_equations(body)
    assert tuple(exact_rates(by_momentum, p)) == kind.momentum(
        body, tuple(exact_rates(by_state, z))
    )
    assert (by_momentum.spin @ exact(p) == by_state.spin @ exact(z)).all()
    energy = dot(z, apply(kind.energy(body), z))
    assert dot(p, apply(kind.momentum_energy(body), p)) == energy
