"""heyoka driven safely: exact numbers in and out, no silent wrong answer, no unfinished score."""

import math
import pickle
import signal
import subprocess
import sys
import time
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from builders.processes import PATIENCE, interruptible
from builders.scenes import sampled
from builders.written_loads import euler
from hypothesis import given
from hypothesis import strategies as st
from mpmath import mp

from taylor_verify.exact.route import solution
from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import power_of_two, rung
from taylor_verify.records.precisions import LADDER
from taylor_verify.records.status import Status
from taylor_verify.run import run
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.instants import EquallySpaced
from taylor_verify.scenes.motion import Clock, Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.callback import Callback
from taylor_verify.solvers.taylor import driver, way
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.solvers.taylor.numbers import arithmetic
from taylor_verify.solvers.taylor.way import LEAST_STEPS, longest_step
from taylor_verify.solvers.trajectory import Outcome, Trajectory

RUNGS = (*LADDER, "mp24", "mp100", "mp1000")


@pytest.mark.parametrize("name", RUNGS)
@given(
    significand=st.integers(-(2**1000), 2**1000),
    exponent=st.integers(-90, 90),
)
def test_numbers_pass_to_heyoka_and_back_unchanged(
    name: str, significand: int, exponent: int
) -> None:
    """Rounding once onto a rung is the only rounding: the typed number is that number exactly."""
    step = rung(name)
    size = max(significand.bit_length(), 1)
    value = step.round(significand * power_of_two(exponent - size))
    numbers = arithmetic(step)
    assert numbers.exact(numbers.number(value)) == value


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("f32", Fraction(1, 2**149)),
        ("f64", Fraction(1, 2**1074)),
        ("f80", Fraction(1, 2**16445)),
        ("f128", Fraction(3, 2**16494)),
        ("mp237", Fraction(3, 2**40000)),
        ("f128", Fraction(2) ** 16383),
        ("mp64", Fraction(2) ** 40000),
    ],
)
def test_ends_of_the_range_pass_unchanged(name: str, value: Fraction) -> None:
    """Subnormal and very large numbers of every format survive the passage."""
    numbers = arithmetic(rung(name))
    assert numbers.exact(numbers.number(rung(name).round(value))) == value


@given(st.fractions())
def test_rounding_to_f64_is_pythons(value: Fraction) -> None:
    """Our rounding onto f64 is the correctly rounded division of two integers."""
    assert rung("f64").round(value) == Fraction(value.numerator / value.denominator)


@given(st.fractions(min_value=-(2**100), max_value=2**100))
def test_rounding_to_f32_is_numpys(value: Fraction) -> None:
    """A double is rounded onto f32 as NumPy rounds it, ties and subnormals included."""
    double = value.numerator / value.denominator
    assert rung("f32").round(Fraction(double)) == Fraction(float(np.float32(double)))


def test_rounding_beyond_the_range_is_an_error() -> None:
    """The largest float32 is (2 - 2^-23) 2^127; half a unit above it there is no such number."""
    largest = (2 - Fraction(1, 2**23)) * 2**127
    assert rung("f32").round(largest) == largest
    with pytest.raises(OverflowError, match="outside the range of f32"):
        rung("f32").round(largest + 2**103)


def spinning(omega: tuple[Fraction, ...], end: Fraction) -> Scene:
    """A free body of moments 1, 2, 3, sampled eleven times."""
    moments = (Fraction(1), Fraction(2), Fraction(3))
    clock = Clock(Fraction(0), tuple(end * k / 10 for k in range(11)))
    body = RigidBody(tensors.diagonal(moments))
    return Scene("spinning", "", "euler", frozenset(), body, Spin(omega), clock)


def assert_alike(one: Trajectory, other: Trajectory) -> None:
    """The same states to the last bit, in as many steps."""
    assert one.outcome is other.outcome is Outcome.FINISHED
    assert one.steps == other.steps
    assert one.quantities.keys() == other.quantities.keys()
    for quantity, rows in one.quantities.items():
        assert np.array_equal(rows, other.quantities[quantity])


def largest_error(problem: Problem) -> float:
    """The largest relative error of omega against the exact solution."""
    digits = 20 + problem.rung.bits // 3
    answer = Taylor().solve(problem).motion(1000)
    truth = solution(problem.given).motion(problem.given.clock.elapsed, digits)
    with mp.workdps(digits):
        scale = max(mp.norm(list(row)) for row in truth["omega"])
        errors = [
            mp.norm(list(a - b)) / scale
            for a, b in zip(answer["omega"], truth["omega"], strict=True)
        ]
        return float(max(errors))


