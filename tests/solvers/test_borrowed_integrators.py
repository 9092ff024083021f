"""SciPy's solve_ivp and mpmath's odefun as solvers: what they answer and count, and how a run can end."""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from typing import Any

import pytest
from builders.scenes import asked_at
from builders.turns import by_turns
from hypothesis import given
from hypothesis import strategies as st

from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers.precision import rung
from taylor_verify.records.status import Status
from taylor_verify.run import run
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers import odefun
from taylor_verify.solvers import scipy as solver
from taylor_verify.solvers.registry import solver_named
from taylor_verify.solvers.straight_line import straight_line
from taylor_verify.solvers.trajectory import Outcome

F64 = rung("f64")
ODEFUN = "mpmath:odefun"


def short(scene: str) -> Scene:
    """The first seven units of time of a shipped scene; the start is no sample."""
    return asked_at(scene, *range(1, 8))


def shorter(scene: str, end: Fraction = Fraction(2)) -> Scene:
    return asked_at(scene, 0, end / 3, end)


# SciPy.


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


def test_loads_damping_and_time_running_backward() -> None:
    """The problem's own equations are solved, whatever is in them, in either direction."""
    loaded = ("euler/constant-moment", "kirchhoff/constant-loads")
    for name in (*loaded, "euler/damped", "kirchhoff/damped", "euler/backward"):
        (_, verdict, *_) = run(name, "scipy:DOP853?rtol=1e-10&atol=1e-10", causes=False).verdicts
        # Three digits for what an orbit makes of the errors of its steps.
        assert verdict.max <= 1e-7


def test_steps_and_evaluations_are_counted() -> None:
    """DOP853 takes at least 11 evaluations a step, and more steps for a finer tolerance."""
    problem = pose(short("euler/generic"), F64)
    coarse, fine = (
        solver_named(f"scipy:DOP853?rtol={tolerance}&atol={tolerance}").solve(problem)
        for tolerance in ("1e-6", "1e-10")
    )
    assert 11 * coarse.steps <= coarse.evaluations
    assert fine.steps > coarse.steps > 0


@pytest.mark.parametrize("method", solver.METHODS)
def test_rates_that_are_no_numbers_end_the_run(
    method: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """NaN in the rates ends the run at once, where SciPy's explicit methods would try for ever."""
    monkeypatch.setattr(solver, "_MOST_EVALUATIONS", 1000)
    assert without_numbers(f"scipy:{method}") is Outcome.NON_FINITE


def without_numbers(name: str) -> Outcome:
    """The outcome of rates that are NaN."""
    nowhere = {f"H{i}": float("nan") for i in (1, 2, 3)}
    problem = pose(short("euler/generic"), F64).with_equations(lambda named: nowhere)
    trajectory = solver_named(name).solve(problem)
    assert not trajectory.quantities
    return trajectory.outcome


# mpmath.


@pytest.mark.parametrize(
    ("scene", "on", "end"),
    [
        ("euler/with-attitude", "f64", 2),
        ("euler/constant-moment", "f64", 2),
        ("euler/damped", "f64", 2),
        ("kirchhoff/whole-motion", "f64", 2),
        ("euler/generic", "mp120", 2),
        # odefun knows no time before its start; the opposite rates lead there.
        ("euler/generic", "f64", -2),
    ],
)
def test_odefun_passes_every_gate(scene: str, on: str, end: int) -> None:
    """The series of odefun has all bits of the rung, for both models, in either direction."""
    verdicts = run(shorter(scene, Fraction(end)), ODEFUN, on).verdicts
    assert {v.verdict for v in verdicts} == {Status.PASS}
    assert verdicts[0].evaluations >= verdicts[0].steps > 0


def test_a_tolerance_is_taken() -> None:
    """A coarser one takes less work and leaves a larger error."""
    scene = shorter("euler/generic")
    coarse, fine = (
        run(scene, f"{ODEFUN}?tol={tol}&degree=4", causes=False).verdicts[1]
        for tol in ("1e-3", "1e-9")
    )
    assert coarse.evaluations < fine.evaluations
    assert fine.max < coarse.max


def test_the_degree_is_taken() -> None:
    """A series of a lower degree holds for a shorter time, so that there are more of them."""
    problem = pose(shorter("euler/generic"), F64)
    low, high = (solver_named(f"{ODEFUN}?degree={n}").solve(problem) for n in (8, 24))
    assert low.steps > high.steps
    assert high.evaluations == 24 * high.steps


@pytest.mark.parametrize("on", ["f32", "f80", "f128"])
def test_other_formats_are_unavailable(on: str) -> None:
    """mpmath has bits and no formats: what it has no exponents for it does not claim to be."""
    (verdict,) = run(shorter("euler/generic"), ODEFUN, on).verdicts
    assert verdict.verdict is Status.UNAVAILABLE
    assert "mpN alone" in verdict.because


def test_nan_is_never_an_answer_of_odefun() -> None:
    assert without_numbers(ODEFUN) in (Outcome.NON_FINITE, Outcome.RAISED)


# Both.


@pytest.mark.parametrize(
    ("module", "most", "name"), [(solver, 100, "scipy:RK45?rtol=1e-9"), (odefun, 30, ODEFUN)]
)
def test_a_run_without_end_is_stopped(
    module: Any, most: int, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """There is a bound on the evaluations."""
    monkeypatch.setattr(module, "_MOST_EVALUATIONS", most)
    trajectory = solver_named(name).solve(pose(short("euler/generic"), F64))
    assert trajectory.outcome is Outcome.STEP_LIMIT
    assert not trajectory.quantities


# The equations as straight-line code, which SciPy evaluates: the same numbers, each operation once.


SCENES = (
    *("euler/full-tensor", "euler/with-attitude", "euler/constant-moment", "euler/spherical"),
    *("kirchhoff/whole-motion", "kirchhoff/general-body", "kirchhoff/constant-loads"),
)


@cache
def problem_of(scene: str) -> Problem:
    return pose(load(scene), rung("f64"))


def plain(problem: Problem) -> list[float]:
    return [float(value) for value in problem.parameters]


@pytest.mark.parametrize("scene", SCENES)
@given(st.lists(st.floats(-4, 4), min_size=13, max_size=13))
def test_the_rates_are_the_same_to_the_last_bit(scene: str, numbers: list[float]) -> None:
    """In floats nothing may be summed or multiplied in another order."""
    problem = problem_of(scene)
    state = numbers[: len(problem.form.states)]
    rates = straight_line(problem.form, plain(problem))(0.0, state)
    assert rates == problem.form.rates(state, plain(problem))


@pytest.mark.parametrize("scene", SCENES)
def test_any_arithmetic_passes_through(scene: str) -> None:
    """With rationals in, the rates are rationals, and the exact ones."""
    problem = problem_of(scene)
    state = [Fraction(k + 1, 7) for k in range(len(problem.form.states))]
    rates = straight_line(problem.form, problem.parameters)(0, state)
    exact = problem.form.rates(state, list(problem.parameters))
    # A rate that is absent is the integer 0, which is a rational too.
    assert rates == exact
    assert all(isinstance(value, Fraction | int) for value in rates)
