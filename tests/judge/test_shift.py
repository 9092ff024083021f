"""What an error means: an answer that is late by so much, in what course of time, and what is left."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from builders.trajectories import VECTORS, columns_at, write_csv
from builders.turns import by_turns
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from taylor_verify.check import check
from taylor_verify.exact.rates import rates
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Solution
from taylor_verify.judge.errors.shift import Shift, time_shifts
from taylor_verify.judge.errors.state import state_errors
from taylor_verify.judge.judgement import judgement
from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import exact_value, power_of_two, rung
from taylor_verify.records.reason import Kind
from taylor_verify.records.status import Status
from taylor_verify.records.store import load as load_report
from taylor_verify.records.store import write
from taylor_verify.run import run
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Clock, Motion, Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.callback import Callback
from taylor_verify.solvers.taylor.driver import Taylor

pytestmark = pytest.mark.usefixtures("without_causes")
Course = Callable[[float], Fraction]
DIGITS = 25
# Every quantity and every model, closed forms and none, loads, and a time that runs backward.
SCENES = (
    "euler/with-attitude",
    "euler/constant-moment",
    "euler/backward",
    "euler/separatrix",
    "kirchhoff/whole-motion",
)


@cache
def asked(name: str, samples: int = 11) -> tuple[Scene, Solution]:
    """A shipped scene at a few of its instants."""
    scene = load(name)
    instants = scene.clock.instants
    chosen = instants[:: max(1, len(instants) // (samples - 1))]
    scene = replace(scene, clock=Clock(scene.clock.start, chosen))
    return scene, solution(scene)


def shifted(exact: Solution, scene: Scene, course: Course) -> Motion:
    """exact(t - c) at the scene's instants, with c by the time elapsed."""
    return exact.motion([t - course(float(t)) for t in scene.clock.elapsed], DIGITS)


def shifts_of(name: str, course: Course, samples: int = 11) -> dict[str, Shift | None]:
    scene, exact = asked(name, samples)
    return judged(scene, exact, shifted(exact, scene, course))


def judged(scene: Scene, exact: Solution, answer: Motion) -> dict[str, Shift | None]:
    truth = exact.motion(scene.clock.elapsed, DIGITS)
    with mp.workdps(2 * DIGITS):
        errors = state_errors(scene, truth, answer)
        shifts = time_shifts(scene, exact, truth, answer, DIGITS, errors)
    return {e.quantity: shift for e, shift in zip(errors, shifts, strict=True)}


def pushed(scene: Scene, motion: Motion, size: float) -> Motion:
    """A motion whose omega is moved by so much, at right angles to its velocity."""
    across = np.cross(rates(scene, motion).velocity["omega"], [1.0, 2.0, 3.0])
    across *= size / np.linalg.norm(across, axis=1, keepdims=True)
    with mp.workdps(DIGITS):
        omega = motion["omega"] + np.array([[mpf(v) for v in row] for row in across.tolist()])
    return Motion({"omega": omega}, motion.radius)


# A shift that was put in comes out.


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("text", by_turns(["0.0005", "-0.0005"]))
def test_half_a_millisecond_late_is_found_and_nothing_remains(name: str, text: str) -> None:
    """Every quantity of exact(t - c) is late by c, constantly, and the truth's width remains."""
    for shift in shifts_of(name, lambda t: Fraction(text)).values():
        assert shift.kind is Kind.CONSTANT
        assert shift.time_shift == pytest.approx(float(text), rel=1e-12)
        assert shift.residual <= 10.0**-DIGITS * 10
        assert (
            shift.terms()
            .sentence()
            .startswith(f"{'late' if shift.time_shift > 0 else 'early'} by 0.0005")
        )


@settings(max_examples=4)
@given(st.floats(-5, 5).filter(lambda c: abs(c) > 1e-6))
def test_a_shift_of_up_to_half_a_period_is_found(c: float) -> None:
    """A search begins where first order points anywhere: the period of this orbit is 11.3."""
    shift = shifts_of("euler/generic", lambda t: exact_value(c), samples=21)["omega"]
    assert shift.kind is Kind.CONSTANT
    assert shift.time_shift == pytest.approx(c, rel=1e-9)
    assert shift.residual <= 1e-20


