"""Problems side by side in heyoka's batches: each has the answer that it has alone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from builders.satellites import satellites
from builders.scenes import tracking_all

from taylor_verify.models.problem import Problem, pose
from taylor_verify.models.rates import Linearised, momenta
from taylor_verify.run import run
from taylor_verify.scenes.precision import rung
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.registry import solver_named
from taylor_verify.solvers.taylor import together
from taylor_verify.solvers.taylor.alike import Alike
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.solvers.taylor.lanes import propagate
from taylor_verify.solvers.taylor.neighbours import neighbours
from taylor_verify.solvers.taylor.rate_bound import Look, rate_bound
from taylor_verify.solvers.taylor.together import solve_together
from taylor_verify.solvers.trajectory import Outcome, Trajectory

F64 = rung("f64")
# Torqued, damped, with a rotor, without parameters, in a fluid with and without a path, backwards.
SCENES = (
    "euler/generic",
    "euler/constant-moment",
    "euler/gyrostat",
    "euler/spherical",
    "euler/backward",
    "euler/with-attitude",
    "kirchhoff/later-start",
    "kirchhoff/whole-motion",
    "kirchhoff/general-body",
    "kirchhoff/rest",
)


def problem_of(name: str) -> Problem:
    return pose(load(name), F64)


def apart(one: Trajectory, other: Trajectory) -> float:
    """Return the largest difference of two answers, relative to the largest number of its quantity."""
    assert one.quantities.keys() == other.quantities.keys()
    differences = [
        np.max(abs(one.quantities[name] - other.quantities[name]))
        / max(1, np.max(abs(other.quantities[name])))
        for name in one.quantities
    ]
    return float(max(differences))


def with_starts(problem: Problem, factors: Sequence[Fraction]) -> list[Problem]:
    """Return the problem from multiples of its start."""
    return [
        replace(
            problem,
            initial_momenta=tuple(F64.round(factor * v) for v in problem.initial_momenta),
        )
        for factor in factors
    ]


def test_answers_come_in_the_order_of_the_problems() -> None:
    """Problems of several forms, rungs and numbers of samples keep their places, whatever goes together."""
    problems = [problem_of(name) for name in SCENES]
    problems += [pose(scene, F64) for scene in satellites(5, 3, tracks_attitude=True)]
    problems += [pose(load("euler/generic"), rung(name)) for name in ("f32", "f80")]
    mixed = problems[::2] + problems[1::2]
    for problem, answer in zip(mixed, solve_together(mixed), strict=True):
        alone = Taylor().solve(problem)
        assert answer.outcome is alone.outcome is Outcome.FINISHED
        assert apart(answer, alone) <= 1e-11
        assert answer.steps > 0 or alone.steps == 0


def test_a_tolerance_is_kept_side_by_side() -> None:
    """A coarse tolerance gives the errors that it gives alone, and as many evaluations for a step."""
    problems = neighbours(problem_of("kirchhoff/general-body"), 5)
    tolerance = Fraction(1, 10**5)
    for problem, answer in zip(problems, solve_together(problems, tolerance), strict=True):
        exact, alone = Taylor().solve(problem), Taylor(tolerance=tolerance).solve(problem)
        assert 1e-8 < apart(answer, exact) < 1e-3
        assert apart(answer, alone) <= 1e-9
        assert (answer.steps, answer.evaluations) == (alone.steps, alone.evaluations)


def test_few_at_a_time_are_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    """Problems that do not fit into the memory go in parts, to the same last bit."""
    problems = neighbours(problem_of("euler/generic"), 20)
    whole = solve_together(problems)
    samples, states = len(problems[0].times), len(problems[0].form.states)
    monkeypatch.setattr(together, "_MOST_NUMBERS", 3 * samples * states)
    assert all(
        apart(one, other) == 0 for one, other in zip(solve_together(problems), whole, strict=True)
    )


def test_one_that_is_not_finite_spoils_no_other() -> None:
    """A start that overflows at once ends as it does alone, and those beside it reach their ends."""
    problem = problem_of("kirchhoff/general-body")
    problems = with_starts(problem, [Fraction(1), Fraction(10) ** 200, Fraction(9, 10)])
    first, broken, last = solve_together(problems)
    assert broken.outcome is Taylor().solve(problems[1]).outcome is not Outcome.FINISHED
    assert not broken.quantities
    for problem, answer in ((problems[0], first), (problems[2], last)):
        assert apart(answer, Taylor().solve(problem)) <= 1e-12


def test_a_rate_that_grows_is_seen_beside_others() -> None:
    """A fall from an unstable axis goes again in shorter steps; a regular motion beside it does not."""
    falling = problem_of("euler/tennis-racket")
    regular = replace(
        falling, initial_momenta=falling.initial_momenta[1:] + falling.initial_momenta[:1]
    )
    lanes = propagate(Alike.of([falling, regular, falling]))
    assert lanes.ways[0] == lanes.ways[2] > lanes.ways[1] == 1
    np.testing.assert_array_equal(lanes.rows[:, 0], lanes.rows[:, 2])


@pytest.mark.parametrize("name", SCENES)
def test_the_compiled_bound_is_that_of_the_matrices(name: str) -> None:
    """heyoka's derivatives give the norms that the polynomials of the equations give, row by row."""
    problem = pose(tracking_all(load(name)), F64)
    n, linearised = momenta(problem.form), Linearised(problem)
    states = np.random.default_rng(2).normal(size=(len(problem.form.states), 1, 7))
    parameters = np.array([[float(value)] for value in problem.parameters]).reshape(-1, 1)
    entries = linearised._squares(linearised._augmented(states[:, 0].T))
    by_row = [(entries[:, : n * n] ** 2).sum(axis=1), entries[:, -1] ** 2]
    bound = rate_bound(problem.form).fourth_powers(states, parameters)
    assert bound == pytest.approx([np.max(by_row)], rel=1e-12)
    look, rate = Look(problem, 7), float(bound[0]) ** 0.25
    assert look.is_within(states[:, 0].T, (1 + 1e-12) * rate)
    assert not look.is_within(states[:, 0].T, (1 - 1e-12) * rate) or rate == 0
    assert linearised.fastest(states[:, 0].T) <= 1.35 * max(bound[0] ** 0.25, 2.0**-10)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_bound_of_what_is_not_finite_is_not_finite(bad: float) -> None:
    """It is below no rate, so that the matrices decide, and find an infinite one."""
    alike = Alike.of([problem_of("kirchhoff/general-body")] * 2)
    states = np.ones((6, 2, 3))
    states[4, 1, 2] = bad
    assert alike.grown(states, np.array([1e6, 1e6])).tolist() == [0.0, np.inf]
    look = Look(problem_of("kirchhoff/general-body"), 3)
    assert look.is_within(states[:, 0].T, 1e6)
    assert not look.is_within(states[:, 1].T, 1e200)


