"""Solvers on scenes with states of their own: wheels, lags, and values that are held between instants."""

from __future__ import annotations

from fractions import Fraction
from functools import partial
from typing import Any

import numpy as np
import pytest
from builders.integrators import step
from builders.scenes import scene_text
from mpmath import mp, mpf

from taylor_verify.models.frame import rotation
from taylor_verify.models.problem import Problem, pose
from taylor_verify.models.registry import natural_units
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.reading.reader import read
from taylor_verify.solvers.callback import Callback
from taylor_verify.solvers.registry import solver_named
from taylor_verify.solvers.solver import columns
from taylor_verify.solvers.trajectory import Outcome

WHEELS = scene_text(
    "inertia = [[1.2, 0.1, 0], [0.1, 0.9, 0], [0, 0, 1.6]]\nrotor = ROTOR",
    "omega = [0.3, -0.5, 0.4]\nattitude = [0.5, 0.6, -0.4, 0.45]",
    "[states]\nh = { start = [0.1, 0, -0.05], rate = RATE }",
    'start = "1/2"\nend = END\nsamples = 8',
    'track = ["attitude", "h"]',
)
# About one axis w' = m, so that all values are rational at rational times.
HELD = """[states]
m = { every = "1/4", value = "LAW" }
d = { every = "1/4", offset = "1/8", start = "1/16", value = "m" }
n = { every = "1/2", offset = "1/2", start = 0, value = "n + 1" }"""
SAMPLED = scene_text(
    'inertia = [1, 1, 1]\nmoment = ["d", 0, 0]',
    *('omega = ["3/2", 0, 0]', HELD, "end = 2\nsamples = 17", 'track = ["m", "d", "n"]'),
)
LAWS = {
    "-w1/2": lambda w, m: -w / 2,
    "-sign(w1 - 1/2)/4": lambda w, m: -Fraction((w > Fraction(1, 2)) - (w < Fraction(1, 2)), 4),
    "1/2 if w1 < 1 else -floor(4*w1)/8": lambda w, m: (
        Fraction(1, 2) if w < 1 else -Fraction(w * 4 // 1, 8)
    ),
    "clip(-w1, -1/4, 1/4)*step(w1)": lambda w, m: max(-w, -Fraction(1, 4)) * (w >= 0),
    "-w1/4 if w1 > -9 else log(-w1)": lambda w, m: -w / 4,
}
SOLVERS = ("taylor", "scipy:DOP853?rtol=1e-12&atol=1e-13", "mpmath:odefun")


def wheels(
    rotor: str = '["h1", "h2", "h3"]',
    rate: str = '["0.8*q1 + w1/2", "0.8*q2 + w2/2", "0.8*q3 + w3/2"]',
    end: str = "7.5",
    name: str = "f64",
) -> Problem:
    text = WHEELS.replace("ROTOR", rotor).replace("RATE", rate).replace("END", end)
    return pose(read(text, "wheels"), rung(name))


def solved(problem: Problem, solver: str = "taylor") -> dict[str, Any]:
    answered = solver_named(solver).solve(problem)
    assert answered.outcome is Outcome.FINISHED, answered.detail
    return dict(answered.quantities)


def in_space(problem: Problem, quantities: dict[str, Any], turning: Any) -> Any:
    """The momentum of body and wheels in space axes, a row for each sample."""
    inertia = [
        [mpf(v.numerator) / v.denominator for v in row] for row in problem.given.body.inertia
    ]
    rows = []
    for omega, q, h in zip(quantities["omega"], quantities["quaternion"], turning, strict=True):
        H = [sum(a * w for a, w in zip(row, omega, strict=True)) + e
             for row, e in zip(inertia, h, strict=True)]  # fmt: skip
        size = sum(e * e for e in q)
        rows.append(
            [sum(a * b for a, b in zip(r, H, strict=True)) / size for r in rotation(list(q))]
        )
    return rows


@pytest.mark.parametrize("name", ["f32", "f64", "mp237"])
@pytest.mark.parametrize("end", ["7.5", "-3"])
def test_motors_leave_the_momentum_in_space_alone(end: str, name: str) -> None:
    """Motors take from the body what they give to the wheels, forwards and backwards in time."""
    problem = wheels(end=end, name=name)
    quantities = solved(problem)
    with mp.workprec(300):
        rows = in_space(problem, quantities, quantities["h"])
        drift = max(abs(a - b) for row in rows for a, b in zip(row, rows[0], strict=True))
        assert drift < 100 * mpf(2) ** -rung(name).bits
        assert (
            max(abs(a - b) for a, b in zip(quantities["h"][-1], quantities["h"][0], strict=True))
            > 0.1
        )


def test_a_rotor_may_be_any_text_in_time_and_states() -> None:
    """Its change acts on the body by itself, also across a kink and with the time in it."""
    problem = wheels('["clip(h1, -0.2, 0.3)", "tanh(h2) + sin(t)/8", "0.2*h3*h1"]')
    quantities = solved(problem)
    times = [float(t) for t in problem.given.clock.instants]
    with mp.workprec(120):
        h = [
            [min(max(a, mpf(-0.2)), mpf(0.3)), mp.tanh(b) + mp.sin(t) / 8, mpf(0.2) * c * a]
            for (a, b, c), t in zip(quantities["h"], times, strict=True)
        ]
        rows = in_space(problem, quantities, h)
        assert max(abs(a - b) for row in rows for a, b in zip(row, rows[0], strict=True)) < 1e-13


def test_the_unit_of_time_is_the_same_in_every_unit_of_mass() -> None:
    """Wheels a thousand times as heavy turn a body as fast that is a thousand times as heavy."""
    units = []
    for m in (1, 1024):
        text = WHEELS.replace("[[1.2, 0.1, 0], [0.1, 0.9, 0], [0, 0, 1.6]]", f"[{m}, {m}, {m}]")
        text = text.replace("[0.1, 0, -0.05]", f"[{8 * m}, 0, 0]").replace("END", "2")
        text = text.replace("ROTOR", '["h1", 0, 0]').replace("RATE", "[0, 0, 0]")
        units.append(natural_units(read(text, "wheels")))
    assert units[0].time == units[1].time
    assert units[1].momentum == 1024 * units[0].momentum


@pytest.mark.parametrize("solver", SOLVERS[1:])
def test_solvers_agree_on_wheels(solver: str) -> None:
    first, second = solved(wheels()), solved(wheels(), solver)
    assert max(float(np.abs(first[q] - second[q]).max()) for q in first) < 1e-9


def test_a_lag_is_an_exponential() -> None:
    """h' = (1/3 - h)/2 in each solver, in a unit of its own: it is a billion times the momentum."""
    rate = '["(1e9/3 - h1)/2", "-h2/5", 0]'
    for solver in SOLVERS:
        h = solved(wheels("[0, 0, 0.1]", rate), solver)["h"][-1]
        exact = 1e9 / 3 + (0.1 - 1e9 / 3) * np.exp(-3.5)
        assert abs(float(h[0]) / exact - 1) < 1e-10
        assert float(h[2]) == -0.05


# Held values.


def sampled(law: str) -> Problem:
    return pose(read(SAMPLED.replace("LAW", law), "sampled"), rung("f64"))


def by_recurrence(law: Any) -> dict[str, list[Fraction]]:
    """Omega, the value, the delayed value and the count at each eighth of a time, exactly."""
    w, m, d, n = Fraction(3, 2), Fraction(0), Fraction(1, 16), Fraction(0)
    rows: dict[str, list[Fraction]] = {"w": [], "m": [], "d": [], "n": []}
    for k in range(17):
        before = w, m, n
        m = law(w, m) if k % 2 == 0 else m
        d = before[1] if k % 2 else d
        n = n + 1 if k and k % 4 == 0 else n
        for name, value in zip(rows, (w, m, d, n), strict=True):
            rows[name].append(value)
        w += d / 8
    return rows


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("law", LAWS)
def test_held_values_are_those_of_the_law(law: str, solver: str) -> None:
    """With jumps by the state, a delay of half a sample, and a count of its own instants."""
    quantities, exact = solved(sampled(law), solver), by_recurrence(LAWS[law])
    for name, place in {"w": "omega", "m": "m", "d": "d", "n": "n"}.items():
        got = [float(row[0]) for row in quantities[place]]
        np.testing.assert_allclose(got, [float(v) for v in exact[name]], rtol=1e-10, atol=1e-10)


def test_without_stops_all_instants_count_and_digits_are_lost() -> None:
    """A value is taken from the state of a later evaluation, which no tolerance makes the right one."""
    exact = by_recurrence(LAWS["-w1/2"])
    for tolerance in ("1e-4", "1e-7", "1e-10"):
        errors = []
        for stop in ("yes", "no"):
            name = f"scipy:DOP853?rtol={tolerance}&atol={tolerance}&stop={stop}"
            answer = solved(sampled("-w1/2"), name)
            assert [row[0] for row in answer["n"]] == exact["n"]
            pairs = zip(answer["omega"], exact["w"], strict=True)
            errors.append(max(abs(float(row[0] - w)) for row, w in pairs))
        assert errors[1] > 1e4 * errors[0]


@pytest.mark.parametrize("name", ["f64", "mp237"])
def test_a_value_on_a_switch_is_that_behind_it(name: str) -> None:
    """An instant that is no double is not taken for one before the switch."""
    text = SAMPLED.replace('"1/4", value = "LAW"', '"1/3", value = "1 if t < 1/3 else 2"')
    problem = pose(read(text, "sampled"), rung(name))
    (switch,) = problem.switches
    after = problem.taken(problem.instants.index(switch), [1.5, 0, 0], [0, 0, 0])
    np.testing.assert_array_equal(after, [2, 0, 0])


def by_hand(problem: Problem) -> np.ndarray[Any, Any]:
    """All columns by the classical method, from each instant and each sample to the next."""
    start = float(problem.given.clock.start)

    def rates(held: Any, t: float, y: Any) -> Any:
        return np.concatenate(
            [problem.loads(start + t, y, held), problem.rates(start + t, y, held)]
        )

    instants, times = problem.instants, problem.given.clock.elapsed
    y, held = np.array([1.5, 0, 0]), np.array([0, 1 / 16, 0])
    rows, now, taken = [], Fraction(0), 0
    for stop in sorted({*times, *instants}):
        y = step(partial(rates, held), float(now), y, float(stop - now))
        now = stop
        if now in instants:
            held, taken = problem.taken(taken, y, held), taken + 1
        if now in times:
            rows.append([*y, *held])
    return np.array(rows)


def test_a_solver_of_ones_own_takes_the_values() -> None:
    """The columns of its answer are omega, then the tracked states."""
    problem = sampled("-w1/2")
    assert columns(problem) == [("omega", 3), ("m", 1), ("d", 1), ("n", 1)]
    answered = Callback(by_hand).solve(problem)
    assert answered.outcome is Outcome.FINISHED, answered.detail
    exact = by_recurrence(LAWS["-w1/2"])
    for place, name in (("omega", "w"), ("m", "m"), ("n", "n")):
        got = [float(row[0]) for row in answered.quantities[place]]
        np.testing.assert_allclose(got, [float(v) for v in exact[name]], atol=1e-14)


@pytest.mark.parametrize("name", ["rates", "loads"])
def test_arrays_of_states_have_the_same_values_as_single_ones(name: str) -> None:
    problem = wheels(rate='["h2*w1 + t", "-h1", "q1*abs(h3)"]')
    random = np.random.default_rng(3)
    states, times = random.uniform(-1, 1, (9, 10)), np.linspace(0.5, 3, 9)
    answer = getattr(problem, name)
    single = [answer(t, row) for t, row in zip(times, states, strict=True)]
    np.testing.assert_allclose(answer(times, states), single, rtol=1e-14)


def test_the_rotor_is_that_of_its_text() -> None:
    """In body axes, of the time and the scene's own states; it reads no more of the state."""
    problem = wheels('["clip(h1, -0.2, 0.3)", "h2 + t/8", "h3*h1"]')
    state = [0.3, -0.5, 0.4, 1, 0, 0, 0, 0.5, 0.25, -2]
    np.testing.assert_array_equal(problem.rotor(2, state), [0.3, 0.5, -1])


def test_held_values_are_asked_for() -> None:
    """A load that reads them has no value without them."""
    with pytest.raises(ValueError, match="expected the held values d, got none"):
        sampled("-w1/2").loads(0, [1, 0, 0])
    assert list(sampled("-w1/2").loads(0, [1, 0, 0], [0, 0.25, 0])) == [0.25, 0, 0]


def test_a_kink_of_held_values_alone_is_chosen_at_each_instant() -> None:
    """No crossing of it can come on the way: |d| pushes forwards whatever d is."""
    problem = pose(
        read(SAMPLED.replace("LAW", "-w1").replace('"d", 0', '"abs(d)", 0'), "a"), rung("f64")
    )
    quantities = solved(problem)
    d = [abs(float(row[0])) for row in quantities["d"]]
    omega = np.cumsum([1.5, *(np.array(d[:-1]) / 8)])
    np.testing.assert_allclose([float(w[0]) for w in quantities["omega"]], omega, rtol=1e-13)


@pytest.mark.parametrize("length", ["norm(d, 1/3)", "sqrt(d^2 + 1/9)", "norm(d, m, w1 - w1)"])
def test_a_length_of_held_values_does_not_change(length: str) -> None:
    """Between two instants it is a number, which does not vanish."""
    text = SAMPLED.replace("LAW", "-w1/2 - 1/9").replace('"d", 0', f'"-{length}", 0')
    quantities = solved(pose(read(text, "a"), rung("f64")))
    d, m = ([float(row[0]) for row in quantities[name]] for name in "dm")
    other = m if ", m" in length else [1 / 3] * len(d)
    omega = np.cumsum([1.5, *(-np.hypot(d[:-1], other[:-1]) / 8)])
    np.testing.assert_allclose([float(w[0]) for w in quantities["omega"]], omega, rtol=1e-13)


def test_a_value_that_there_is_not_ends_the_run() -> None:
    """The law takes the logarithm of a negative number at the start."""
    answered = solver_named("taylor").solve(sampled("log(-w1)"))
    assert answered.outcome is Outcome.RAISED
    assert not answered.quantities
