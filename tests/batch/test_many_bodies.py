"""Many free rigid bodies at once: their verdicts are those of one body at a time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from taylor_verify.batch import bodies as batch
from taylor_verify.batch.bodies import judged
from taylor_verify.models.bodies import Bodies
from taylor_verify.models.problem import pose
from taylor_verify.records.verdict import Verdict
from taylor_verify.run import run
from taylor_verify.scenes.precision import rung
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.taylor import lanes
from taylor_verify.solvers.taylor.lanes import propagate
from taylor_verify.solvers.trajectory import Outcome
from tests.builders.satellites import bodies_of, near_the_separatrix, satellite, satellites

pytest.importorskip("heyoka")


@pytest.fixture
def one_by_one(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The names of the scenes that go through the chain."""
    names: list[str] = []

    def noted(scene: Scene, solver: str, rung: str) -> object:
        names.append(scene.name)
        return run(scene, solver, rung)

    monkeypatch.setattr(batch, "run", noted)
    return names


def _words(verdicts: Sequence[Verdict]) -> list[tuple[object, ...]]:
    return [(v.scene, v.quantity, v.verdict, v.outcome, v.error_kind, v.unit) for v in verdicts]


def _agree(scenes: Sequence[Scene]) -> None:
    for scene, judgement in zip(scenes, judged(scenes), strict=True):
        expected = run(scene).verdicts
        assert _words(judgement) == _words(expected)
        for one, other in zip(judgement, expected, strict=True):
            assert one.until == other.until
            # Where the errors are largest at one sample, both floors there are those of their steps. A
            # step has the length of the time over their number, which takes part in its rounding too.
            if one.at == other.at and one.attainable and other.attainable:
                samples = len(scene.clock.instants)
                steps = max(one.steps, samples) / max(other.steps, samples)
                assert one.attainable == pytest.approx(other.attainable * steps**0.5, rel=0.05)


def test_verdicts_are_those_of_one_body_at_a_time(one_by_one: list[str]) -> None:
    """Verdicts on satellites judged together are those of the chain, and few go through it."""
    scenes = satellites(10, 1) + satellites(10, 2, tracks_attitude=True)
    _agree(scenes)
    assert len(one_by_one) <= 2


def test_bodies_near_their_separatrices_are_judged_together(one_by_one: list[str]) -> None:
    """Near their separatrices the truth stays sharp: no body goes through the chain for its width."""
    _agree(near_the_separatrix())
    assert one_by_one == []


@pytest.mark.slow
@pytest.mark.parametrize("tracks_attitude", [False, True])
def test_verdicts_on_a_thousand_satellites(tracks_attitude: bool) -> None:
    """Verdicts on a random thousand, five hundred with attitude, are those of the chain."""
    _agree(satellites(500, 3 + tracks_attitude, tracks_attitude))


def test_other_questions_go_through_the_chain(one_by_one: list[str]) -> None:
    """Bodies that are no triaxial free ones in their own axes are judged one by one."""
    one = Fraction(1)
    round_body = satellite("round", (one, one, 2 * one), (one, one / 2, one / 3))
    steady = satellite("steady", (one, 2 * one, 3 * one), (one, Fraction(0), Fraction(0)))
    resting = satellite("resting", (one, 2 * one, 3 * one), (Fraction(0),) * 3)
    loaded = satellite("loaded", (one, 2 * one, 3 * one), (one, one, one))
    loaded = replace(loaded, body=replace(loaded.body, moment=(one, Fraction(0), Fraction(0))))
    scenes = [round_body, steady, resting, loaded]
    judgements = judged(scenes)
    assert one_by_one == ["round", "steady", "resting", "loaded"]
    assert [_words(rows) for rows in judgements] == [_words(run(s).verdicts) for s in scenes]


def test_a_lane_that_is_wrong_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    """A lane that is disturbed stands in no verdict, and its neighbours are judged as before."""
    scenes = satellites(6, 5)
    expected = [_words(rows) for rows in judged(scenes)]
    names: list[str] = []

    def disturbed(bodies: Bodies) -> lanes.Lanes:
        states = propagate(bodies)
        states.rows[0, 2, 20:] *= 1 + 1e-11
        return states

    def noted(scene: Scene, *_: str) -> object:
        names.append(scene.name)
        return run(scene)

    monkeypatch.setattr(batch, "propagate", disturbed)
    monkeypatch.setattr(batch, "run", noted)
    assert [_words(rows) for rows in judged(scenes)] == expected
    assert names == ["satellite2"]


def test_numbers_are_those_of_pose() -> None:
    """K, H, the unit quaternion and the times are those that `pose` has for each body."""
    scenes = satellites(12, 6, tracks_attitude=True)
    bodies = bodies_of(scenes)
    for k, scene in enumerate(scenes):
        problem = pose(scene, rung("f64"))
        parameter, unit = problem.parameter, problem.units
        K = [parameter[f"K{i}{i}"] / unit.momentum / unit.time for i in (1, 2, 3)]
        start = problem.initial_momenta
        assert K == [Fraction(v) for v in bodies.inverse[:, k]]
        assert [h * unit.momentum for h in start[:3]] == [
            Fraction(v) for v in bodies.momentum[:, k]
        ]
        assert list(start[3:]) == [Fraction(v) for v in bodies.starts[3:, k]]


def test_broken_lanes_spoil_no_other() -> None:
    """A lane that is not finite ends as such, and the lanes beside it reach their ends."""
    bodies = bodies_of(satellites(9, 7))
    whole = propagate(bodies)
    bodies.momentum[0, 4] = np.nan
    broken = propagate(Bodies(bodies.inverse, bodies.momentum, bodies.times, bodies.attitude))
    assert broken.outcomes[4] is Outcome.NON_FINITE
    others = [k for k in range(9) if k != 4]
    assert all(broken.outcomes[k] is Outcome.FINISHED for k in others)
    np.testing.assert_allclose(broken.rows[:, others], whole.rows[:, others], rtol=0, atol=1e-12)


def test_lanes_whose_rate_grew_go_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """A lane that meets a faster rate than its steps were made for goes again at that rate."""
    bodies = bodies_of(satellites(5, 8))
    slow = bodies.rates.copy()
    slow[3] /= 8
    monkeypatch.setattr(Bodies, "rates", property(lambda _: slow))
    states = propagate(bodies)
    assert states.ways.tolist() == [1, 1, 1, 2, 1]
    assert all(outcome is Outcome.FINISHED for outcome in states.outcomes)