@pytest.mark.parametrize("pace", ["1e-6", "-1e-4", "0.01"])
def test_a_clock_that_runs_wrong_drifts(pace: str) -> None:
    """exact((1 - s)(t - start)) is late in proportion to t, by s, and next to nothing remains."""
    for shift in shifts_of(
        "euler/with-attitude", lambda t: Fraction(pace) * exact_value(t)
    ).values():
        assert shift.kind is Kind.DRIFTING
        assert shift.trend == pytest.approx(float(pace), rel=1e-9)
        # A course is held in float64: of the largest shift 2^-52, at a speed near one.
        assert shift.remains <= 60 * abs(float(pace)) * 1e-15
        word = "slow" if float(pace) > 0 else "fast"
        assert (
            f"drifting: its clock runs {word} by {abs(float(pace)):.3g} per"
            in shift.terms().sentence()
        )


@pytest.mark.parametrize("name", SCENES)
def test_a_first_row_that_is_not_late_is_named_and_spoils_no_fit(name: str) -> None:
    """A first row that is the given start leaves the shift of all others exact, and is named."""

    def course(t: float) -> Fraction:
        return Fraction(-1, 10000) if t else Fraction(0)

    for shift in shifts_of(name, course, samples=21).values():
        assert shift.kind is Kind.CONSTANT
        assert shift.time_shift == pytest.approx(-1e-4, rel=1e-12)
        assert shift.residual == shift.remains <= 10.0**-DIGITS * 10
        assert shift.strays == shift.times[:1]
        assert shift.terms().sentence().startswith("early by 0.0001, constant; ")
        rows = len(shift.times)
        words = (
            f" in {rows - 1} of {rows} rows; the row at t = {shift.times[0]:g} does not share it"
        )
        assert shift.terms().sentence().endswith(words)


def test_a_drift_is_fitted_without_the_rows_that_do_not_share_it() -> None:
    """The pace of a clock that runs slow but for two of 41 rows is exact, and both rows are named."""

    def course(t: float) -> Fraction:
        return Fraction(1, 10) if t in (6.0, 13.5) else exact_value(t) / 1000

    for shift in shifts_of("euler/with-attitude", course, samples=41).values():
        assert shift.kind is Kind.DRIFTING
        assert shift.trend == pytest.approx(1e-3, rel=1e-9)
        assert shift.strays == (6.0, 13.5)
        assert shift.remains <= 1e-15
        assert (
            "in 39 of 41 rows; the rows at t = 6, 13.5 do not share it" in shift.terms().sentence()
        )


def test_a_third_of_an_error_along_the_orbit_is_no_clock() -> None:
    """An error of which a shift leaves a third is a wrong equation, and not a clock that runs fast."""
    scene, exact = asked("euler/generic", 41)
    late = shifted(exact, scene, lambda t: exact_value(t) / 10**6)
    error = late["omega"] - exact.motion(scene.clock.elapsed, DIGITS)["omega"]
    third = max(np.linalg.norm(error.astype(float), axis=1)) / 3
    shift = judged(scene, exact, pushed(scene, late, third))["omega"]
    assert shift.kind is Kind.NONE


def test_a_shift_that_comes_and_goes_wanders() -> None:
    """Neither constant nor linear, but every sample of it is found by itself."""

    def course(t: float) -> Fraction:
        return exact_value(1e-4 * math.sin(t / 7))

    scene, _ = asked("euler/with-attitude")
    for shift in shifts_of("euler/with-attitude", course).values():
        assert shift.kind is Kind.WANDERING
        expected = [float(course(float(t))) for t in scene.clock.elapsed]
        assert shift.at_samples == pytest.approx(expected, rel=1e-9, abs=1e-15)
        assert shift.remains <= 1e-20


@pytest.mark.parametrize("exponent", [-400, 400])
def test_the_unit_of_time_does_not_matter(exponent: int) -> None:
    """A motion in a unit of time 2^k times as long is late by 2^-k times the number."""
    scene, _ = asked("euler/generic")
    unit = power_of_two(exponent)
    clock = Clock(Fraction(0), tuple(t / unit for t in scene.clock.elapsed))
    omega = tuple(unit * w for w in scene.initial.omega)
    scene = replace(scene, initial=replace(scene.initial, omega=omega), clock=clock)
    exact = solution(scene)
    shift = judged(scene, exact, shifted(exact, scene, lambda t: Fraction(1, 2000) / unit))["omega"]
    assert shift.kind is Kind.CONSTANT
    assert shift.time_shift * 2.0**exponent == pytest.approx(0.0005, rel=1e-12)


def test_an_error_across_the_motion_is_no_shift() -> None:
    """A push at right angles to the velocity stays: no shift explains it, and all of it is residual."""
    scene, exact = asked("euler/generic")
    truth = exact.motion(scene.clock.elapsed, DIGITS)
    velocity = rates(scene, truth).velocity["omega"]
    shift = judged(scene, exact, pushed(scene, truth, 1e-8))["omega"]
    assert shift.kind is Kind.NONE
    assert shift.terms().sentence() == "no shift of time explains it"
    largest = 1e-8 / max(np.linalg.norm(truth["omega"].astype(float), axis=1))
    assert shift.residual == pytest.approx(largest, rel=1e-6)
    assert abs(shift.time_shift) * np.max(np.linalg.norm(velocity, axis=1)) <= 1e-12


