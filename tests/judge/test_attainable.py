"""The floor: roundings component by component, from anywhere on the orbit, in the units of the problem."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from math import log
from typing import Any

import numpy as np
import pytest
from builders.scenes import CLEBSCH, GENERAL, TENSOR, asked_at, sample_scene, spun, vector
from builders.scenes import LOADED as SOLID
from builders.turns import by_turns

from taylor_verify.exact.conditioning import condition
from taylor_verify.exact.conditioning.condition import path, path_of_run
from taylor_verify.exact.route import solution
from taylor_verify.judge.errors.state import state_errors
from taylor_verify.judge.floor import attainable, rounded_input
from taylor_verify.judge.floor.attainable import Floor, floor
from taylor_verify.judge.floor.loads import Along
from taylor_verify.judge.floor.magnitude import roundings
from taylor_verify.judge.floor.rounded_input import InputRounding, input_rounding
from taylor_verify.judge.judgement import judgement
from taylor_verify.models.problem import adopt
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import power_of_two, rung
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.run import run
from taylor_verify.scenes.bodies import Body, ImmersedBody, RigidBody
from taylor_verify.scenes.motion import Clock, Impulse, Motion, Spin
from taylor_verify.scenes.mpfr import in_mpfr
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.taylor.plain import Plain

Array = np.ndarray[Any, Any]
U = 2.0**-53
# The rate at which an error grows beside the middle axis of moments 1, 2, 3.
RATE = 3**-0.5


IMPULSE = Impulse(vector("0.1", "0.2", 1), vector("0.3", 0, 1), centre=vector(1, 2, 3))


def scene(
    body: RigidBody | ImmersedBody, start: Spin | Impulse, end: float, samples: int, *track: str
) -> Scene:
    model = "euler" if isinstance(body, RigidBody) else "kirchhoff"
    times = tuple(Fraction(end) * Fraction(k, samples - 1) for k in range(samples))
    return Scene("here", "", model, frozenset(track), body, start, Clock(Fraction(0), times))


RIGID = scene(RigidBody(TENSOR), Spin(vector("0.3", 1, "0.2")), 4, 5, "attitude")
LOADED = scene(SOLID, IMPULSE, 4, 5, "attitude", "centre")
REVOLVED = scene(CLEBSCH, IMPULSE, 4, 5, "attitude", "centre")


# How errors add up.


@pytest.mark.parametrize("start", [(0.25, 1.0, -0.5), (0.0, 0.0, 2.0), (-3.0, 0.125, 0.0)])
def test_terms_of_a_full_tensor_are_added_up(start: tuple[float, ...]) -> None:
    """S is the sum of |deviation_ij H_j H_k| over the terms of H x K H, written out by hand."""
    asked = replace(RIGID, initial=Spin(tuple(Fraction(w) for w in start)), track=frozenset())
    rounded = _rounded(asked, steps=4)
    momentum = np.array(TENSOR, dtype=float) @ start
    K = np.array(tensors.inverse(TENSOR), dtype=float)
    terms = np.abs(K - K[2, 2] * np.eye(3)) @ np.abs(momentum)
    H = np.abs(momentum)
    S = np.array([H[j] * terms[k] + H[k] * terms[j] for j, k in ((1, 2), (2, 0), (0, 1))])
    along = [np.linalg.norm(H), np.linalg.norm(S)]
    # One length of a step for all components, and at most the span over the steps.
    h = (rounded[0] - H) @ S / (S @ S)
    assert 0 < h <= 1
    assert np.abs(rounded[0] - H - h * S).max() <= 1e-12 * (along[0] + along[1])


def _rounded(asked: Scene, steps: int) -> Array:
    """r of every component in the scene's own units."""
    orbit = path(asked)
    units = [float(orbit.units[block]) for block in orbit.blocks for _ in range(3)]
    return roundings(asked, orbit, 53, steps) * units


