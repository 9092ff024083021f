"""Manufactured motions: the motion solves the equations, exactly, and broken equations do not pass."""

from __future__ import annotations

import random
from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf

from taylor_verify.exact.conditioning.condition import transition
from taylor_verify.exact.conditioning.differences import derivatives
from taylor_verify.exact.rates import rates
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import NoClosedForm
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.models import euler
from taylor_verify.models.algebra import add, apply, cross
from taylor_verify.models.euler import euler_equations
from taylor_verify.models.form import Equations, Named, labelled
from taylor_verify.models.kirchhoff import kirchhoff_equations, velocities
from taylor_verify.models.manufactured import Loaded
from taylor_verify.models.problem import Problem, pose
from taylor_verify.models.registry import mechanics
from taylor_verify.numbers.precision import rung
from taylor_verify.records.precisions import LADDER
from taylor_verify.records.status import Status
from taylor_verify.run import run
from taylor_verify.scenes import library
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.manufactured import Manufactured, Wave
from taylor_verify.scenes.reading.reader import load, read
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.callback import Callback
from taylor_verify.solvers.registry import solver_named
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.solvers.trajectory import Trajectory

NAMES = library.names("manufactured")
EULER = "manufactured/euler-full-tensor"
KIRCHHOFF = "manufactured/kirchhoff-tones"


def bare(name: str) -> Scene:
    """The scene without its frame: all of it has a closed form."""
    return replace(load(name), track=frozenset())


def motion_of(scene: Scene) -> Manufactured:
    assert scene.body.manufactured is not None
    return scene.body.manufactured


def vectors(quantities: Mapping[str, Any]) -> Any:
    """omega, or x and y side by side."""
    parts = [
        quantities[n] for n in ("omega", "linear_impulse", "angular_impulse") if n in quantities
    ]
    return np.concatenate(parts, axis=1)


def drawn(seed: int, size: int) -> Manufactured:
    """A motion of random short rationals and frequencies."""
    coin = random.Random(seed)

    def vector() -> tuple[Fraction, ...]:
        return tuple(Fraction(coin.randint(-90, 90), coin.randint(1, 30)) for _ in range(size))

    frequencies = sorted({Fraction(coin.randint(1, 400), coin.randint(1, 40)) for _ in range(3)})
    return Manufactured(vector(), tuple(Wave(nu, vector(), vector()) for nu in frequencies))


# The truth.


@pytest.mark.parametrize("seed", range(6))
def test_two_routes_overlap(seed: int) -> None:
    """Arb's cosines and mpmath's agree to the digits that both claim."""
    scene, motion = bare(KIRCHHOFF), drawn(seed, 6)
    initial = replace(scene.initial, linear=motion.start[:3], angular=motion.start[3:])
    scene = replace(scene, body=replace(scene.body, manufactured=motion), initial=initial)
    elapsed = [
        Fraction(0),
        Fraction(1, 3),
        Fraction(-17, 5),
        Fraction(10**9, 7),
        Fraction(-(10**15)),
    ]
    balls, doubled = (solution(scene, route).motion(elapsed, 60) for route in ("arb", "mpmath"))
    with mp.workdps(80):
        for k in range(len(elapsed)):
            a, b = vectors(balls.quantities)[k], vectors(doubled.quantities)[k]
            allowed = (balls.radius[k] + doubled.radius[k]) * mp.norm(list(a))
            assert mp.norm(list(a - b)) <= allowed


@pytest.mark.parametrize("name", NAMES)
def test_the_recursion_on_the_equations_finds_the_motion(name: str) -> None:
    """exact.taylor, which only knows the equations and the loads, arrives where the cosines say."""
    scene = bare(name)
    end = [scene.clock.elapsed[-1] / 2]
    known, recursion = solution(scene).motion(end, 40), TaylorSolution(scene).motion(end, 40)
    assert (solution(scene).route, solution(scene).regime) == ("arb", "manufactured")
    with mp.workdps(60):
        a, b = vectors(known.quantities)[0], vectors(recursion.quantities)[0]
        assert mp.norm(list(a - b)) <= mpf(10) ** -39 * mp.norm(list(a))


def test_the_attitude_about_a_fixed_axis_is_known() -> None:
    """From rest about one axis, omega = a sin t turns the body by |a| (1 - cos t): R = R0 exp([angle]x)."""
    scene = load("manufactured/euler-from-rest")
    assert solution(scene).regime == "no closed form"
    elapsed = [Fraction(1, 2), Fraction(4), Fraction(8)]
    start, *attitudes = TaylorSolution(scene).motion([Fraction(0), *elapsed], 40)["attitude"]
    with mp.workdps(50):
        axis = [mp.convert(c) for c in motion_of(scene).waves[0].sine]
        for t, R in zip(elapsed, attitudes, strict=True):
            angle = 1 - mp.cos(mp.convert(t))
            x, y, z = (angle * c for c in axis)
            turned = mp.expm(mp.matrix([[0, -z, y], [z, 0, -x], [-y, x, 0]]))
            expected = np.array(start) @ np.array(turned.tolist(), dtype=object)
            assert np.max(np.abs(R - expected)) <= mpf(10) ** -38


