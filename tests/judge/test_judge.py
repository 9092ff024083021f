"""The judgement: errors in their units, floors from the orbit, gates that NaN and doubt cannot pass."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from builders.turns import by_turns
from hypothesis import given
from hypothesis import strategies as st
from mpmath import mp, mpf

from taylor_verify.exact.conditioning.condition import path, transition
from taylor_verify.exact.invariants import invariants
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Settled, Unsettled
from taylor_verify.judge.errors.drifts import Drifts
from taylor_verify.judge.errors.state import Arc, Errors, in_doubles, state_errors
from taylor_verify.judge.floor.attainable import Floor, floor
from taylor_verify.judge.gates import judge
from taylor_verify.models.problem import pose
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import rung
from taylor_verify.records.quantities import GATE_FACTOR
from taylor_verify.records.reason import Reason
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import exit_status
from taylor_verify.run import run
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Clock, Motion, Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene


def errors_of(values: list[float], radius: float = 0.0) -> Errors:
    column = in_doubles(np.array([mpf(v) for v in values], dtype=object))
    radii = np.full(len(values), radius)
    return Errors("omega", "max|omega|", column, radii, {"omega": mpf(1)})


def motion_of(**quantities: list[list[object]]) -> Motion:
    arrays = {name: np.array(rows, dtype=object) for name, rows in quantities.items()}
    count = len(next(iter(arrays.values())))
    return Motion(arrays, np.array([mpf(0)] * count, dtype=object))


# Gates.

TERMS = Reason()


def test_gate_stands_at_ten_times_the_attainable_error() -> None:
    """An error of exactly the bound passes, one unit above it fails."""
    attainable = np.array([1e-15, 2e-15])
    bound = GATE_FACTOR * attainable[1]
    assert GATE_FACTOR == 10
    assert judge(errors_of([0.0, bound]), attainable, TERMS).status is Status.PASS
    above = math.nextafter(bound, 1)
    assert judge(errors_of([0.0, above]), attainable, TERMS).status is Status.FAIL


def test_gate_asks_every_sample() -> None:
    """A small error at a time when nothing is excused fails, though a later, larger one is allowed."""
    attainable = np.array([1e-16, 1e-12])
    finding = judge(errors_of([1e-14, 5e-12]), attainable, TERMS)
    assert finding.status is Status.FAIL
    assert (finding.worst, finding.ratio_at) == (1, 0)


@given(st.integers(0, 4), st.floats(0, 1e-3))
def test_nan_fails_wherever_it_stands(place: int, other: float) -> None:
    """One NaN among the errors is a fail, never undecided, vacuous or a pass."""
    values = [other] * 5
    values[place] = math.nan
    for attainable in (1e-16, 1e-3, 10.0):
        finding = judge(errors_of(values), np.full(5, attainable), TERMS)
        assert finding.status is Status.FAIL
        assert finding.worst == place


def test_an_error_below_every_double_is_an_error() -> None:
    """Where the floor is zero nothing may move: 10^-400 is no zero, and zero itself passes."""
    floor = np.zeros(2)
    assert judge(errors_of([mpf(0), mpf("1e-400")]), floor, TERMS).status is Status.FAIL
    assert judge(errors_of([mpf(0), mpf(0)]), floor, TERMS).status is Status.PASS


def test_truth_wider_than_a_sixteenth_of_the_bound_decides_nothing() -> None:
    """A truth with a radius over bound/16 makes a gate undecided, for right and wrong alike."""
    attainable = np.array([1e-15])
    width = GATE_FACTOR * 1e-15 / 16
    assert judge(errors_of([0.0], width), attainable, TERMS).status is Status.PASS
    for error in (0.0, 1.0):
        finding = judge(errors_of([error], 1.01 * width), attainable, TERMS)
        assert finding.status is Status.UNDECIDED


def test_floor_that_reaches_the_motion_is_vacuous_but_excuses_nothing_before() -> None:
    """Where ten times the floor exceeds the motion the gate is vacuous; earlier samples still count."""
    attainable = np.array([1e-15, 0.2])
    assert judge(errors_of([1e-15, 0.9]), attainable, TERMS).status is Status.VACUOUS
    assert judge(errors_of([1e-13, 0.9]), attainable, TERMS).status is Status.FAIL


def test_what_left_the_orbit_does_not_come_back() -> None:
    """After a bound as large as the motion a smaller one binds nobody, and counts for no ratio."""
    attainable = np.array([1e-15, 0.2, 1e-3])
    finding = judge(errors_of([2e-15, 0.9, 0.9]), attainable, TERMS)
    assert finding.status is Status.VACUOUS
    assert (finding.ratio, finding.ratio_at) == (pytest.approx(2), 0)
    assert judge(errors_of([2e-14, 0.9, 0.9]), attainable, TERMS).status is Status.FAIL


# Errors.


def scene_of(model: str, *track: str) -> Scene:
    scene = load("euler/generic" if model == "euler" else "kirchhoff/screw")
    return replace(scene, track=frozenset(track))


def test_impulse_scales_x_and_y_apart_and_takes_the_larger() -> None:
    """An error of 1e-3 in y of size 1e-3 is an error of one, whatever the size of x."""
    truth = motion_of(linear_impulse=[[mpf(5), 0, 0]], angular_impulse=[[mpf("1e-3"), 0, 0]])
    answer = motion_of(linear_impulse=[[mpf(5), 0, 0]], angular_impulse=[[mpf("2e-3"), 0, 0]])
    (impulse,) = state_errors(scene_of("kirchhoff"), truth, answer)
    assert float(impulse.values[0]) == pytest.approx(1)


@pytest.mark.parametrize("angle", [1e-30, 1e-3, 1.0, 3.0])
def test_attitude_error_is_the_angle_between_two_frames(angle: float) -> None:
    """A frame turned by an angle about any axis is wrong by that angle, however small."""
    with mp.workdps(60):
        c, s = mp.cos(mpf(angle)), mp.sin(mpf(angle))
        turned = [[c, -s, mpf(0)], [s, c, mpf(0)], [mpf(0), mpf(0), mpf(1)]]
        same = [[mpf(int(i == j)) for j in range(3)] for i in range(3)]
        omega = [[mpf(1), mpf(0), mpf(0)]]
        truth = motion_of(omega=omega, attitude=[same])
        answer = motion_of(omega=omega, attitude=[turned])
        _, attitude = state_errors(scene_of("euler", "attitude"), truth, answer)
        # 60 digits less the 30 that the cosine loses at the smallest angle.
        assert attitude.values[0] == pytest.approx(float(angle), rel=1e-15)


def test_arc_length_of_a_steady_screw_is_speed_times_time() -> None:
    """A centre that moves at a constant speed travels speed times span."""
    scene = load("kirchhoff/steady-spin")
    with mp.workdps(30):
        truth = solution(scene).motion(scene.clock.elapsed, 20)
        U = tensors.apply(scene.body.linear, scene.initial.linear)
        U = tensors.plus(U, tensors.apply(scene.body.coupling, scene.initial.angular))
        speed = mp.sqrt(mp.convert(tensors.dot(U, U)))
        expected = speed * mp.convert(abs(scene.clock.elapsed[-1]))
        assert abs(Arc().through(scene, truth) / expected - 1) <= mpf("1e-18")


# Drift and balance.


def test_balance_of_the_exact_motion_under_load_is_zero() -> None:
    """With moments the work balance of the truth itself closes to the digits of the truth."""
    scene = load("euler/constant-moment")
    scene = replace(scene, clock=Clock(Fraction(0), (Fraction(1), Fraction(3))))
    exact = solution(scene)
    with mp.workdps(40):
        truth = exact.motion(scene.clock.elapsed, 40)
        start = exact.motion([Fraction(0)], 40)
        drifts = Drifts(scene, start, 35, invariants(scene))
        drifts.add(scene.clock.elapsed, truth, truth, truth.quantities)
        for _, errors in drifts.errors():
            # Three terms of 35 digits each.
            assert all(error <= mpf("1e-33") for error in errors.values)


def test_an_answer_that_runs_away_does_not_hide_its_own_drift() -> None:
    """A drift has the scale of the exact motion: 1 % at the first row is 1 %, whatever follows."""
    scene = load("euler/generic")
    exact = solution(scene)
    with mp.workdps(40):
        truth = exact.motion(scene.clock.elapsed, 30)
        start = exact.motion([Fraction(0)], 30)
        factors = [mp.sqrt(mpf("1.01")), *[mpf(1)] * (len(truth.radius) - 2), mpf(10) ** 28]
        rows = truth["omega"] * np.array(factors, dtype=object)[:, None]
        answer = Motion({"omega": rows}, truth.radius)
        drifts = Drifts(scene, start, 30, invariants(scene))
        drifts.add(scene.clock.elapsed, truth, answer, answer.quantities)
        for _, errors in drifts.errors():
            assert float(errors.values[0]) == pytest.approx(0.01, rel=1e-9)
            assert float(errors.values[-1]) == pytest.approx(1e56, rel=1e-9)


# The floor.


def test_floor_of_a_body_at_constant_spin_is_a_random_walk() -> None:
    """A spherical body only adds up roundings: the floor after N steps is u sqrt(N) |omega|."""
    times = tuple(Fraction(k) for k in range(65))
    body = RigidBody(tensors.diagonal((Fraction(2),) * 3))
    spin = Spin((Fraction(1), Fraction(2), Fraction(2)))
    scene = Scene("ball", "", "euler", frozenset(), body, spin, Clock(Fraction(0), times))
    floors = _floor_of(scene, steps=6400)
    (errors,) = state_errors(scene, _truth(scene), _truth(scene))
    # One injection at the start besides the 6400, hence a per cent.
    assert floors.of_state(errors)[-1] == pytest.approx(2.0**-53 * 80, rel=0.01)


def _truth(scene: Scene) -> Motion:
    return solution(scene).motion(scene.clock.elapsed, 25)


def _floor_of(scene: Scene, steps: int) -> Floor:
    return floor(scene, scene, Fraction(1, 2**53), steps)


def test_sound_solver_stays_near_the_floor_and_not_far_below() -> None:
    """On a regular orbit heyoka's error is between a hundredth of the attainable one and all of it."""
    (_, omega, *_) = run("euler/generic", "taylor", "f64").verdicts
    assert omega.verdict is Status.PASS
    assert 0.01 <= omega.ratio <= 3