def test_what_a_shift_leaves_is_told_beside_it() -> None:
    """An answer that is late and wrong by 3e-9 across the motion: both numbers come out."""
    scene, exact = asked("euler/generic")
    late = shifted(exact, scene, lambda t: Fraction(1, 2000))
    size = max(np.linalg.norm(late["omega"].astype(float), axis=1))
    shift = judged(scene, exact, pushed(scene, late, 3e-9 * size))["omega"]
    assert shift.terms().sentence() == "late by 0.0005, constant; 3e-09 remains"
    # The scale of an error is that of the truth, at its own instants.
    assert shift.residual == pytest.approx(3e-9, rel=0.05)


@pytest.mark.parametrize("name", ["euler/rest", "euler/spherical", "kirchhoff/rest"])
def test_where_omega_rests_no_shift_explains_anything(name: str) -> None:
    """A motion that stands still tells no time, whatever the error."""
    scene, exact = asked(name)
    truth = exact.motion(scene.clock.elapsed, DIGITS)
    main = "omega" if scene.model == "euler" else "linear_impulse"
    wrong = dict(truth.quantities) | {main: truth[main] + mpf(2) ** -30}
    shift = next(iter(judged(scene, exact, Motion(wrong, truth.radius)).values()))
    assert (shift.kind, shift.time_shift) == (Kind.NONE, 0.0)
    assert shift.residual > 0


def test_no_number_has_no_shift() -> None:
    """A NaN at one sample leaves nothing to say."""
    scene, exact = asked("euler/generic")
    truth = exact.motion(scene.clock.elapsed, DIGITS)
    omega = truth["omega"].copy()
    omega[3, 1] = mp.nan
    assert judged(scene, exact, Motion({"omega": omega}, truth.radius)) == {"omega": None}


# In a verdict.


def test_a_sound_answer_has_the_numbers_and_no_words() -> None:
    """The bound's reason stands alone if the gate passes; conserved quantities never have a shift."""
    result = run("euler/with-attitude", "taylor", "f64")
    for verdict in result.verdicts:
        is_state = verdict.quantity in ("omega", "attitude")
        numbers = (verdict.time_shift, verdict.residual, verdict.shift)
        assert all((value is not None) == is_state for value in numbers)
        assert "shift" not in verdict.because
        if is_state:
            assert verdict.residual <= 2 * verdict.max
            assert verdict.shift in list(Kind)
    assert all(gate.shifts == () for gate in result.record.gates)


def test_a_vacuous_gate_says_what_is_gated_in_its_place() -> None:
    """Only conserved quantities are gated if roundoff alone may be as large as the state."""
    # Beside the unstable axis by 1e-12, and for several flips: e^(t/sqrt 3) grows beyond 2^53.
    edge = replace(
        load("euler/generic"),
        body=RigidBody(tensors.diagonal((Fraction(1), Fraction(2), Fraction(3)))),
        initial=Spin((Fraction(1, 10**12), Fraction(1), Fraction(0))),
        clock=Clock(Fraction(0), tuple(map(Fraction, range(0, 201, 5)))),
    )
    problem = pose(edge, rung("f64"))
    _, omega, *conserved = judgement(problem, Taylor(), Taylor().solve(problem)).verdicts
    assert omega.verdict is Status.VACUOUS
    assert "only the conserved quantities are gated" in omega.because
    assert all(v.verdict is not Status.VACUOUS for v in conserved)


def test_what_is_rounding_is_not_published(tmp_path: Any) -> None:
    """A shift made of roundings is another on every machine; that of a failed gate is its finding."""
    passed = run("euler/generic", "taylor", "f64").verdicts
    failed = judgement(*answered("euler/with-attitude")).verdicts
    write(tmp_path, [*passed, *failed], [])
    text = json.loads((tmp_path / "data" / "verdicts.json").read_text(encoding="utf-8"))
    for row in text["verdicts"]:
        assert ("time_shift" in row) == (row["verdict"] == "fail")
    read = {(v.scene, v.quantity): v for v in load_report(tmp_path)}
    first = next(v for v in failed if v.quantity == "omega")
    assert read["euler/with-attitude", "omega"].time_shift == first.time_shift
    assert read["euler/generic", "omega"].time_shift is None


