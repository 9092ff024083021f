"""Solvers under loads that a scene writes down, against the enclosure of the same rounded data."""

from __future__ import annotations

import pickle
from collections.abc import Mapping
from fractions import Fraction
from itertools import product

import numpy as np
import pytest
from builders.integrators import step
from builders.scenes import read_scene
from builders.turns import by_turns
from builders.written_loads import euler, kirchhoff
from mpmath import mp, mpf

from taylor_verify.exact.route import solution
from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.callback import Callback
from taylor_verify.solvers.engines.engine import Outside
from taylor_verify.solvers.process.protocol import question
from taylor_verify.solvers.registry import solver_named, solver_names
from taylor_verify.solvers.trajectory import Outcome, Trajectory

SPACE = """
[define]
n = "1/2"
v = "norm(u1, u2, u3)"
r = "norm(c1, c2, c3)"
[space]
o = ["cos(n*t)", "sin(n*t)", 0]
d = ["c1", "c2", "c3"]
[tables]
p = { times = [0, "1/2", "5/4", 2], values = [0, 0.3, 0.1, -0.4], kind = "cubic" }
"""
# r and v need the names of a solid in a fluid.
TURNING = SPACE.replace('v = "norm(u1, u2, u3)"', "").replace('r = "norm(c1, c2, c3)"', "")
TURNING = TURNING.replace('d = ["c1", "c2", "c3"]', "")
SMOOTH: Mapping[str, Scene] = {
    "sine": euler(("0.1*sin(2*t)", "-w2/20", "(w1 - w3)/30"), "9/4"),
    "gradient": euler(("3*n^2*o2*o3*I33", "-3*n^2*o3*o1*I22", "o1*o2/5"), "9/4", TURNING),
    "thrusters": euler(("0.3 if t < 1 else 0", "-0.2*step(t - 1/2)", "0.1"), "9/4"),
    "backwards": euler(("0.3 if t < 0 else 0.1", "-0.2*step(t + 1/2)", "q1"), "-1"),
    "roots": euler(("-sqrt(w1^2 + 1/100)*w1", "sqrt(2 + w1)/9", "-(w3 + 3)^(3/2)"), "9/4"),
    "table": euler(("p - tanh(5*w1)/9", "-atan(5*w2)/50", "p*w1^(-1/3)"), "9/4", TURNING),
    "drag": kirchhoff(("-v*u1/5", "-v*u2/5", "-v*u3/5"), ("0", "-w2/9", "0"), "9/4", SPACE),
    "orbit": kirchhoff(("-d1/r^3", "-d2/r^3", "-d3*r^(-5/2)"), ("0", "0", "y1/9"), "9/4", SPACE),
}
HUNG = """
weight = { force = [0, 0, 2], at = [0, "1/8", "1/10"] }
current = ["1/4", 0, "-1/8"]
"""
TOP = kirchhoff(("0", "x1/9", "0"), ("0", "0", "0"), "9/4", more=HUNG)
KINKED: Mapping[str, Scene] = {
    "abs": euler(("-abs(w1)*w1/5", "cos(3*t) - w2*abs(w2)", "-w3*abs(w3)"), "9/4"),
    "backwards": euler(("cos(3*t)", "abs(w1)/4", "min(w2, 0)"), "-3/4"),
    "clip": euler(
        ("clip(-5*w1, -0.2, 0.2)", "-max(w2, w3, 0)", "min(w1 + w3, w2)*max(w1, w2)"), "2"
    ),
    "at rest": euler(("-w1*abs(w1 - 1/3)", "abs(w1 - 1/3)", "cos(t)"), "2"),
}


def error(scene: Scene, solver: str, name: str) -> mpf:
    """The largest error at the last sample, relative to the size of each vector and matrix."""
    problem = pose(scene, rung(name))
    return distance(problem, solver_named(solver).solve(problem))


def distance(problem: Problem, answered: Trajectory) -> mpf:
    assert answered.outcome is Outcome.FINISHED, answered.detail
    digits = int(problem.rung.bits * 0.31) + 3
    truth = solution(problem.given).motion([problem.given.clock.elapsed[-1]], digits)
    with mp.workdps(digits + 10):
        motion = answered.motion(problem.rung.bits + 60)
        return max(
            mp.norm([a - b for a, b in zip(motion[q][-1].flat, truth[q][0].flat, strict=True)])
            / mp.norm(list(truth[q][0].flat))
            for q in motion.quantities
        )