def test_another_start_has_no_closed_form() -> None:
    """The cosines are the motion from their own start alone; from another the recursion is the truth."""
    scene = bare(EULER)
    omega = tuple(c + Fraction(1, 1000) for c in motion_of(scene).start)
    other = replace(scene, initial=replace(scene.initial, omega=omega))
    with pytest.raises(NoClosedForm, match="start"):
        solution(other, "arb")
    assert solution(other).route == "taylor"


@pytest.mark.parametrize("name", [EULER, KIRCHHOFF])
def test_the_variational_equations_carry_what_differences_carry(name: str) -> None:
    """d z(t) / d z(0) by float64 along the motion is that of two exact motions from nearby starts."""
    scene = bare(name)
    elapsed = [Fraction(0), Fraction(3, 2), Fraction(4)]
    carried = transition(scene, elapsed)
    block = "momentum" if scene.model == "euler" else "linear_impulse"
    flow = derivatives(scene, elapsed, 12, 40).momentum[:, :3, :3].astype(float)
    for k in range(3):
        norm = np.linalg.norm(flow[k], 2)
        assert abs(carried.norms(block, block)[k] - norm) <= 1e-3 * norm


def test_the_velocity_is_that_of_the_cosines() -> None:
    """exact.rates, from the equations and the clock, gives the derivative of the polynomial."""
    scene = bare(KIRCHHOFF)
    elapsed = [Fraction(1), Fraction(37, 10)]
    slopes = rates(scene, solution(scene).motion(elapsed, 20), elapsed)
    for k, t in enumerate(elapsed):
        expected = np.zeros(6)
        for wave in motion_of(scene).waves:
            nu, angle = float(wave.frequency), float(wave.frequency * t)
            a, b = (np.array(v, dtype=float) for v in (wave.cosine, wave.sine))
            expected += nu * (b * np.cos(angle) - a * np.sin(angle))
        for j, name in enumerate(("linear_impulse", "angular_impulse")):
            velocity = slopes.velocity[name][k] * 2.0 ** (slopes.units[name] - slopes.time)
            # A dozen roundings of terms of size one.
            assert np.max(np.abs(velocity - expected[3 * j : 3 * j + 3])) <= 1e-14


# What a solver is given.


@pytest.mark.parametrize("step", LADDER)
@pytest.mark.parametrize("name", NAMES)
def test_the_rounded_problem_is_exactly_manufactured(name: str, step: str) -> None:
    """Parameters and start are numbers of the rung, and the motion begins at the start, exactly."""
    problem = pose(load(name), rung(step))
    given = problem.given
    assert all(problem.rung.holds(v) for v in (*problem.parameters, *problem.initial_momenta))
    initial = given.initial
    start = initial.omega if isinstance(given.body, RigidBody) else initial.linear + initial.angular
    assert start == motion_of(given).start


def on_the_motion(problem: Problem, clock: Mapping[str, Any]) -> tuple[Named, dict[str, Any]]:
    """Parameters and states with H*, or x* and y*, in place of the state; and their derivatives.

    From the motion of the given scene, in the problem's units, for any numbers u and v.
    """
    given, units = problem.given, problem.units
    motion = motion_of(given)
    if isinstance(given.body, RigidBody):
        motion, sizes = motion.mapped(given.body.inertia), (units.momentum,) * 3
        names = ("H1", "H2", "H3")
    else:
        sizes = (units.impulse,) * 3 + (units.momentum,) * 3
        names = ("x1", "x2", "x3", "y1", "y2", "y3")
    scaled = motion.in_units(tuple(1 / s for s in sizes), 1 / units.time)
    value, rate = list(scaled.constant), [Fraction(0)] * len(names)
    for k, w in enumerate(scaled.waves, start=1):
        u, v = clock[f"u{k}"], clock[f"v{k}"]
        for i in range(len(names)):
            value[i] = value[i] + w.cosine[i] * u + w.sine[i] * v
            rate[i] = rate[i] + w.frequency * (w.sine[i] * u - w.cosine[i] * v)
    known = Named({**problem.parameter, **clock, **dict(zip(names, value, strict=True))})
    return known, dict(zip(names, rate, strict=True))


def residual(problem: Problem, equations: Equations) -> Fraction:
    """The largest |rate by the equations - rate of the motion|, in rationals, for some u and v."""
    coin = random.Random(7)
    waves = len(motion_of(problem.given).waves)
    names = [f"{letter}{k}" for k in range(1, waves + 1) for letter in "uv"]
    clock = {name: Fraction(coin.randint(-99, 99), 100) for name in names}
    known, expected = on_the_motion(problem, clock)
    numbers = {name: value for name, value in known.items() if value}
    rate_of = equations(Named(numbers | {"H1": known["H1"]} if "H1" in known else numbers))
    return max(abs(rate_of[name] - rate) for name, rate in expected.items())