def test_neighbours_have_starts_of_their_own() -> None:
    """All differ, each within a tenth of the body, which comes first; the attitude is the same."""
    problem = problem_of("kirchhoff/whole-motion")
    several = neighbours(problem, 64)
    assert several[0] is problem
    assert len({other.initial_momenta for other in several}) == len(several) == 64
    for other in several:
        assert (other.form, other.parameters) == (problem.form, problem.parameters)
        assert other.initial_momenta[6:] == problem.initial_momenta[6:]
        for mine, given in zip(other.initial_momenta[:6], problem.initial_momenta, strict=False):
            assert abs(mine - given) <= abs(given) * Fraction(101, 1000)


@pytest.mark.parametrize("name", ["euler/separatrix", "kirchhoff/half-turn-path"])
def test_a_body_among_its_neighbours_is_judged_as_alone(name: str) -> None:
    """`taylor?bodies=9` answers for the body itself, and its seconds are the share of one."""
    among, alone = run(name, "taylor?bodies=9", "f64"), run(name, "taylor", "f64")
    assert [(v.quantity, v.verdict) for v in among.verdicts] == [
        (v.quantity, v.verdict) for v in alone.verdicts
    ]
    solver = solver_named("taylor?bodies=9")
    assert solver.bodies == 9
    assert solver.unavailable(rung("f80"))
