"""SciPy's solve_ivp as a solver: what it answers, counts, refuses, and how a run can end."""

from __future__ import annotations

from typing import Any

import pytest
from builders.scenes import asked_at
from builders.turns import by_turns

from taylor_verify.models.problem import pose
from taylor_verify.numbers.precision import rung
from taylor_verify.run import run
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers import scipy as solver
from taylor_verify.solvers.registry import solver_named
from taylor_verify.solvers.trajectory import Outcome

F64 = rung("f64")


def short(scene: str) -> Scene:
    """The first seven units of time of a shipped scene; the start is no sample."""
    return asked_at(scene, *range(1, 8))


@pytest.fixture
def scipy() -> Any:
    return pytest.importorskip("scipy", reason="an optional extra: taylor-verify[scipy]")


# What it answers.


@pytest.mark.usefixtures("scipy")
@pytest.mark.parametrize("method", solver.METHODS)
@pytest.mark.parametrize("name", by_turns(["euler/with-attitude", "kirchhoff/whole-motion"], 2))
def test_the_answer_approaches_the_exact_motion(method: str, name: str) -> None:
    """Each method, for both models, every quantity: with a tolerance 10^4 smaller it is far closer."""
    scene = short(name)
    coarse = run(scene, f"scipy:{method}?rtol=1e-4&atol=1e-4", causes=False).verdicts
    fine = run(scene, f"scipy:{method}?rtol=1e-8&atol=1e-8", causes=False).verdicts
    quantities = {"euler": {"omega", "attitude"}, "kirchhoff": {"impulse", "attitude", "centre"}}
    compared = 0
    for before, after in zip(coarse, fine, strict=True):
        if after.quantity in quantities[scene.model]:
            compared += 1
            # The local error is what a tolerance bounds; a step can do well by chance, hence 100.
            assert after.max <= before.max / 100
    assert compared == len(quantities[scene.model])


@pytest.mark.usefixtures("scipy")
def test_loads_damping_and_time_running_backward() -> None:
    """The problem's own equations are solved, whatever is in them, in either direction."""
    loaded = ("euler/constant-moment", "kirchhoff/constant-loads")
    for name in (*loaded, "euler/damped", "kirchhoff/damped", "euler/backward"):
        (_, verdict, *_) = run(name, "scipy:DOP853?rtol=1e-10&atol=1e-10", causes=False).verdicts
        # Three digits for what an orbit makes of the errors of its steps.
        assert verdict.max <= 1e-7


@pytest.mark.usefixtures("scipy")
def test_steps_and_evaluations_are_counted() -> None:
    """DOP853 takes at least 11 evaluations a step, and more steps for a finer tolerance."""
    trajectory = solver_named("scipy:DOP853?rtol=1e-6").solve(pose(short("euler/generic"), F64))
    assert trajectory.outcome is Outcome.FINISHED
    assert 11 * trajectory.steps <= trajectory.evaluations
    finer = solver_named("scipy:DOP853?rtol=1e-10&atol=1e-10").solve(
        pose(short("euler/generic"), F64)
    )
    assert finer.steps > trajectory.steps > 0


# How a run ends that is none.


@pytest.mark.usefixtures("scipy")
def test_a_run_without_end_is_stopped(monkeypatch: pytest.MonkeyPatch) -> None:
    """There is a bound on the evaluations."""
    monkeypatch.setattr(solver, "_MOST_EVALUATIONS", 100)
    trajectory = solver_named("scipy:RK45?rtol=1e-9").solve(pose(short("euler/generic"), F64))
    assert trajectory.outcome is Outcome.STEP_LIMIT
    assert not trajectory.quantities


@pytest.mark.usefixtures("scipy")
@pytest.mark.parametrize("method", solver.METHODS)
def test_rates_that_are_no_numbers_are_an_outcome(
    method: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """NaN in the rates ends the run at once, where SciPy's explicit methods would try for ever."""
    monkeypatch.setattr(solver, "_MOST_EVALUATIONS", 1000)
    nowhere = {f"H{i}": float("nan") for i in (1, 2, 3)}
    problem = pose(short("euler/generic"), F64).with_equations(lambda named: nowhere)
    trajectory = solver_named(f"scipy:{method}").solve(problem)
    assert trajectory.outcome is Outcome.NON_FINITE
    assert not trajectory.quantities
