"""Balances of work and impulse under loads that change with time."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from typing import Any

import numpy as np
import pytest
from builders.integrators import step
from mpmath import mp, mpf

from taylor_verify.exact.route import solution
from taylor_verify.exact.taylor import arcs
from taylor_verify.judge.errors.balances import clock_work
from taylor_verify.judge.judgement import Judgement
from taylor_verify.models.problem import Problem
from taylor_verify.records.status import Status
from taylor_verify.run import run
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.manufactured import Manufactured
from taylor_verify.scenes.motion import Clock, Impulse, Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.callback import Callback
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.straight_line import straight_line
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.solvers.trajectory import Trajectory

EULER = "manufactured/euler-tones"
KIRCHHOFF = "manufactured/kirchhoff-tones"
BALANCES = {EULER: {"T", "H2"}, KIRCHHOFF: {"T", "F2", "FG"}}


def over(name: str, end: Fraction, samples: int) -> Scene:
    """The scene without its frame, over another time."""
    times = tuple(end * k / (samples - 1) for k in range(samples))
    return replace(load(name), track=frozenset(), clock=Clock(Fraction(0), times))


def motion_of(scene: Scene) -> Manufactured:
    assert scene.body.manufactured is not None
    return scene.body.manufactured


def status(judgement: Judgement) -> dict[str, Status]:
    return {verdict.quantity: verdict.verdict for verdict in judgement.verdicts}


# The arcs.


@pytest.mark.parametrize("name", [EULER, KIRCHHOFF])
def test_an_arc_takes_up_the_loads_where_it_begins(name: str) -> None:
    """From the motion at any time the recursion leads along the motion, to 30 digits."""
    scene = over(name, Fraction(9), 4)
    begins = [Fraction(0), Fraction(29, 10), Fraction(-7, 3), Fraction(10**6)]
    spans = [Fraction(1, 2), Fraction(-3, 10), Fraction(1, 4), Fraction(1, 3)]
    exact = solution(scene)
    known = exact.motion(begins, 60)
    ends = exact.motion([b + s for b, s in zip(begins, spans, strict=True)], 40)
    starts = [
        started(scene, {n: rows[k] for n, rows in known.quantities.items()}) for k in range(4)
    ]
    arcs_after = arcs(scene, starts, spans, 30, begins)
    with mp.workdps(50):
        for quantity, rows in ends.quantities.items():
            missed = [mp.norm(list(a - b)) for a, b in zip(rows, arcs_after[quantity], strict=True)]
            assert max(missed) <= mpf(10) ** -29


def started(scene: Scene, row: Mapping[str, Any]) -> Any:
    """A state of exact rationals: those of the numbers as they are."""

    def exact(values: Any) -> tuple[Fraction, ...]:
        pairs = (value.as_integer_ratio() for value in values)
        return tuple(Fraction(int(n), int(d)) for n, d in pairs)

    if isinstance(scene.initial, Spin):
        return replace(scene.initial, omega=exact(row["omega"]))
    assert isinstance(scene.initial, Impulse)
    linear, angular = exact(row["linear_impulse"]), exact(row["angular_impulse"])
    return replace(scene.initial, linear=linear, angular=angular)


def test_arcs_under_a_clock_say_when_they_begin() -> None:
    """Without the times of their beginnings there is no telling the loads."""
    scene = over(EULER, Fraction(1), 2)
    with pytest.raises(ValueError, match="begin"):
        arcs(scene, [scene.initial], [Fraction(1)], 20)


# What a clock that is off does.


@dataclass(frozen=True)
class ClockOff(Solver):
    """The Taylor driver, its cosine of the first wave off by this much at the start."""

    by: Fraction
    name: str = "clock off"
    setting: str = ""

    def solve(self, problem: Problem) -> Trajectory:
        start = [
            value + self.by * (state == "u1")
            for state, value in zip(problem.form.states, problem.initial_momenta, strict=True)
        ]
        return Taylor().solve(replace(problem, initial_momenta=tuple(start)))


@pytest.mark.parametrize("name", [EULER, pytest.param(KIRCHHOFF, marks=pytest.mark.slow)])
def test_an_offset_of_the_clock_does_the_work_that_is_allowed_for_it(name: str) -> None:
    """The balances of a solver whose clock begins 2^-24 off move as the floor has it, at all times.

    The floor is that of arcs of no length: from arcs of a tenth and of a twentieth follows what it is.
    """
    late = Fraction(1, 2**24)
    coarse, fine = (moved(over(name, Fraction(6), n), ClockOff(late)) for n in (61, 121))
    assert set(coarse) >= BALANCES[name]
    work = clock_work(over(name, Fraction(6), 61))
    for quantity in BALANCES[name]:
        expected = float(late) * np.abs(at(work[quantity].done[:, 0], 61))
        # Where it is large it keeps its sign, which a drift does not tell, and no arc turns that.
        large = expected >= expected.max() / 2
        extrapolated = 2 * fine[quantity][::2] - coarse[quantity]
        # What is left is of the second order of a tenth, and of the floor's own nodes.
        assert np.max(np.abs(extrapolated - expected)[large]) <= expected.max() / 20


def moved(scene: Scene, solver: Solver) -> dict[str, Any]:
    judgement = run(scene, solver, "f64", causes=False)
    assert judgement.record is not None
    return {gate.quantity: np.array(gate.errors) for gate in judgement.record.gates}


def at(done: Any, samples: int) -> Any:
    """Between the ends of the parts the values lie on straight lines."""
    return np.interp(np.linspace(0, 1, samples), np.linspace(0, 1, len(done)), done)


def test_the_roundings_of_the_clock_outgrow_those_of_the_state() -> None:
    """Over ten times the steps the floor of a clock grows by more than 10^(3/2)/2, and not by 10^(1/2).

    A steady wave pushes the body of the scene always the same way.
    """
    work = clock_work(over("manufactured/euler-from-rest", Fraction(80), 3))["T"]
    early, late = work.drift(Fraction(1), 1000, np.array([8.0, 80.0]), work.scale)
    assert late / early >= 10**1.5 / 2


# What is broken is found.


@dataclass(frozen=True)
class Forced(Solver):
    """The classical Runge-Kutta method, told of the loads by a function of time.

    ``clock`` gives the cosines and sines at t for the step that began at ``since``.
    """

    clock: Callable[[Problem, float, float], list[float]]
    name: str = "forced"
    setting: str = ""
    # The error of a step this long is below the roundoff of f32, where it is asked, by a hundred times.
    steps: int = 800

    def solve(self, problem: Problem) -> Trajectory:
        return Callback(self._rows).solve(problem)

    def _rows(self, problem: Problem) -> Any:
        rates = straight_line(problem.form, [float(p) for p in problem.parameters])
        state_size = len(problem.form.states) - 2 * len(motion_of(problem.given).waves)

        def rate(since: float, t: float, z: Any) -> Any:
            clock = self.clock(problem, t, since)
            return np.array(rates(t, [*z, *clock])[:state_size])

        z = np.array([float(v) for v in problem.initial_momenta[:state_size]])
        t, rows = 0.0, []
        h = float(problem.times[-1]) / self.steps
        for end in map(float, problem.times):
            while end - t > h / 2:
                z, t = step(partial(rate, t), t, z, h), t + h
            rows.append(in_scene_units(problem, z))
        return rows


def in_scene_units(problem: Problem, z: Any) -> list[float]:
    """omega, or x and y."""
    units, body = problem.units, problem.given.body
    if isinstance(body, RigidBody):
        K = np.array(body.inverse_inertia, dtype=float)
        return list(K @ z * float(units.momentum))
    return [*(z[:3] * float(units.impulse)), *(z[3:] * float(units.momentum))]


def angles(problem: Problem, t: float) -> list[float]:
    names = [f"n{k}" for k in range(1, len(motion_of(problem.given).waves) + 1)]
    return [float(problem.parameter[name]) * t for name in names]


def clock_at(problem: Problem, t: float, since: float) -> list[float]:
    del since
    return [f(angle) for angle in angles(problem, t) for f in (np.cos, np.sin)]


def held_clock(problem: Problem, t: float, since: float) -> list[float]:
    del t
    return clock_at(problem, since, since)


def without_second(problem: Problem, t: float, since: float) -> list[float]:
    """The second wave stands still: its part of the loads is left out."""
    return [*clock_at(problem, t, since)[:2], 1.0, 0.0]


@pytest.mark.parametrize("name", [EULER, KIRCHHOFF])
@pytest.mark.parametrize("broken", [held_clock, without_second])
def test_the_balances_see_a_load_that_is_not_that_of_the_time(name: str, broken: Any) -> None:
    """Loads held over a step, or without their second wave, fail by every balance; the twin passes."""
    scene = over(name, Fraction(2), 21)
    sound = status(run(scene, Forced(clock_at), "f32", causes=False))
    assert all(sound[gate] is Status.PASS for gate in BALANCES[name])
    spoiled = status(run(scene, Forced(broken), "f32", causes=False))
    assert all(spoiled[gate] is Status.FAIL for gate in BALANCES[name])


def test_the_exact_answer_is_balanced_to_its_last_bits() -> None:
    """The truth rounded to 25 digits passes a gate on f64 by ten digits less."""

    def answer(problem: Problem) -> Any:
        return solution(problem.given).evaluate(problem.given.clock.elapsed, 25)["omega"]

    judgement = run(over(EULER, Fraction(5), 11), Callback(answer), "f64", causes=False)
    assert all(
        verdict.verdict is Status.PASS and verdict.ratio <= 1e-6
        for verdict in judgement.verdicts
        if verdict.quantity in BALANCES[EULER]
    )
