"""Damping handed to solvers: followed, or refused by name; never left out without a word."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest

from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers.precision import rung
from taylor_verify.records.status import Status
from taylor_verify.run import run
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.process import protocol
from taylor_verify.solvers.registry import solver_named


def short(name: str, **changes: object) -> Scene:
    """The first samples of a scene, its body changed."""
    scene = load(name)
    clock = Clock(scene.clock.start, tuple(scene.clock.instants)[:6])
    return replace(scene, clock=clock, body=replace(scene.body, **changes))  # type: ignore[type-var]


def posed(scene: Scene, on: str = "f64") -> Problem:
    return pose(scene, rung(on))


RIGID, FLUID, WHEELS = "euler/damped", "kirchhoff/damped", "euler/gyrostat"


@pytest.mark.parametrize(
    ("scene", "solver"),
    [
        (RIGID, "geometric:lie-rk4?step=0.02"),
        (RIGID, "scipy:DOP853?rtol=1e-12&atol=1e-14"),
        (FLUID, "scipy:DOP853?rtol=1e-12&atol=1e-14"),
        (RIGID, "mpmath:odefun"),
    ],
)
def test_a_solver_follows_it(scene: str, solver: str) -> None:
    """Solvers that can follow a decay come as near to the exact motion as their method allows."""
    judgement = run(short(scene), solver_named(solver), rung("f64"), tolerance=1e-8)
    assert {verdict.verdict for verdict in judgement.verdicts} == {Status.PASS}


def test_lie_rk4_keeps_the_order_four() -> None:
    """Half the step leaves a sixteenth of the error of omega, and |H| e^{ct} to roundoff."""
    errors = []
    for step in ("0.1", "0.05"):
        convergence = run(
            short(RIGID), solver_named(f"geometric:lie-rk4?step={step}"), rung("f64"), tolerance=0.5
        )
        by_name = {verdict.quantity: verdict for verdict in convergence.verdicts}
        assert by_name["H2"].max is not None
        assert by_name["H2"].max <= 1e-13
        errors.append(by_name["omega"].max or 0.0)
    assert 14 <= errors[0] / errors[1] <= 18


@pytest.mark.parametrize(("scene", "others"), [(RIGID, set()), (FLUID, set()), (WHEELS, {"rotor"})])
def test_the_question_has_a_version_of_its_own(scene: str, others: set[str]) -> None:
    """Programs are asked by version 4, also with wheels; the damping is a text and a float."""
    asked = protocol.question(posed(short(scene, damping=Fraction(1, 8))))
    assert asked["protocol"] == 4
    assert {"damping", *others} <= set(asked["body"])
    assert asked["body"]["damping"] == {"text": "0.125", "hex": "0x1p-3"}
    plain = protocol.question(posed(short(scene, damping=Fraction(0))))
    assert plain["protocol"] == (3 if others else 1)
    assert "damping" not in plain["body"]