@pytest.mark.parametrize("name", SMOOTH)
def test_taylor_loses_a_few_roundings(name: str) -> None:
    """In doubles, with switches, a table, and loads that read attitude and centre."""
    assert error(SMOOTH[name], "taylor", "f64") < 1e-14


@pytest.mark.parametrize(
    ("scene", "name"), by_turns(product(["thrusters", "orbit"], ["f32", "f80", "f128", "mp237"]))
)
def test_every_rung_has_its_own_digits(scene: str, name: str) -> None:
    """One compiled form serves all bodies: numbers are parameters of the rung's own type."""
    if missing := solver_named("taylor").unavailable(rung(name)):
        pytest.skip(missing)
    assert error(SMOOTH[scene], "taylor", name) < 50 * mpf(2) ** -rung(name).bits


def test_a_start_along_a_kink_leaves_later_crossings_seen() -> None:
    """It begins on the kink without a slope, after which heyoka's own cooldown would be endless."""
    scene = euler(("abs((t - 1/4)^2*(t - 5/4))", "0", "-w1/9"), "9/4")
    assert error(scene, "taylor", "f64") <= mpf(10) ** -13


def test_weight_and_current_act() -> None:
    """A weight hangs on the body, and the centre drifts with the fluid."""
    assert error(TOP, "taylor", "f64") < 1e-14
    assert error(TOP, "scipy:DOP853?rtol=1e-12&atol=1e-13", "f64") < 1e-10


@pytest.mark.parametrize("scene", ["sine", "thrusters", "table", "drag", "backwards"])
def test_scipy_and_odefun_go_from_switch_to_switch(scene: str) -> None:
    assert error(SMOOTH[scene], "scipy:DOP853?rtol=1e-11&atol=1e-12", "f64") < 1e-8
    if scene in ("thrusters", "backwards"):
        assert error(SMOOTH[scene], "mpmath:odefun", "f64") < 1e-13


@pytest.mark.parametrize("scene", ["sine", "gradient", "thrusters", "backwards"])
def test_a_splitting_with_kicks_has_order_two(scene: str) -> None:
    """With a full tensor, loads of time, attitude and omega, and switches that no step goes over."""
    errors = [
        error(SMOOTH[scene], f"geometric:splitting?step={h}", "f64") for h in ("1/32", "1/64")
    ]
    assert 3.8 < errors[0] / errors[1] < 4.2


LENGTHS = {
    "a root of a square": euler(("-sqrt((w1 + w2)^2)*w1", "cos(3*t)", "0"), "9/4"),
    "a root of parts": euler(("-sqrt(3*(w1 - w2)^2)/5", "-(w3^2)^(3/2)", "(w2^4)^(1/2)"), "9/4"),
}


def about_one_axis(moment: str) -> Scene:
    """A body that turns about one axis alone."""
    body = f'inertia = [2, 1, 1]\nmoment = ["{moment}", 0, 0]'
    return read_scene(body, 'omega = ["1/3", 0, 0]', time="end = 2\nsamples = 2")


def swing(moment: str) -> Problem:
    return pose(about_one_axis(moment), rung("f64"))


@pytest.mark.parametrize(
    ("scene", "name"),
    [
        *by_turns(product(KINKED, ["f64", "mp237"]), 3, lambda scene, name: scene),
        *by_turns(product(LENGTHS, ["f64", "mp237"]), 4, lambda scene, name: name),
    ],
)
def test_kinks_are_crossed_at_full_precision(scene: str, name: str) -> None:
    """Forwards and backwards, and from a start that lies on the kink. A length with one part is a kink:
    as a root its series would be wrong by 2e-8 on the other side, without any sign."""
    kinked = {**KINKED, **LENGTHS}[scene]
    assert error(kinked, "taylor", name) < 50 * mpf(2) ** -rung(name).bits


@pytest.mark.parametrize("length", ["norm(w1, w2)", "sqrt(w1^2 + w2^2/4 + w3^4)"])
def test_a_length_on_an_axis_is_a_kink(length: str) -> None:
    """Where all other parts stay zero it is the same motion as under an abs."""
    answered = solver_named("taylor").solve(swing(f"-cos(t) - {length}*w1"))
    assert distance(swing("-cos(t) - abs(w1)*w1"), answered) < 1e-14