def test_squares_of_independent_errors_are_added() -> None:
    """All errors together make the root of the sum of squares of what each makes alone."""
    orbit = path(RIGID)
    shape = len(orbit.elapsed), 3 * len(orbit.blocks)
    draw = np.random.default_rng(2)
    places = [(int(draw.integers(shape[0])), int(draw.integers(shape[1]))) for _ in range(6)]
    together, squares = np.zeros(shape), {}
    for place in set(places):
        alone = np.zeros(shape)
        together[place] = alone[place] = draw.uniform(0.1, 1)
        for name, rows in orbit.gathered(alone).items():
            squares[name] = squares.get(name, 0) + rows**2
    for name, rows in orbit.gathered(together).items():
        assert np.allclose(rows**2, squares[name], rtol=1e-12, atol=1e-24)


# The floor.


def _floor(asked: Scene, steps: int) -> Array:
    """The floor of the state at the samples."""
    floor_of_run, truth = _floor_of(asked, steps)
    (errors, *_) = state_errors(asked, truth, truth)
    return floor_of_run.of_state(errors)


def _floor_of(asked: Scene, steps: int) -> tuple[Floor, Motion]:
    truth = solution(asked).motion(asked.clock.elapsed, 25)
    return floor(asked, asked, Fraction(1, 2**53), steps), truth


def edge(d: float, samples: int, tumbles: float = 1.0) -> Scene:
    """(d, 1, 0) with moments 1, 2, 3, until so many times as long as it takes to the first tumble."""
    return spun((d, 1.0, 0.0), tumbles * log(1 / d) / RATE, samples)


@pytest.mark.parametrize("d", [1e-8, 1e-12])
def test_beside_the_unstable_axis_principal_axes_lose_nothing(d: float) -> None:
    """Until the first tumble the floor is that of a walk of some roundings: not u/d, but u."""
    steps = 100
    floors = _floor(edge(d, 31), steps)
    assert floors.max() <= 100 * U * steps**0.5
    assert floors.max() <= 1e-2 * U / d


def test_in_other_axes_a_rounding_of_the_large_components_is_one_of_the_small() -> None:
    """The same body in a full tensor: d is a difference of large numbers, and the floor u/d or so."""
    turned = load("extremes/euler-unstable-axis-turned")
    floors = _floor(turned, 100)
    # At the first tumble, t = 32: u exp(0.577 t), from every step.
    assert floors[:20].max() >= 0.1 * U / 1e-8


def test_after_a_tumble_the_next_passage_magnifies() -> None:
    """Components of size one are rounded in the tumble; after it that grows at the classical rate."""
    asked = edge(1e-12, 61, tumbles=1.5)
    floors, times = _floor(asked, 100), [float(t) for t in asked.clock.elapsed]
    assert log(floors[60] / floors[50]) == pytest.approx(RATE * (times[60] - times[50]), rel=0.05)
    # Until the tumble it is a walk, though the same rate rules there.
    assert floors[30] / floors[10] <= 4


@pytest.mark.parametrize(("shift", "model"), [(-400, "euler"), (400, "euler"), (-400, "kirchhoff")])
def test_floor_does_not_know_the_units(shift: int, model: str) -> None:
    """omega or impulses times a power of two, far out: the same floors of state and invariants.

    A RuntimeWarning of an overflow would be an error of this test.
    """
    asked = replace(RIGID, track=frozenset()) if model == "euler" else REVOLVED
    factor = power_of_two(shift)
    start = asked.initial.with_moving(tuple(factor * v for v in asked.initial.moving))
    times = tuple(t / factor for t in asked.clock.instants)
    scaled = replace(asked, initial=start, clock=Clock(Fraction(0), times))
    for one, other in zip(_all_floors(asked), _all_floors(scaled), strict=True):
        assert np.allclose(one, other, rtol=1e-9, atol=0)
        assert (one > 0).all()


def _all_floors(asked: Scene) -> list[Array]:
    from taylor_verify.exact.invariants import invariants

    floor_of_run, truth = _floor_of(asked, 40)
    floors = [floor_of_run.of_state(errors) for errors in state_errors(asked, truth, truth)]
    quick = in_mpfr(truth.at(floor_of_run.nodes))
    return floors + [floor_of_run.of_gradients(i, quick, i.scale(truth)) for i in invariants(asked)]


def returning(samples: int) -> Scene:
    """A body that comes back to its unstable axis every 27 units, six times."""
    return spun((1e-6, 1.0, 2.5e-7), 165.0, samples)


