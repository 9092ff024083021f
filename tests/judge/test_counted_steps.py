"""Steps in the roundoff floor: those that add the same amount, and those that somebody claims."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from time import sleep
from typing import Any, final

import numpy as np
import pytest
from builders.honest import Answer, Push, Rows, answers
from builders.scenes import LOADED, TENSOR, sample_scene, tracking_all, vector
from builders.turns import by_turns

from taylor_verify import check
from taylor_verify.exact.conditioning.condition import path
from taylor_verify.exact.route import solution
from taylor_verify.judge.floor.attainable import orbit_of, radians
from taylor_verify.judge.floor.counted_steps import (
    STEPS_PER_RADIAN,
    STEPS_PER_SECOND,
    WIDENING,
    count_steps,
)
from taylor_verify.judge.floor.repeats import with_repeats
from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import rung
from taylor_verify.records.quantities import CONSERVED_QUANTITIES
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.run import run
from taylor_verify.scenes.bodies import Body, Clebsch, RigidBody
from taylor_verify.scenes.motion import Clock, Impulse, Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.callback import Callback
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.solvers.trajectory import Trajectory

# The number of steps of a run, one from row to row.
STEPS = 200
SPHERE = RigidBody(tensors.diagonal(vector(2, 2, 2)), vector("0.1", "0.03", "-0.02"))
AXIS = RigidBody(tensors.diagonal(vector(1, 2, 3)), vector(0, "0.1", 0))
SPINS = {"sphere": (SPHERE, ("0.3", "0.5", "0.7")), "axis": (AXIS, ("0", "0.6", "0"))}
WORDS = "each step adds nearly the same amount here"


def spun(body: Body, omega: Sequence[float | str], end: int = 3, steps: int = STEPS) -> Scene:
    """A spin of a body, asked once in every step."""
    scene = sample_scene(body, start=Spin(vector(*omega)))
    return replace(scene, clock=clock(end, steps))


def clock(end: int, steps: int) -> Clock:
    # A step of few bits, which every precision holds.
    row = Fraction(round(2**14 * end / steps), 2**14)
    return Clock(Fraction(0), tuple(k * row for k in range(steps + 1)))


def repeated(scene: Scene, steps: int, bits: int) -> Rows:
    """The size of a rounding with those alike before it, over its own, by time and component."""
    orbit = path(scene)
    times = np.array([abs(float(t)) for t in orbit.elapsed])
    steps_at = np.diff(times, prepend=0.0) * steps / times[-1]
    steps_at[0] = 1.0
    single = np.ones((len(times), 3 * len(orbit.blocks)))
    return with_repeats(single, orbit, steps_at, steps, bits)


# Motions.

GENERIC = {
    "free": spun(RigidBody(TENSOR), ("0.3", 1, "0.2")),
    "moment": spun(RigidBody(TENSOR, vector("0.1", "-0.2", "0.05")), ("0.3", 1, "0.2")),
    "in a fluid": replace(tracking_all(sample_scene(LOADED)), clock=clock(3, STEPS)),
    "free sphere": spun(RigidBody(tensors.diagonal(vector(2, 2, 2))), ("0.3", 1, "0.2")),
}


@pytest.mark.parametrize("name", by_turns(GENERIC))
def test_floor_of_a_generic_orbit_is_that_of_independent_roundings(name: str) -> None:
    """Increments that vary by many units, or that are zero, leave each rounding as it is."""
    assert (repeated(GENERIC[name], 50, 53) == 1.0).all()


@pytest.mark.parametrize("name", SPINS)
@pytest.mark.parametrize("bits", [24, 53, 237])
def test_floor_grows_with_the_steps_where_increments_repeat(name: str, bits: int) -> None:
    """A hundred times the steps make a hundred times the floor of T, and ten times on a generic orbit."""
    scene, generic = spun(*SPINS[name]), GENERIC["moment"]
    few, many = (np.sum(repeated(scene, n, bits) ** 2) * n for n in (100, 10000))
    assert many / few == pytest.approx(100**2, rel=0.05)
    if bits > 24:
        few, many = (np.sum(repeated(generic, n, bits) ** 2) * n for n in (100, 10000))
        assert many / few == pytest.approx(100, rel=1e-12)


def test_centre_repeats_along_a_straight_line() -> None:
    """A solid that goes straight ahead adds the same to its centre in each step, along the line alone."""
    body = Clebsch(*vector(1, 2, 0, 0, 1, "0.5")).body()
    start = Impulse(vector(0, 0, 1), vector(0, 0, 0), centre=vector(1, 2, 3))
    scene = replace(sample_scene(body, "attitude", "centre", start=start), clock=clock(3, 20))
    sizes = repeated(scene, 100, 53)[-1]
    assert (sizes[:-1] == 1.0).all()
    # The last steps have a hundred alike ones before them.
    assert sizes[-1] == pytest.approx((2 * 100) ** 0.5, rel=0.1)


def test_damped_body_at_its_final_spin_repeats() -> None:
    """Where a moment balances damping, an answer that is off adds the same amount again and again."""
    body = RigidBody(
        tensors.diagonal(vector(2, 2, 2)), vector("0.2", 0, 0), damping=Fraction(1, 10)
    )
    sizes = repeated(spun(body, (1, 0, 0)), 100, 53)[-1]
    assert sizes[0] == pytest.approx((2 * 100) ** 0.5, rel=0.1)
    assert (sizes[1:] == 1.0).all()


# Verdicts.

pytestmark = pytest.mark.usefixtures("without_causes")


def conserved(scene: Scene, answer: Answer) -> list[Verdict]:
    """The verdicts on T and H2 of a float32 answer."""
    verdicts = check(scene, answer, "f32").verdicts
    return [verdict for verdict in verdicts if verdict.quantity in CONSERVED_QUANTITIES]


def biased(units: int) -> Push:
    """A step that is too large by so many units in the last place."""
    return lambda before, after: after + np.float32(units) * np.spacing(after)


@pytest.mark.parametrize("name", by_turns(SPINS, 2))
def test_sentence_says_that_roundings_add_up(name: str) -> None:
    """The reason says in words why the floor grows in proportion to the number of steps."""
    scene = spun(*SPINS[name])
    (answer,) = answers([scene], "f32", 1)
    for verdict in conserved(scene, answer):
        assert verdict.verdict is Status.PASS
        assert WORDS in verdict.because
        assert 1 < verdict.reason.floor.alike <= verdict.reason.floor.steps


@pytest.mark.parametrize("name", by_turns(SPINS, 2))
def test_bias_of_ten_units_in_each_step_is_caught(name: str) -> None:
    """A broken twin whose steps all err one way, ten times as much as a rounding, fails every gate."""
    scene = spun(*SPINS[name])
    (answer,) = answers([scene], "f32", 1, biased(10))
    assert {verdict.verdict for verdict in check(scene, answer, "f32").verdicts[1:]} == {
        Status.FAIL
    }


def test_bias_of_one_unit_in_each_step_is_caught_on_a_generic_orbit() -> None:
    """Where increments do not repeat, one unit in the last place of each step fails T and H2."""
    scene = spun(RigidBody(TENSOR), ("0.3", 1, "0.2"), 20)
    sound, twin = (answers([scene], "f32", 1, biased(n))[0] for n in (0, 1))
    assert {verdict.verdict for verdict in conserved(scene, sound)} == {Status.PASS}
    assert {verdict.verdict for verdict in conserved(scene, twin)} == {Status.FAIL}
    assert not any(WORDS in verdict.because for verdict in conserved(scene, twin))


# The steps that somebody claims: they widen a gate as far as they are plausible, and no further.


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
    speed = sum(float(w) ** 2 for w in sphere.initial.omega) ** 0.5
    assert radians(orbit_of(sphere)) == pytest.approx(speed * end, rel=0.2)
