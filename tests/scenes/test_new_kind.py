"""A kind of body that nobody knows yet: rooms ask it, and none takes it for one that they know."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import pytest

import taylor_verify
from taylor_verify.judge.causes.likely import NOT_LOOKED_FOR, with_causes
from taylor_verify.judge.causes.material import are_known
from taylor_verify.numbers.tensors import Vector, diagonal
from taylor_verify.scenes.bodies import Body, RigidBody
from taylor_verify.scenes.named_numbers import NUMBER, Part, Shape
from taylor_verify.solvers.process import protocol
from taylor_verify.solvers.registry import solver_named

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


@pytest.mark.parametrize("name", ["outside:mujoco", "outside:basilisk", "outside:dop853"])
def test_an_engine_does_not_take_a_new_kind(name: str) -> None:
    """Whatever loads it takes, it names the part that it does not know."""
    engine: Any = solver_named(name)
    problem = SimpleNamespace(given=SimpleNamespace(model="euler", body=SprungBody(INERTIA)))
    assert engine.unsuited(problem) == f"{engine.name} is made for a body without spring"
    problem.given.body = RigidBody(INERTIA)
    assert engine.unsuited(problem) == ""


@pytest.mark.parametrize(
    "name", ["geometric:splitting?step=0.1", "geometric:implicit-midpoint?step=1"]
)
def test_a_method_for_bodies_it_knows_does_not_take_a_new_kind(name: str) -> None:
    """A method names the part that it does not know, and takes the same body without it."""
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
