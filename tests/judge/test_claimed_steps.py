"""The steps that somebody claims: they widen a gate as far as they are plausible, and no further."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from time import sleep
from typing import Any, final

import pytest

from taylor_verify.exact.route import solution
from taylor_verify.judge.floor.attainable import orbit_of, radians
from taylor_verify.judge.floor.counted_steps import (
    STEPS_PER_RADIAN,
    STEPS_PER_SECOND,
    WIDENING,
    count_steps,
)
from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers.precision import rung
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.run import run
from taylor_verify.scenes.motion import Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.callback import Callback
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.solvers.trajectory import Trajectory

SCENE = "euler/generic"
MANY = 2**32 - 1
FAST = Fraction(1, 10**11)


def hasty(problem: Problem, error: Fraction = FAST) -> Any:
    """The exact motion by a clock that runs fast."""
    given = problem.given
    times = [t * (1 + error) for t in given.clock.elapsed]
    return solution(given).evaluate(times, 25)["omega"].astype(float)


@final
@dataclass(frozen=True)
class Boaster(Solver):
    """A broken twin: a clock that is wrong by ``error``, and a claim of ``steps``."""

    steps: int
    error: Fraction = FAST
    name: str = "boaster"

    def solve(self, problem: Problem) -> Trajectory:
        # Long enough for the claim that the orbit leaves room for: the time must not decide here.
        sleep(0.05)
        trajectory = Callback(lambda asked: hasty(asked, self.error)).solve(problem)
        return replace(trajectory, steps=self.steps)


def omega(solver: Solver | str) -> Verdict:
    return next(v for v in run(SCENE, solver, causes=False).verdicts if v.quantity == "omega")


@pytest.mark.parametrize("steps", [0, 1000, 10**6, MANY, 10**30])
def test_a_wrong_clock_fails_whatever_it_claims(steps: int) -> None:
    """A clock that is wrong by 1e-11 is caught with any number of claimed steps."""
    verdict = omega(Boaster(steps))
    assert verdict.verdict is Status.FAIL
    assert verdict.max == pytest.approx(3.39e-10, rel=1e-2)


@pytest.mark.parametrize("steps", [0, 10**6, MANY])
def test_its_sound_twin_passes_and_more_claims_widen_by_the_stated_factor(steps: int) -> None:
    """An exact clock passes; its bound exceeds that of steps of 1/100 radian ten times at most."""
    fine, claimed = (omega(Boaster(n, Fraction(0))) for n in (11_000, steps))
    assert claimed.verdict is Status.PASS
    assert claimed.bound is not None
    assert fine.bound is not None
    assert claimed.bound <= WIDENING * fine.bound * 1.05


def test_the_row_says_how_many_steps_are_counted() -> None:
    """The reason has the claim, the number that is counted, and its arithmetic."""
    because = omega(Boaster(MANY)).because
    turned = radians(orbit_of(load(SCENE)))
    most = int(WIDENING**2 * (101 + STEPS_PER_RADIAN * turned))
    assert (
        f"it claims {MANY} steps; at most {most} are counted, {WIDENING}^2 x (101 samples"
        in because
    )
    assert f"for each of the {turned:.3g} radians of the orbit" in because
    assert "claims" not in omega(Boaster(1000)).because


def test_an_rk4_of_small_steps_is_believed() -> None:
    """A step of 1e-4 over t = 100 on an orbit of a radian per unit of time is counted whole."""
    problem = pose(load(SCENE), rung("f64"))
    steps = count_steps(problem, Callback(hasty), 10**6, seconds=1.0)
    assert (steps.counted, steps.claim) == (10**6, None)


def test_no_more_steps_are_counted_than_a_processor_does() -> None:
    """In a hundredth of a second there is time for a million steps, and that is said."""
    problem = pose(load(SCENE), rung("f64"))
    steps = count_steps(problem, Callback(hasty), MANY, seconds=0.001)
    assert steps.counted == int(STEPS_PER_SECOND * 0.001)
    assert "seconds that it took" in steps.claim.limit


def test_a_solver_of_this_project_counts_its_own() -> None:
    """Steps that our own loop has counted are no claim."""
    problem = pose(load(SCENE), rung("f64"))
    assert Taylor.counts_steps
    assert count_steps(problem, Taylor(), MANY, seconds=1e-9).counted == MANY
    assert not Callback.counts_steps


def test_a_sphere_turns_too() -> None:
    """A sphere turns without a change of omega, and its radians count all the same."""
    sphere = load("euler/spherical")
    end = float(sphere.clock.elapsed[-1])
    assert isinstance(sphere.initial, Spin)
    speed = sum(float(w) ** 2 for w in sphere.initial.omega) ** 0.5
    assert radians(orbit_of(sphere)) == pytest.approx(speed * end, rel=0.2)
