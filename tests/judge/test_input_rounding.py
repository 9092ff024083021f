"""The response to roundings of the input: of many numbers a few draws give the sum of all single moves."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from builders.scenes import CLEBSCH, GENERAL, TENSOR, asked_at, sample_scene
from builders.turns import by_turns

from taylor_verify.exact.conditioning.condition import path_of_run
from taylor_verify.exact.route import solution
from taylor_verify.judge.floor import rounded_input
from taylor_verify.judge.floor.loads import Along
from taylor_verify.judge.floor.rounded_input import InputRounding, input_rounding
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.bodies import Body, RigidBody
from taylor_verify.scenes.motion import Spin
from taylor_verify.scenes.scene import Scene

F64 = rung("f64")


@pytest.mark.parametrize("body", [RigidBody(TENSOR), CLEBSCH], ids=["tensor", "fluid"])
def test_draws_give_the_sum_of_single_moves(body: Body, monkeypatch: pytest.MonkeyPatch) -> None:
    """The mean square of eight draws is the sum of squares, but for its scatter of a half."""
    scene = sample_scene(body, "attitude")
    assert len(rounded_input._numbers(scene)) > rounded_input._MOST_DRAWS
    drawn = input_rounding(scene, F64).at_samples
    monkeypatch.setattr(rounded_input, "_MOST_DRAWS", 1000)
    each = input_rounding(scene, F64).at_samples
    assert set(drawn) == set(each)
    for name, sizes in each.items():
        assert np.all(sizes > 0)
        assert np.all(drawn[name] <= 2 * sizes)
        assert np.all(sizes <= 2 * drawn[name])


@pytest.mark.parametrize("name", by_turns(["kirchhoff/general-body", "kirchhoff/swimmer-vehicle"]))
def test_the_derivative_tells_what_exact_motions_beside_tell(name: str) -> None:
    """Without closed form the same draws are carried by the derivative, to first order in a rounding."""
    scene = asked_at(name, Fraction(1, 2), Fraction(1))
    carried = input_rounding(scene, F64)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(rounded_input, "is_of_run", lambda scene: False)
        patch.setattr(rounded_input, "differs_dearly", lambda scene: False)
        beside = input_rounding(scene, F64)
    assert carried.moved == beside.moved
    assert set(carried.at_samples) == set(beside.at_samples)
    for quantity, sizes in beside.at_samples.items():
        assert carried.at_samples[quantity] == pytest.approx(sizes, rel=1e-4)


def test_a_free_body_has_its_absent_loads_once() -> None:
    """A body without written loads has all its rows in one piece: each piece costs a pass over texts."""
    path = path_of_run(asked_at("kirchhoff/general-body", Fraction(1, 2), Fraction(1)))
    (piece,) = Along(path).pieces()
    assert len(piece.places) == len(path.elapsed) > 1


def times_alone(*instants: Fraction) -> InputRounding:
    """The response to roundings of these times, of a scene whose numbers are not moved."""
    scene = asked_at("euler/generic", *instants)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(rounded_input, "_moved", lambda scene, rung: iter(()))
        return input_rounding(scene, F64)


def test_a_time_that_the_rung_cannot_hold_is_moved() -> None:
    """The response to it is the rate of omega by the time times u, in parts of |omega|; T has none."""
    t = Fraction(17, 10)
    response = times_alone(t)
    assert response.moved.endswith(", and every time")
    step = Fraction(1, 10**8)
    before, here, after = (
        np.array(solution(asked_at("euler/generic", t)).motion([s], 30)["omega"][0], dtype=float)
        for s in (t - step, t, t + step)
    )
    rate = np.linalg.norm(after - before) / float(2 * step)
    expected = rate * float(t * F64.unit_roundoff) / np.linalg.norm(here)
    assert response.at_samples["omega"] == pytest.approx([expected], rel=1e-6)
    assert response.at_samples["T"] <= 1e-3 * expected


def test_a_time_that_the_rung_holds_is_not_moved() -> None:
    """Nothing is moved then, and no word is said of times."""
    response = times_alone(Fraction(3, 2))
    assert dict(response.at_samples) == {}
    assert "time" not in response.moved


def test_times_are_one_number_more() -> None:
    """The squares of their response are added to those of body and start."""
    t = Fraction(17, 10)
    both, late = input_rounding(asked_at("euler/generic", t), F64), times_alone(t)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(type(F64), "holds", lambda self, number: True)
        given = input_rounding(asked_at("euler/generic", t), F64)
    assert both.moved == f"{given.moved}, and every time"
    for name, sizes in both.at_samples.items():
        expected = np.hypot(given.at_samples[name], late.at_samples[name])
        assert sizes == pytest.approx(expected, rel=1e-9)


def test_what_symmetry_makes_equal_counts_once() -> None:
    """A full tensor is six numbers; of a body of revolution axes 1 and 2 have one p, one q and one r."""
    # The coupling of the general one has no symmetry, and two zeros.
    bodies = {RigidBody(TENSOR): 6 + 3, CLEBSCH: 6 + 5, GENERAL: 6 + 7 + 6 + 5}
    for body, count in bodies.items():
        assert len(rounded_input._numbers(sample_scene(body))) == count


def changes(scene: Scene) -> list[list[int]]:
    """What each move does to each number that is not zero, in roundings upwards."""

    def read(given: Scene) -> list[Fraction]:
        assert isinstance(given.body, RigidBody)
        assert isinstance(given.initial, Spin)
        entries = [given.body.inertia[i][k] for i in range(3) for k in range(i, 3)]
        return [n for n in (*entries, *given.initial.omega) if n]

    here, u = read(scene), F64.unit_roundoff
    return [
        [int((b / a - 1) / u) for a, b in zip(here, read(there), strict=True)]
        for there in rounded_input._moved(scene, F64)
    ]


def test_up_to_eight_numbers_are_moved_one_at_a_time() -> None:
    """Every draw of more numbers moves all of them, each up or down, no two draws alike."""
    spin = Spin((Fraction(1, 2), Fraction(1), Fraction(0)))
    few = changes(sample_scene(RigidBody(TENSOR), start=spin))
    assert sorted(few) == sorted([int(i == k) for i in range(8)] for k in range(8))
    many = changes(sample_scene(RigidBody(TENSOR)))
    assert {abs(step) for draw in many for step in draw} == {1}
    assert len({tuple(draw) for draw in many}) == len(many) == 8