@pytest.mark.parametrize("exponent", [-150, -16, -8, 8, 150])
def test_scale_of_the_scene_does_not_matter(exponent: int) -> None:
    """A rotation at 10^-150 or 10^150 rad/s is as accurate as one at 1 (trap T2: one step, no error).

    Thirteen periods leave some hundred roundings; a thousand units of roundoff is far below the
    error of one (heyoka by itself answers this with outcome "success" and error 10^11).
    """
    size = Fraction(10) ** exponent
    omega = tuple(size * Fraction(v) for v in (0.75, -0.5, 0.875))
    problem = pose(spinning(omega, 100 / size), rung("f64"))
    assert largest_error(problem) <= 1000 * 2.0**-53


@pytest.mark.parametrize("name", ["f64", "f80", "f128", "mp237"])
@pytest.mark.parametrize("digits", [4, 8, 16, 20, 40])
def test_start_near_the_unstable_axis_keeps_its_first_flip(digits: int, name: str) -> None:
    """omega = (10^-d, 1, 0) is right at its first flip (trap T3: heyoka alone is wrong by 4e-8 to 1).

    In principal axes the rounding of each component is relative to itself, so nothing is lost but the
    roundings of the steps: thirty units leave room for those of some two hundred steps.
    """
    growth = math.sqrt(1 / 3)
    flip = Fraction(digits * math.log(10) / growth).limit_denominator(1000)
    scene = spinning((Fraction(1, 10**digits), Fraction(1), Fraction(0)), flip)
    problem = pose(scene, rung(name))
    assert largest_error(problem) <= 30 * float(problem.rung.unit_roundoff)


@pytest.mark.parametrize("bits", [24, 53, 64, 107, 113, 237, 1000])
def test_the_longest_step_of_an_order_loses_nothing_small(bits: int) -> None:
    """A step leaves out a thousandth of a rounding of a component that has the fastest rate.

    The rest of the series of exp(i h) and of exp(h), beside the whole, is below h^(p+1)/(p+1)! times
    1/(1 - h/(p+2)); p is the order that heyoka takes for so many bits.
    """
    order = math.ceil(bits * math.log(2) / 2 + 1)
    h = longest_step(order)
    with mp.workdps(30):
        rest = mp.mpf(h) ** (order + 1) / mp.factorial(order + 1) / (1 - mp.mpf(h) / (order + 2))
        assert rest <= mp.mpf(2) ** -bits / 1000


def test_run_that_leaves_the_range_is_not_scored() -> None:
    """A moment that spins a float32 body beyond 10^38 ends non-finite or refused, never with a score."""
    scene = spinning((Fraction(1), Fraction(1), Fraction(1)), Fraction(10) ** 60)
    pushed = replace(
        scene, body=replace(scene.body, moment=(Fraction(1), Fraction(0), Fraction(0)))
    )
    (verdict,) = run(pushed, "taylor", "f32").verdicts
    assert verdict.verdict in (Status.FAIL, Status.REFUSED)
    assert verdict.max is None


BEGUN = [o for o in Outcome if o is not Outcome.FINISHED and not o.is_unavailable]


