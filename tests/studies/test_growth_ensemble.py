"""Many starts at once: every lane has the same exact numbers as alone, however the others end."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from mpmath import mp

from taylor_verify.exact.route import solution
from taylor_verify.judge.errors.state import state_errors
from taylor_verify.models.form import Named
from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.taylor.ensemble import Ensemble, Lane, batch_width
from taylor_verify.solvers.taylor.way import longest_step
from taylor_verify.solvers.trajectory import Outcome, Trajectory, from_scaled
from taylor_verify.tradeoff.random_starts import nearby

# More than one batch of any processor, and no multiple of a power of two.
LANES = 19


def problems(name: str, on: str, count: int = LANES, until: int = 50) -> list[Problem]:
    scene = load(name)
    scene = replace(scene, clock=Clock(Fraction(0), (Fraction(until),)))
    return [pose(one, rung(on)) for one in [scene, *nearby(scene, 1, count - 1)]]


def ends(asked: Sequence[Problem]) -> list[Fraction]:
    return [problem.times[-1] for problem in asked]


def blowing_up(n: Named) -> Mapping[str, Any]:
    """H1' = H1^2 is infinite at the time 1/H1 if H1 starts above zero, and dies away if below."""
    return {"H1": n["H1"] * n["H1"], "H2": n["H2"] * n["H1"], "H3": n["H1"] * n["H2"]}


def with_fates(until: int) -> tuple[list[Problem], list[bool]]:
    """Return lanes: every third goes on for ever, and the k-th of the others ends at the time 2 + k."""
    fated, lives = [], []
    for k, problem in enumerate(problems("euler/generic", "f64")):
        lives.append(k % 3 == 0 or 2 + k > until)
        first = Fraction(-1 if k % 3 == 0 else 1, 2 + k)
        start = rung("f64").round(first), *problem.initial_momenta[1:]
        fated.append(replace(problem, initial_momenta=start).with_equations(blowing_up))
    return fated, lives


@pytest.mark.parametrize("on", ["f32", "f64"])
@pytest.mark.parametrize("name", ["euler/generic", "kirchhoff/two-real-roots"])
def test_a_lane_is_the_same_in_any_company(name: str, on: str) -> None:
    """The same start has the same bits and steps among others, in another place, and by itself."""
    asked = problems(name, on)
    together = Ensemble(asked)
    lanes = together.advance(together.start(), ends(asked))
    assert all(lane.goes_on for lane in lanes)
    for some in (slice(3, 10), slice(18, 19), slice(None, None, -1)):
        fewer = Ensemble(asked[some])
        assert fewer.advance(fewer.start(), ends(asked[some])) == lanes[some]


@pytest.mark.parametrize("on", ["f32", "f64", "f80", "mp64"])
@pytest.mark.parametrize(
    "name", ["euler/generic", "euler/with-attitude", "kirchhoff/two-real-roots"]
)
def test_every_lane_is_near_the_truth(name: str, on: str) -> None:
    """Each start is followed from its own data: the error is that of its steps, carried to the end."""
    asked = problems(name, on, 5, until=20)
    ensemble = Ensemble(asked)
    for problem, lane in zip(asked, ensemble.advance(ensemble.start(), ends(asked)), strict=True):
        rows = [lane.state]
        with mp.workprec(2 * problem.rung.bits + 64):
            answer = Trajectory(Outcome.FINISHED, from_scaled(problem, rows)).motion(mp.prec)
            truth = solution(problem.given).motion(problem.given.clock.elapsed, 30)
            worst = max(float(e.values[0]) for e in state_errors(problem.given, truth, answer))
        # Some roundings a step, each carried on in proportion to the three periods that remain.
        assert worst <= 32 * lane.steps * float(problem.rung.unit_roundoff)


def test_a_lane_that_is_not_finite_stops_no_other() -> None:
    """Lanes that blow up on the way are taken out one by one; the others end as if they were alone."""
    asked, lives = with_fates(until=10)
    assert lives.count(False) > batch_width(rung("f64")) / 2
    ensemble = Ensemble(asked)
    lanes = ensemble.advance(ensemble.start(), [Fraction(10)] * LANES)
    assert [lane.goes_on for lane in lanes] == lives
    assert {lane.outcome for lane in lanes} == {Outcome.FINISHED, Outcome.NON_FINITE}
    living = [i for i in range(LANES) if lives[i]]
    alone = Ensemble([asked[i] for i in living])
    expected = alone.advance(alone.start(), [Fraction(10)] * len(living))
    assert [lanes[i] for i in living] == list(expected)
    for i in living:
        # The exact H1 is 1/(1/H1(0) - t).
        exact = 1 / (1 / asked[i].initial_momenta[0] - 10)
        assert abs(lanes[i].state[0] / exact - 1) <= 2.0**-53 * 200 * abs(
            exact / asked[i].initial_momenta[0]
        )


@pytest.mark.parametrize(
    ("on", "size", "outcome"),
    [
        ("f64", 2**100, Outcome.STEP_LIMIT),
        ("f80", 2**100, Outcome.STEP_LIMIT),
        ("f80", 2**2000, Outcome.NON_FINITE),
    ],
)
def test_a_lane_that_would_never_end_is_not_begun(on: str, size: int, outcome: Outcome) -> None:
    """A state so large that its steps would take years is taken out, with the reason."""
    asked = problems("euler/generic", on, 6)
    large = replace(asked[2], initial_momenta=(Fraction(size),) * 3)
    ensemble = Ensemble([*asked[:2], large, *asked[3:]])
    lanes = ensemble.advance(ensemble.start(), ends(asked))
    assert lanes[2] == Lane(Fraction(0), large.initial_momenta, outcome=outcome)
    sound = Ensemble(asked)
    expected = sound.advance(sound.start(), ends(asked))
    assert [lanes[i] == expected[i] for i in range(6)] == [True, True, False, True, True, True]


def test_no_step_is_longer_than_the_cap() -> None:
    """Steps stay short near an unstable axis, where the error control would allow long ones."""
    asked = problems("euler/tennis-racket", "f64", 4, until=30)
    unstable = [
        replace(
            problem,
            initial_momenta=tuple(
                value if i == place else problem.rung.round(value * Fraction(1, 10**12))
                for i, value in enumerate(problem.initial_momenta)
            ),
        )
        for problem in asked
        for place in [int(np.argmax([abs(value) for value in problem.initial_momenta]))]
    ]
    ensemble = Ensemble(unstable)
    for lane in ensemble.advance(ensemble.start(), ends(asked)):
        # Every step but the last, which the end cuts short, may be as long as the cap.
        assert lane.steps >= lane.fastest * float(lane.time) / longest_step(20) - 1


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda asked: [], "expected at least one start, got none"),
        (
            lambda asked: [asked[0], *problems("euler/generic", "f32", 1)],
            "expected starts on f64, got f32 @ lane 1",
        ),
        (
            lambda asked: [asked[0], *problems("euler/full-tensor", "f64", 1)],
            "expected the states H1, H2, H3 .* got other equations @ lane 1",
        ),
    ],
)
def test_unlike_starts_are_refused(change: Any, message: str) -> None:
    """Problems of another rung or form have no place in one batch, and are named."""
    with pytest.raises(ValueError, match=message):
        Ensemble(change(problems("euler/generic", "f64", 2)))


def test_a_tolerance_below_the_numbers_is_refused() -> None:
    """heyoka would take a tolerance of zero for its own default."""
    with pytest.raises(ValueError, match="expected a positive tolerance on f32"):
        Ensemble(problems("euler/generic", "f32", 2), Fraction(1, 10**60))