def test_floor_does_not_depend_on_where_the_samples_lie() -> None:
    """With 3, 11, 41 and 161 samples of one run the floors at the common instants are the same."""
    floors = {samples: _floor(returning(samples), 240) for samples in (3, 11, 41, 161)}
    for samples, values in floors.items():
        middle, end = values[(samples - 1) // 2], values[-1]
        # Roundings are gathered at other times, radian by radian: within a factor of two.
        assert 0.5 <= middle / floors[161][80] <= 2
        assert 0.5 <= end / floors[161][160] <= 2


def in_step(samples: int) -> Scene:
    """Moments a million apart and near the separatrix: samples at 7.504 periods see one phase of it."""
    moments = (Fraction(1, 10**6), Fraction(19, 20), Fraction(1))
    inertia = tuple(tuple(I * (i == j) for j in range(3)) for i, I in enumerate(moments))
    spin = Spin((Fraction(0), Fraction(1), Fraction(1, 10)))
    times = tuple(Fraction(20 * k, samples - 1) for k in range(samples))
    plain = spun((0.0, 1.0, 0.0), 20.0, 3)
    return replace(plain, body=RigidBody(inertia), initial=spin, clock=Clock(Fraction(0), times))


def test_samples_in_step_with_the_orbit_hide_none_of_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """Samples that meet a motion in one phase find the floor that every radian has; alone, a tenth."""
    asked = in_step(41)
    floors = _floor(asked, 14505)
    monkeypatch.setattr(condition, "few", lambda elapsed: list(elapsed))
    alone = _floor_again(asked, 14505)
    monkeypatch.setattr(condition, "REGULAR", 0)
    resolved = _floor_again(asked, 14505)
    # A few dozen times stand for a thousand whose parts differ a hundredfold: within the gates' factor.
    assert (floors[1:] >= 0.2 * resolved[1:]).all()
    assert (floors[1:] <= 10 * resolved[1:]).all()
    assert (alone[1:] <= 0.3 * resolved[1:]).all()


def _floor_again(asked: Scene, steps: int) -> Array:
    """The floor without what is remembered of the orbit, before and after."""
    attainable.orbit_of.cache_clear()
    try:
        return _floor(asked, steps)
    finally:
        attainable.orbit_of.cache_clear()


@pytest.mark.parametrize("samples", [3, 12, 41])
def test_sound_driver_passes_however_it_is_sampled(samples: int) -> None:
    """The floor has the effect of the passages of the unstable axis on roundings, seen or not."""
    verdicts = run(returning(samples), "taylor", "f64").verdicts
    assert {v.verdict for v in verdicts} == {Status.PASS}


# A broken twin.


def plain(asked: Scene) -> tuple[Verdict, ...]:
    """heyoka without a bound on its step, on the very data."""
    problem = adopt(asked, rung("f64"), asked.clock.instants)
    return judgement(problem, Plain(), Plain().solve(problem)).verdicts


def driver(asked: Scene) -> tuple[Verdict, ...]:
    return run(asked, "taylor", "f64").verdicts


@pytest.mark.parametrize("d", [1e-8, 1e-12])
def test_a_step_without_a_bound_is_seen_beside_the_unstable_axis(d: float) -> None:
    """An absolute error control loses d: omega fails, energy and momentum pass; the driver passes all."""
    asked = edge(d, 11, tumbles=1.1)
    _, omega, *conserved = plain(asked)
    assert omega.verdict is Status.FAIL
    assert {v.verdict for v in conserved} == {Status.PASS}
    assert {v.verdict for v in driver(asked)} == {Status.PASS}


@pytest.mark.parametrize("solve", [plain, driver])
def test_both_pass_where_nothing_is_small(solve: Callable[[Scene], tuple[Verdict, ...]]) -> None:
    """On a generic orbit the step needs no bound: what fails above is the small component alone."""
    assert {v.verdict for v in solve(spun((0.3, 1.0, 0.2), 20.0, 11))} == {Status.PASS}


# The response to roundings of the input: of many numbers a few draws give the sum of all single moves.


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
