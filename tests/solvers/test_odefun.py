"""mpmath's odefun as a solver: what it answers on which rungs, and how a run can end."""

from __future__ import annotations

from fractions import Fraction

import pytest
from builders.scenes import asked_at
from mpmath import mp

from taylor_verify.models.problem import pose
from taylor_verify.numbers.precision import rung
from taylor_verify.records.status import Status
from taylor_verify.run import run
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers import odefun
from taylor_verify.solvers.registry import solver_named
from taylor_verify.solvers.trajectory import Outcome

NAME = "mpmath:odefun"


def short(scene: str, end: Fraction = Fraction(2)) -> Scene:
    return asked_at(scene, 0, end / 3, end)


@pytest.mark.parametrize(
    ("scene", "on"),
    [
        ("euler/with-attitude", "f64"),
        ("euler/constant-moment", "f64"),
        ("euler/damped", "f64"),
        ("kirchhoff/whole-motion", "f64"),
        ("euler/generic", "mp120"),
    ],
)
def test_it_passes_every_gate(scene: str, on: str) -> None:
    """The series of odefun has all bits of the rung, for both models."""
    verdicts = run(short(scene), NAME, on).verdicts
    assert {v.verdict for v in verdicts} == {Status.PASS}
    assert verdicts[0].evaluations >= verdicts[0].steps > 0


def test_time_running_backward() -> None:
    """odefun knows no time before its start; the opposite rates lead there."""
    verdicts = run(short("euler/generic", Fraction(-2)), NAME).verdicts
    assert {v.verdict for v in verdicts} == {Status.PASS}


def test_a_tolerance_is_taken() -> None:
    """A coarser one takes less work and leaves a larger error."""
    scene = short("euler/generic")
    coarse, fine = (
        run(scene, f"{NAME}?tol={tol}&degree=4", causes=False).verdicts[1]
        for tol in ("1e-3", "1e-9")
    )
    assert coarse.evaluations < fine.evaluations
    assert fine.max < coarse.max


def test_the_degree_is_taken() -> None:
    """A series of a lower degree holds for a shorter time, so that there are more of them."""
    problem = pose(short("euler/generic"), rung("f64"))
    low, high = (solver_named(f"{NAME}?degree={n}").solve(problem) for n in (8, 24))
    assert low.steps > high.steps
    assert high.evaluations == 24 * high.steps


@pytest.mark.parametrize("on", ["f32", "f80", "f128"])
def test_other_formats_are_unavailable(on: str) -> None:
    """mpmath has bits and no formats: what it has no exponents for it does not claim to be."""
    (verdict,) = run(short("euler/generic"), NAME, on).verdicts
    assert verdict.verdict is Status.UNAVAILABLE
    assert "mpN alone" in verdict.because


def test_a_run_without_end_is_stopped(monkeypatch: pytest.MonkeyPatch) -> None:
    """There is a bound on the evaluations."""
    monkeypatch.setattr(odefun, "_MOST_EVALUATIONS", 30)
    trajectory = solver_named(NAME).solve(pose(short("euler/generic"), rung("f64")))
    assert trajectory.outcome is Outcome.STEP_LIMIT
    assert not trajectory.quantities


def test_rates_that_are_no_numbers_are_an_outcome() -> None:
    """NaN in the rates is never an answer."""
    nowhere = {f"H{i}": mp.nan for i in (1, 2, 3)}
    problem = pose(short("euler/generic"), rung("f64")).with_equations(lambda named: nowhere)
    trajectory = solver_named(NAME).solve(problem)
    assert trajectory.outcome in (Outcome.NON_FINITE, Outcome.RAISED)
    assert not trajectory.quantities