REFUSED = {
    "a norm at rest": euler(("-norm(w1 - 1/3, w2 + 1/2)*w1", "0", "0"), "3/4"),
    "a product of squares": euler(("-sqrt(w1^2*w2^2)", "2", "0"), "9/4"),
    "a sine by its cosine": about_one_axis("sqrt(1 - cos(t - 1)^2) - 1/2"),
    "on an oblique line": about_one_axis("-cos(t) - norm(w1 - 1/20, 2*w1 - 1/10)*w1"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_a_length_that_may_vanish_is_refused(name: str) -> None:
    """Its series would be wrong on the other side, without any sign."""
    ended = solver_named("taylor").solve(pose(REFUSED[name], rung("f64")))
    assert ended.outcome is Outcome.UNSUITED
    assert not ended.quantities


# Who takes none.

TAKING = ("taylor", "scipy", "mpmath", "geometric:splitting")


@pytest.mark.parametrize(
    "name",
    sorted({n.partition("?")[0] for n in solver_names() if not n.startswith(TAKING)}),
)
def test_a_solver_that_cannot_take_written_loads_says_so(name: str) -> None:
    """It would answer for another body."""
    solver = solver_named(name + "?step=1e-2" * name.startswith("geometric"))
    problem = pose(SMOOTH["sine"], rung("f64"))
    takes = isinstance(solver, Outside) and solver.engine.script.about.loads == "written"
    expected = "" if takes else f"{solver.name} does not take loads that a scene writes down"
    if takes and solver.engine.script.about.models == ("kirchhoff",):
        expected = f"{solver.name} is made for kirchhoff alone"
    assert solver.unsuited(problem) == expected


# A solver of one's own.


def by_hand(problem: Problem) -> np.ndarray:  # type: ignore[type-arg]
    """Omega and the attitude by the classical method, from switch to switch."""
    body, initial = problem.given.body, problem.given.initial
    inertia = np.array(body.energy_matrix, dtype=float)
    start = float(problem.given.clock.start)

    def rates(t: float, y: np.ndarray) -> np.ndarray:  # type: ignore[type-arg]
        w, q = y[:3], y[3:]
        moment = problem.loads(start + t, y, piece=piece)
        turned = np.linalg.solve(inertia, np.cross(inertia @ w, w) + moment)
        product = [-q[1:] @ w, *(q[0] * w + np.cross(q[1:], w))]
        return np.concatenate([turned, np.array(product) / 2])

    q = np.array([float(e) for e in initial.attitude])
    y = np.concatenate([[float(w) for w in initial.omega], q / np.linalg.norm(q)])
    elapsed = [float(t) for t in problem.given.clock.elapsed]
    stops = sorted({*map(float, problem.switches), *elapsed})
    rows, now = [], 0.0
    for stop in (s for s in stops if 0 <= s <= elapsed[-1]):
        piece, h = sum(s < stop for s in map(float, problem.switches)), (stop - now) / 200
        for k in range(200):
            y = step(rates, now + k * h, y, h)
        now = stop
        if stop in elapsed:
            rows.append(y)
    return np.array(rows)


@pytest.mark.parametrize("name", by_turns(["gradient", "table", "thrusters", "sine"], 2))
def test_loads_and_switches_serve_a_solver_of_ones_own(name: str) -> None:
    """Its order is that of its method, as it begins anew at the switches."""
    problem = pose(SMOOTH[name], rung("f64"))
    assert distance(problem, Callback(by_hand).solve(problem)) < 1e-8


@pytest.mark.parametrize("name", ["thrusters", "drag", "orbit"])
def test_loads_take_many_times_and_states_at_once(name: str) -> None:
    """The same numbers as one by one, on both sides of the switches."""
    problem = pose(SMOOTH[name], rung("f64"))
    random = np.random.default_rng(1)
    states, times = random.uniform(0.3, 0.9, (20, 13)), np.linspace(-1, 3, 20)
    together = problem.loads(times, states)
    single = [problem.loads(t, y) for t, y in zip(times, states, strict=True)]
    np.testing.assert_allclose(together, single, rtol=1e-14, atol=1e-15)
    # The moment, or force and couple.
    assert together.shape == (20, 3 if problem.given.model == "euler" else 6)


def test_a_piece_that_there_is_not_is_refused() -> None:
    """Pieces lie between the switches, and a body without wheels has a momentum of wheels that is zero."""
    problem = pose(euler(("0.1 if t < 3/2 else 0", "0", "0"), "9/4"), rung("f64"))
    state = np.full(7, 0.5)
    assert [problem.loads(1.5, state, piece=k)[0] for k in (0, 1)] == [0.1, 0.0]
    with pytest.raises(ValueError, match="expected a piece from 0 to 1, got 2"):
        problem.loads(1.5, state, piece=2)
    with pytest.raises(ValueError, match="expected a time, got nan"):
        problem.loads(np.nan, state)
    np.testing.assert_array_equal(problem.rotor(1.5, [state, state]), np.zeros((2, 3)))


@pytest.mark.parametrize("part", [3, 5, 7, 11])
def test_times_around_a_switch_that_is_no_double_are_each_on_their_side(part: int) -> None:
    """A double just before the switch takes no later time with it into the piece before."""
    problem = pose(euler((f"step({part}*(t - 1/4) - 1)", "0", "0"), "9/4"), rung("f64"))
    assert problem.switches == [Fraction(1, part)]
    near = 1 / part + np.arange(-8, 9) * 2.0**-53
    states = np.full((len(near), 7), 0.5)
    moments = problem.loads(near + 0.25, states)
    later = [Fraction(t) - Fraction(1, 4) >= Fraction(1, part) for t in near + 0.25]
    assert 0 < sum(later) < len(later)
    np.testing.assert_array_equal(moments[:, 0], later)


def test_a_problem_that_was_asked_for_loads_can_be_pickled() -> None:
    """The code of its loads stays behind, and is made again."""
    problem, state = pose(SMOOTH["gradient"], rung("f64")), np.full(7, 0.5)
    moment = problem.loads(1, state)
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(problem)).loads(1, state), moment)


