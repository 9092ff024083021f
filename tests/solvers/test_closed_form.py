"""The closed form in plain doubles: right where it can be, and where it fails it is seen to."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import inf

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.judge.errors.state import largest, state_errors
from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import rung
from taylor_verify.records.status import Status
from taylor_verify.run import run
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Clock, Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.registry import solver_named
from taylor_verify.solvers.trajectory import Outcome
from taylor_verify.tradeoff.accuracy import Truth

pytest.importorskip("scipy", reason="an optional extra: taylor-verify[scipy]")

NAME = "closed-form:ellipj"
F64 = rung("f64")
# Of the largest |omega|: a dozen roundings of numbers of size one, and some of u = lam t + u0 < 100.
GOOD = 1e-12


def generic(**changed: object) -> Scene:
    return replace(load("euler/generic"), **changed)


def until(scene: Scene, end: Fraction) -> Scene:
    times = tuple(end * k / 10 + Fraction(k, 7) for k in range(11))
    return replace(scene, clock=Clock(Fraction(0), times))


def beside_the_middle_axis(digits: int) -> Scene:
    small = Fraction(1, 10**digits)
    return replace(load("euler/tennis-racket"), initial=Spin((small, Fraction(1), small)))


def error(scene: Scene) -> float:
    problem = pose(scene, F64)
    trajectory = solver_named(NAME).solve(problem)
    return (
        Truth(problem).accuracy(trajectory).worst if trajectory.outcome is Outcome.FINISHED else inf
    )


# Where it is right.


def independent_error(problem: Problem) -> float:
    """Against the Taylor route, which knows no elliptic function."""
    trajectory = solver_named(NAME).solve(problem)
    assert trajectory.outcome is Outcome.FINISHED, trajectory.detail
    truth = TaylorSolution(problem.given).motion(problem.given.clock.elapsed, 20)
    (errors,) = state_errors(problem.given, truth, trajectory.motion(150))
    return float(largest(errors.values))


COMPONENT = st.fractions(-2, 2, max_denominator=8)


@settings(max_examples=40)
@given(
    st.tuples(*[st.integers(2, 12)] * 3),
    st.tuples(COMPONENT, COMPONENT, COMPONENT),
    st.sampled_from([1, -1]),
)
def test_every_octant_and_order_of_axes(
    moments: tuple[int, int, int], omega: tuple[Fraction, ...], direction: int
) -> None:
    """Any order of the moments, any signs, zeros among the components, either direction of time."""
    assume(len(set(moments)) == 3)
    j1, j2, j3 = moments
    # A real body that is no needle; the orbit away from its separatrix, where the doubles are at fault.
    twice_T = sum(j * w * w for j, w in zip(moments, omega, strict=True))
    squared = sum((j * w) ** 2 for j, w in zip(moments, omega, strict=True))
    assume(squared and abs(squared - sorted(moments)[1] * twice_T) > squared / 1000)
    body = RigidBody(tensors.diagonal((Fraction(j1), Fraction(j2), Fraction(j3))))
    clock = Clock(Fraction(0), tuple(Fraction(direction * k, 3) for k in range(4)))
    scene = generic(body=body, initial=Spin(omega), clock=clock)
    assert independent_error(pose(scene, F64)) <= GOOD


@pytest.mark.parametrize(
    "name", ["generic", "full-tensor", "about-max-axis", "backward", "later-start", "apollo"]
)
def test_shipped_scenes(name: str) -> None:
    """A full tensor goes through its principal axes; the start may be later, and time run backward."""
    assert error(load(f"euler/{name}")) <= GOOD


# Where it fails.


def test_the_error_grows_in_proportion_to_time() -> None:
    """No step is taken, and the phase is still lost: u is known to some 2^-53 of itself."""
    errors = {end: error(until(load("euler/generic"), Fraction(end))) for end in (10**8, 10**12)}
    u = float(F64.unit_roundoff)
    for end, error_then in errors.items():
        # From a hundredth of one rounding of the phase to a dozen of them.
        assert u * end / 100 <= error_then <= 12 * u * end
    assert errors[10**12] >= 100 * errors[10**8]


def test_beside_the_separatrix_it_claims_success_with_nonsense() -> None:
    """Below 1 - m = 1e-10 the answer is wrong by any factor, reported as finished; the judge fails it."""
    assert error(beside_the_middle_axis(2)) <= GOOD
    assert error(beside_the_middle_axis(6)) > 1
    (_, omega, *_) = run(beside_the_middle_axis(6), NAME, causes=False).verdicts
    assert omega.outcome == Outcome.FINISHED.value
    assert omega.verdict is Status.FAIL


def test_about_the_middle_axis_it_has_no_number() -> None:
    """The phase is infinite, and that is said; the integrator has no difficulty."""
    problem = pose(load("euler/steady-middle-axis"), F64)
    trajectory = solver_named(NAME).solve(problem)
    assert trajectory.outcome is Outcome.NON_FINITE
    assert not trajectory.quantities
    assert {v.verdict for v in run("euler/steady-middle-axis").verdicts} == {Status.PASS}


# What it is not made for.


@pytest.mark.parametrize(
    ("scene", "reason"),
    [
        ("kirchhoff/screw", "made for Euler's equations, got kirchhoff"),
        ("euler/constant-moment", "a body without a moment"),
        ("euler/with-attitude", "omega and no attitude"),
        ("euler/spherical", "three distinct principal moments"),
        ("euler/rest", "a body that turns"),
    ],
)
def test_it_says_beforehand_what_it_is_not_made_for(scene: str, reason: str) -> None:
    """The run is not begun, is counted as unavailable, and fails no gate."""
    (verdict,) = run(scene, NAME).verdicts
    assert verdict.verdict is Status.UNAVAILABLE
    assert reason in verdict.because
    solved = solver_named(NAME).solve(pose(load(scene), F64))
    assert solved.outcome is Outcome.NOT_STARTED
    assert reason in solved.detail