@pytest.mark.parametrize("step", ["f32", "mp237"])
@pytest.mark.parametrize("name", NAMES)
def test_the_motion_put_back_leaves_nothing(name: str, step: str) -> None:
    """In rationals: the solver's own equations at H*, or x* and y*, give their derivatives exactly."""
    problem = pose(replace(load(name), track=frozenset()), rung(step))
    assert residual(problem, problem.form.equations) == 0


# What is broken is found.


def gyroscopic_sign(n: Named) -> dict[str, Any]:
    """H' = K H x H + M."""
    H, K = n.vector("H"), n.symmetric("K")
    return dict(euler_equations(n)) | labelled("H", add(cross(apply(K, H), H), n.vector("M")))


def no_gyroscopic_term(n: Named) -> dict[str, Any]:
    return dict(euler_equations(n)) | labelled("H", n.vector("M"))


def diagonal_tensor(n: Named) -> dict[str, Any]:
    return dict(
        euler_equations(Named({k: v for k, v in n.items() if k not in ("K12", "K13", "K23")}))
    )


def no_munk_couple(n: Named) -> dict[str, Any]:
    """y' = y x Omega + L, without x x U."""
    x, y = n.vector("x"), n.vector("y")
    _, Omega = velocities(x, y, n.symmetric("A"), n.matrix("B"), n.symmetric("C"))
    return dict(kirchhoff_equations(n)) | labelled("y", add(cross(y, Omega), n.vector("L")))


def transposed_coupling(n: Named) -> dict[str, Any]:
    """The row of B taken for the index of y."""
    swapped = {f"B{i}{j}": n[f"B{j}{i}"] for i in (1, 2, 3) for j in (1, 2, 3)}
    return dict(kirchhoff_equations(Named({**n, **swapped})))


BROKEN = [
    *((EULER, f) for f in (gyroscopic_sign, no_gyroscopic_term, diagonal_tensor)),
    *((KIRCHHOFF, f) for f in (no_munk_couple, transposed_coupling)),
]


@dataclass(frozen=True)
class Twin(Solver):
    """The Taylor driver with other equations under the same loads."""

    free: Equations
    name: str = "twin"
    setting: str = ""

    def solve(self, problem: Problem) -> Trajectory:
        waves = len(motion_of(problem.given).waves)
        inverse = mechanics(problem.given.body).inverse
        return Taylor().solve(problem.with_equations(Loaded(self.free, waves, inverse)))


@pytest.mark.parametrize(("name", "broken"), BROKEN)
def test_a_broken_equation_under_the_right_loads_fails(name: str, broken: Equations) -> None:
    """The state gate finds it; the same solver with the right equations passes."""
    right = euler_equations if name == EULER else kirchhoff_equations
    assert run(name, Twin(right), "f64", causes=False).verdicts[1].verdict is Status.PASS
    assert run(name, Twin(broken), "f64", causes=False).verdicts[1].verdict is Status.FAIL


def test_a_broken_product_is_not_undone_by_the_loads(monkeypatch: pytest.MonkeyPatch) -> None:
    """The loads share no cross product with the equations: with the sign of it turned, much is left."""
    problem = pose(bare(EULER), rung("f64"))
    monkeypatch.setattr(euler, "cross", lambda a, b: [-c for c in cross(a, b)])
    assert residual(problem, problem.form.equations) > Fraction(1, 100)


@pytest.mark.parametrize("name", [EULER, KIRCHHOFF])
def test_a_late_answer_fails_and_is_said_to_be_late(name: str) -> None:
    """The exact motion at t - 10^-6 is told from the motion at t, by its shift of time."""
    late = Fraction(1, 10**6)

    def answer(problem: Problem) -> Any:
        given = problem.given
        motion = solution(given).motion([t - late for t in given.clock.elapsed], 25)
        return vectors(motion.quantities)

    verdict = run(name, Callback(answer), "f64", causes=False).verdicts[1]
    assert verdict.verdict is Status.FAIL
    assert abs(verdict.time_shift - float(late)) <= 1e-3 * float(late)


# Scenes, and who is not made for them.


@pytest.mark.parametrize("step", LADDER)
def test_a_motion_that_stands_still_is_answered(step: str) -> None:
    """A constant omega under the moment that holds it there: no wave, and the rest as ever."""
    text = library.find(EULER).read_text()
    lines = [line for line in text.splitlines() if "frequency = 1" not in line]
    scene = read("\n".join(lines), "still")
    assert motion_of(scene).waves == ()
    assert run(scene, "taylor", step).verdicts[1].verdict is Status.PASS


@pytest.mark.parametrize("solver", ["outside:cvode-bdf", "geometric:lie-rk4?step=0.1"])
def test_who_is_not_told_of_the_loads_is_not_asked(solver: str) -> None:
    """A solver that would answer for another problem is unavailable, and not wrong."""
    assert run(EULER, solver_named(solver), "f64").verdicts[0].verdict is Status.UNAVAILABLE