def test_loads_ask_for_what_they_read() -> None:
    """A state without the attitude is too short for a load that reads it."""
    with pytest.raises(ValueError, match="expected a state of 7 numbers, got 3"):
        pose(SMOOTH["gradient"], rung("f64")).loads(0, [1, 2, 3])


def test_the_question_has_the_steps_of_each_piece() -> None:
    """A reader of one loop computes the moment from them; each constant is a number of the rung."""
    document = question(pose(SMOOTH["thrusters"], rung("f64")))
    assert document["protocol"] == 5
    pieces = document["loads"]["pieces"]
    assert [piece["to"] for piece in pieces] == ["0.25", "0.75", None]
    moments = []
    for piece in pieces:
        values = [float.fromhex(step[2]) for step in piece["steps"] if step[0] == "number"]
        moments.append([values[k] for k in piece["moment"]])
    assert moments == [[0.3, 0.0, 0.1], [0.3, -0.2, 0.1], [0.0, -0.2, 0.1]]
    assert document["loads"]["text"]["moment"][0] == "0.3 if t < 1 else 0"


STAIRS = {end: euler(("0.1*floor(3*t)", "0", "0"), end) for end in ("9/4", "-3/4")}


@pytest.mark.parametrize(("end", "name"), by_turns(product(STAIRS, ["f64", "mp100"]), 2))
def test_a_question_of_stairs_has_all_pieces_of_its_span(end: str, name: str) -> None:
    """Each piece has an end, the first begins before the span and the last ends behind it."""
    problem = pose(STAIRS[end], rung(name))
    pieces = question(problem)["loads"]["pieces"]
    ends = [tuple(map(Fraction, (piece["from"], piece["to"]))) for piece in pieces]
    assert [end for _, end in ends[:-1]] == [begin for begin, _ in ends[1:]]
    first, last = sorted((Fraction(0), problem.given.clock.elapsed[-1]))
    assert ends[0][0] < first
    assert last < ends[-1][1]


@pytest.mark.parametrize("end", STAIRS)
def test_stairs_are_known_wherever_a_solver_looks(end: str) -> None:
    """A step may go beyond the samples on either side; the switches of a problem are those of its span."""
    problem, state = pose(STAIRS[end], rung("f64")), np.ones(7)
    first, last = sorted((Fraction(0), problem.given.clock.elapsed[-1]))
    assert problem.switches
    assert all(first <= switch <= last for switch in problem.switches)
    times = np.arange(-5, 5, 0.3) + 0.01
    moments = np.array([problem.loads(t, state)[0] for t in times])
    np.testing.assert_allclose(moments, 0.1 * np.floor(3 * times), atol=1e-15)
    problem = pose(STAIRS[end], rung("f64"))
    together = problem.loads(times, np.ones((len(times), 7)))[:, 0]
    np.testing.assert_array_equal(together, moments)