@pytest.mark.parametrize("outcome", BEGUN)
def test_unfinished_run_fails_without_a_number(
    outcome: Outcome, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever stopped a solver, the verdict is fail with the outcome's sentence, and no error is 0."""
    ran = way.Ran(outcome, np.empty((0, 3)), 1.0, 7, 0.0)
    monkeypatch.setattr(way.Way, "run", lambda *_: ran)
    (verdict,) = run("euler/generic", "taylor", "f64").verdicts
    assert verdict.verdict is Status.FAIL
    assert verdict.outcome == outcome.value
    assert (verdict.max, verdict.mean, verdict.final, verdict.ratio) == (None,) * 4


def test_step_limit_is_an_outcome(monkeypatch: pytest.MonkeyPatch) -> None:
    """A run that needs more steps than it is allowed stops and says so."""
    monkeypatch.setattr(way, "STEPS_PER_RADIAN", 0)
    long = spinning((Fraction(3, 4), Fraction(-1, 2), Fraction(7, 8)), Fraction(10**6))
    assert Taylor().solve(pose(long, rung("f64"))).outcome is Outcome.STEP_LIMIT


@pytest.mark.parametrize(
    "value",
    [0.1, 3, np.float32(0.1), np.longdouble(1) / 3, np.int64(-7), mp.mpf("0.3"), Fraction(5, 8)],
)
def test_callback_numbers_are_taken_exactly(value: object) -> None:
    """Whatever number type a callable answers in, the judge sees that number and no other."""
    problem = pose(load("euler/generic"), rung("f64"))
    states = np.full((101, 3), value, dtype=object)
    number = Callback(lambda _: states).solve(problem).quantities["omega"][50, 1]
    exact = int(value) if isinstance(value, np.integer) else value
    assert Fraction(*number.as_integer_ratio()) == Fraction(*exact.as_integer_ratio())


@pytest.mark.parametrize("value", ["1.5", None, 1j, True])
def test_callback_answer_that_is_no_number_is_misshapen(value: object) -> None:
    """Text, None, complex numbers and booleans are refused with what was got."""
    states = np.full((101, 3), value, dtype=object)
    (verdict,) = run("euler/generic", Callback(lambda _: states), "f64").verdicts
    assert verdict.verdict is Status.FAIL
    assert "expected real numbers, got" in verdict.because


def test_what_would_take_days_is_not_begun() -> None:
    """1e60 turns are more than can be stepped through: the outcome is the bound on steps, at once."""
    generic = load("euler/generic")
    whirling = replace(generic, initial=Spin((Fraction(10**60), Fraction(10**59), Fraction(1))))
    trajectory = Taylor().solve(pose(whirling, rung("f64")))
    assert trajectory.outcome is Outcome.STEP_LIMIT
    assert trajectory.steps == 0


# As much work as the scene asks for, and no more.


@pytest.mark.parametrize("name", ["euler/generic", "kirchhoff/whole-motion"])
def test_samples_cost_no_steps(name: str) -> None:
    """25 samples and 1201 take the same steps, to the bit; a step that ended at each made as many."""
    few, many = (
        Taylor().solve(pose(sampled(load(name), n), rung("f64"))) for n in (25, 24 * 50 + 1)
    )
    assert few.steps == many.steps
    for quantity, rows in few.quantities.items():
        assert np.array_equal(rows[-1], many.quantities[quantity][-1])


@pytest.mark.parametrize("name", ["f80", "f128", "mp113"])
def test_unoptimised_code_takes_the_same_steps(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The compilation of loops changes their cost, and not a bit of what they compute."""
    problem = pose(load("euler/with-attitude"), rung(name))
    runs = []
    for is_optimised in (True, False):
        monkeypatch.setattr(driver, "pays", lambda *_, answer=is_optimised: answer)
        runs.append(Taylor().solve(problem))
    assert_alike(*runs)


def test_optimised_code_passes_the_same_gates() -> None:
    """It rounds otherwise, since it fuses products with sums, and is as good."""
    names = ("taylor", "taylor?code=optimised")
    plain, optimised = (run("euler/with-attitude", name) for name in names)
    assert [v.verdict for v in optimised.verdicts] == [v.verdict for v in plain.verdicts]
    assert [v.max for v in optimised.verdicts] != [v.max for v in plain.verdicts]


@pytest.mark.parametrize("name", ["f64", "f128"])
@pytest.mark.parametrize("scene", ["euler/tennis-racket", "kirchhoff/whole-motion"])
def test_a_question_that_is_asked_again_has_the_same_answer(scene: str, name: str) -> None:
    """The answer is the same to the last bit, in as many steps, whatever ran before it."""
    problem, solver = pose(load(scene), rung(name)), Taylor()
    first, again = solver.solve(problem), solver.solve(problem)
    assert_alike(first, again)
    solver.solve(pose(load("euler/about-max-axis"), rung(name)))
    assert_alike(first, solver.solve(problem))


def test_two_bodies_of_one_form_share_one_compiled_integrator() -> None:
    """Coefficients are parameters: another body, start and span compile nothing."""
    scene = spinning((Fraction(1), Fraction(3, 4), Fraction(2)), Fraction(10))
    moments = tensors.diagonal((Fraction(1), Fraction(2), Fraction(17, 5)))
    other = replace(scene, body=RigidBody(moments), initial=Spin((Fraction(2),) * 3))
    problems = [pose(asked, rung("f64")) for asked in (scene, other)]
    assert problems[0].form == problems[1].form
    assert problems[0].parameters != problems[1].parameters
    Taylor().solve(problems[0])
    before = driver.compiled.cache_info()
    Taylor().solve(problems[1])
    after = driver.compiled.cache_info()
    assert (after.misses, after.hits) == (before.misses, before.hits + 1)


def test_equally_spaced_instants_are_a_sequence_of_rationals() -> None:
    """They compare, hash, slice, count from the end and travel like the tuple of the same numbers."""
    spaced = EquallySpaced(Fraction(1, 3), Fraction(-2, 7), 5)
    plain = tuple(Fraction(1, 3) - Fraction(2, 7) * k for k in range(5))
    assert (spaced == plain, plain == spaced, hash(spaced) == hash(plain)) == (True,) * 3
    assert spaced != plain[:4]
    assert [spaced[k] for k in (-5, -1, 0, 4)] == [plain[k] for k in (-5, -1, 0, 4)]
    assert spaced[1:4] == plain[1:4]
    with pytest.raises(IndexError):
        spaced[5]
    assert pickle.loads(pickle.dumps(spaced)) == plain


@pytest.mark.parametrize("name", ["f64", "f80"])
def test_a_callback_changes_no_number(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    """It is there to hear an interrupt: heyoka takes the same steps with it, bit for bit."""
    problem = pose(load("kirchhoff/whole-motion"), rung(name))
    without = Taylor().solve(problem)
    monkeypatch.setattr(way, "_RADIANS_AT_ONCE", {})
    assert_alike(without, Taylor().solve(problem))


def test_a_motion_that_becomes_infinite_ends_on_a_wide_rung() -> None:
    """A run whose steps no longer change the time is over: no number of MPFR overflows."""
    trajectory = Taylor().solve(pose(euler(["3*w1^2", "0", "0"], "10"), rung("mp64")))
    assert trajectory.outcome is Outcome.NON_FINITE
    assert trajectory.steps < LEAST_STEPS


def test_an_interrupt_is_heard_in_the_middle_of_a_long_run() -> None:
    """A stretch of minutes, to one far sample, ends with KeyboardInterrupt where it is."""
    program = (
        "import sys\n"
        "from dataclasses import replace\n"
        "from fractions import Fraction\n"
        "from taylor_verify.models.problem import pose\n"
        "from taylor_verify.scenes.motion import Clock\n"
        "from taylor_verify.numbers.precision import rung\n"
        "from taylor_verify.scenes.reading.reader import load\n"
        "from taylor_verify.solvers.taylor.driver import Taylor\n"
        "clock = Clock(Fraction(0), (Fraction(10**9),))\n"
        "problem = pose(replace(load('euler/generic'), clock=clock), rung('f64'))\n"
        "print('posed', flush=True)\n"
        "Taylor().solve(problem)\n"
    )
    with interruptible():
        running = subprocess.Popen(
            [sys.executable, "-c", program],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
    with running:
        assert running.stdout.readline() == "posed\n"
        time.sleep(1.5)
        running.send_signal(signal.SIGINT)
        try:
            _, error = running.communicate(timeout=PATIENCE)
        finally:
            running.kill()
    assert running.returncode != 0
    assert error.rstrip().endswith("KeyboardInterrupt")


def test_a_long_path_costs_the_impulses_nothing() -> None:
    """heyoka's tolerance is a part of the largest state: the centre, far off, would be that state."""
    start = load("kirchhoff/whole-motion")
    clock = Clock(Fraction(0), tuple(map(Fraction, (1, 10, 100, 2000))))
    far = replace(start.initial, centre=(Fraction(10**9), Fraction(0), Fraction(0)))
    for scene in (replace(start, clock=clock), replace(start, initial=far)):
        verdicts = run(scene, "taylor", "f64").verdicts
        assert {verdict.quantity for verdict in verdicts} >= {"impulse", "centre", "T", "F2", "FG"}
        assert all(verdict.verdict is Status.PASS for verdict in verdicts), verdicts


def test_few_samples_are_solved_with_as_much_care_as_many() -> None:
    """The cap on the step is renewed between two samples that are far apart, and the sample is met."""
    scene = load("euler/tennis-racket")
    last = scene.clock.instants[-1]
    few = run(replace(scene, clock=Clock(scene.clock.start, (last,))), "taylor", "f64")
    many = run(scene, "taylor", "f64")
    assert all(verdict.verdict is Status.PASS for verdict in few.verdicts)
    assert few.verdicts[0].steps <= many.verdicts[0].steps * 1.1