def answered(name: str) -> Any:
    """A scene whose answer is late by one part in a thousand of the first interval."""
    problem = pose(load(name), rung("f64"))
    sound = Taylor().solve(problem)
    omega = sound.quantities["omega"].copy()
    omega[1:] = omega[:-1]
    solver = Callback(lambda _: None, name="late")
    return problem, solver, replace(sound, quantities=dict(sound.quantities) | {"omega": omega})


# How wide the truth is, quantity by quantity.


def test_an_exactly_known_impulse_is_not_undecided_beside_an_inexact_attitude() -> None:
    """The impulse of a body at rest is zero without a width, though the attitude's quotients have one."""
    scene = load("kirchhoff/rest")
    turned = (Fraction(1), Fraction(2), Fraction(3), Fraction(4))
    scene = replace(
        scene,
        track=frozenset({"attitude", "centre"}),
        initial=replace(scene.initial, attitude=turned),
    )
    problem = pose(scene, rung("f64"))
    truth = solution(problem.given).motion(problem.given.clock.elapsed, 19)
    assert max(truth.radius_of("linear_impulse")) == 0 < max(truth.radius_of("attitude"))
    assert max(truth.radius) == max(truth.radius_of("attitude"))
    verdicts = judgement(problem, Taylor(), Taylor().solve(problem)).verdicts
    assert {v.quantity: v.verdict for v in verdicts}["impulse"] is Status.PASS


MILLI = Fraction(1, 1000)


@pytest.mark.parametrize(
    ("course", "kind", "number"),
    [
        (lambda t: t - MILLI, "constant", "time_shift"),
        (lambda t: t and t - MILLI, "constant", "time_shift"),
        (lambda t: t - t * MILLI, "drifting", "trend"),
    ],
    ids=["late", "late but for the first row", "slow"],
)
def test_the_angular_velocity_of_a_solid_in_a_fluid_has_its_shift(
    course: Callable[[Fraction], Fraction], kind: str, number: str, tmp_path: Path
) -> None:
    """Omega = B^T x + C y, which is no state, is late by a constant or drifts with its clock."""
    scene = load("kirchhoff/whole-motion")
    instants = scene.clock.instants[:60:3]
    columns = columns_at(scene, [course(t) for t in instants])
    columns = {name: columns[name] for name in VECTORS["omega"]} | {"t": [*map(float, instants)]}
    verdicts = check(scene, write_csv(tmp_path / "mine.csv", columns)).verdicts
    omega = next(v for v in verdicts if v.quantity == "omega")
    assert omega.shift == kind
    assert getattr(omega, number) == pytest.approx(1e-3, rel=1e-9 if kind == "constant" else 1e-6)
    # Rounding to doubles is left, of Omega and of the times.
    assert omega.remains <= 1e-13
    assert omega.residual == omega.remains or kind == "drifting"


def of_all(name: str, late: Fraction, factor: float = 1.0) -> dict[str, Shift | None]:
    """The shifts of an answer whose rows are all late and multiplied."""
    scene, exact = asked(name)
    motion = exact.motion([t - late for t in scene.clock.elapsed], DIGITS)
    rows = {name: factor * rows for name, rows in motion.quantities.items()}
    return judged(scene, exact, Motion(rows, motion.radius))


NO_CLOSED_FORM = "kirchhoff/general-body"


def test_a_shift_is_exact_where_the_motion_was_searched_in_float64() -> None:
    """An error as large as the motion is searched in float64; what is found is settled by the enclosure."""
    shift = of_all(NO_CLOSED_FORM, Fraction(2, 5))["impulse"]
    assert shift.kind is Kind.CONSTANT
    assert shift.time_shift == pytest.approx(0.4, rel=1e-14)
    # The shift is a double, and 2/5 is none.
    assert shift.remains < 1e-15


@pytest.mark.parametrize("with_first", [True, False], ids=["first row given", "all rows shifted"])
def test_a_clock_that_is_early_and_drifts_is_told_both(with_first: bool) -> None:
    """A constant and a rate together are no constant, whether or not the first row is the start."""

    def early(problem: Problem) -> Any:
        times = [t * Fraction(1001, 1000) + Fraction(1, 50) for t in problem.given.clock.elapsed]
        if with_first:
            times[0] = Fraction(0)
        return solution(problem.given).motion(times, 20)["omega"]

    shift = next(v for v in check("euler/generic", early).verdicts if v.quantity == "omega")
    assert shift.shift == "drifting"
    assert shift.trend == pytest.approx(-1e-3, rel=1e-6)
    assert (
        "its clock runs fast by 0.001 per unit of time and is early by 0.02 at t = 0"
        in shift.because
    )