# Truths that cannot be had.


class Doubtful(Settled):
    """A truth whose two evaluations never agree."""

    route, regime = "mpmath", "generic"

    def evaluate(self, elapsed: list[Fraction], digits: int) -> dict[str, object]:
        return {"omega": np.array([[mpf(digits)] * 3 for _ in elapsed], dtype=object)}


def test_truth_that_does_not_settle_is_undecided(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where two precisions never agree there is no verdict but undecided, and it is not green."""
    from taylor_verify.judge import gated

    with pytest.raises(Unsettled):
        Doubtful().motion([Fraction(1)], 20)
    monkeypatch.setattr(gated, "truth", lambda scene, digits: Doubtful())
    verdicts = run("euler/generic", "taylor", "f64").verdicts
    assert [v.verdict for v in verdicts] == [Status.UNDECIDED]
    assert exit_status(verdicts) == 3


# Damped motions

RIGID, NEGATIVE, FLUID = "euler/damped", "euler/damped-negative", "kirchhoff/damped"


def with_damping(name: str, damping: Fraction, end: int | None = None) -> Scene:
    """A shipped scene with this damping, asked at ten instants of its own span or another."""
    scene = load(name)
    start = scene.clock.start
    span = scene.clock.elapsed[-1] if end is None else Fraction(end)
    instants = tuple(start + span * Fraction(k, 10) for k in range(11))
    body = replace(scene.body, damping=damping)  # type: ignore[type-var]
    return replace(scene, body=body, clock=Clock(start, instants))


@pytest.mark.parametrize("on", by_turns(["f64", "f32", "f80"]))
@pytest.mark.parametrize("name", [RIGID, NEGATIVE, FLUID])
def test_the_shipped_scenes_pass(name: str, on: str) -> None:
    """Every row of a damped scene passes, the invariants times their factors among them."""
    judgement = run(name, "taylor", on)
    assert {verdict.verdict for verdict in judgement.verdicts} == {Status.PASS}
    conserved = (
        {"T", "H2", "H_space"} if "euler" in name else {"T", "F2", "FG", "y3", "x_space", "y_space"}
    )
    assert {verdict.quantity for verdict in judgement.verdicts} >= conserved


@pytest.mark.parametrize(
    ("name", "damping"),
    by_turns(
        [
            ("euler/gyrostat", Fraction(1, 10)),
            ("euler/constant-moment", Fraction(-1, 50)),
            ("kirchhoff/constant-loads", Fraction(1, 10)),
            ("euler/gyrostat", Fraction(-1, 50)),
            ("euler/constant-moment", Fraction(1, 10)),
            ("kirchhoff/constant-loads", Fraction(-1, 50)),
        ],
        6,
        lambda name, damping: name,
    ),
)
def test_loads_and_wheels_have_balances(name: str, damping: Fraction) -> None:
    """With a load or with wheels the balances of T and of the momenta pass, by Taylor series."""
    judgement = run(with_damping(name, damping, 4), "taylor", "f64")
    assert {verdict.verdict for verdict in judgement.verdicts} == {Status.PASS}
    assert judgement.record.route == "taylor"


def test_what_has_decayed_below_the_least_number_excuses_itself() -> None:
    """On f32 e^{-280} is zero: the invariants are vacuous there, while omega is judged and passes."""
    judgement = run(with_damping(RIGID, Fraction(14), 20), "taylor", "f32")
    verdicts = {verdict.quantity: verdict.verdict for verdict in judgement.verdicts}
    assert verdicts["omega"] is Status.PASS
    assert {verdicts[name] for name in ("T", "H2", "H_space")} == {Status.VACUOUS}
    wide = run(with_damping(RIGID, Fraction(14), 20), "taylor", "f64")
    assert {verdict.verdict for verdict in wide.verdicts} == {Status.PASS}


def test_a_decay_beyond_float64_is_undecided() -> None:
    """Where errors shrink by more than e^300 nothing is said of them, and the reason is."""
    (verdict,) = run(with_damping(RIGID, Fraction(1000)), "taylor", "f64").verdicts
    assert verdict.verdict is Status.UNDECIDED
    assert "beyond e^300" in verdict.sentence


@pytest.mark.parametrize("name", [RIGID, FLUID])
def test_errors_decay_with_the_motion(name: str) -> None:
    """The volume of a small cloud of momenta shrinks by e^{-ct} in each direction."""
    scene = load(name)
    orbit = transition(scene, scene.clock.elapsed)
    d = orbit.momentum.shape[1]
    volumes = np.linalg.det(orbit.carried.since_first[:, :d, :d])
    times = np.array([float(t) for t in scene.clock.elapsed])
    expected = np.exp(-d * float(scene.body.damping) * times)
    assert np.allclose(volumes / expected, 1, atol=1e-4)
    assert path(scene).is_regular


def test_a_weak_damping_has_the_floor_of_none() -> None:
    """With c = 1e-12 all that is attainable is what it is without damping, to six digits."""
    floors = []
    for damping in (Fraction(0), Fraction(1, 10**12)):
        scene = with_damping(RIGID, damping)
        given = pose(scene, rung("f64")).given
        weak = floor(given, scene, rung("f64").unit_roundoff, 100)
        floors.append(np.concatenate([weak.carried[name] for name in ("momentum", "attitude")]))
    assert np.allclose(*floors, rtol=1e-6)
