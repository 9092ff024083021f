"""heyoka driven safely: exact numbers in and out, no silent wrong answer, no unfinished score."""

import math
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import heyoka as hy
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mpmath import mp

from verify.exact.route import solution
from verify.judge.verdict import Status
from verify.models.problem import Problem, pose
from verify.run import run
from verify.scenes import tensors
from verify.scenes.bodies import RigidBody
from verify.scenes.motion import Clock, Spin
from verify.scenes.precision import LADDER, power_of_two, rung
from verify.scenes.reader import load
from verify.scenes.scene import Scene
from verify.solvers.solver import Callback
from verify.solvers.taylor.cache import processor_key, use_own_cache
from verify.solvers.taylor.driver import Taylor
from verify.solvers.taylor.numbers import arithmetic
from verify.solvers.trajectory import Outcome

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


@pytest.mark.parametrize("name", ["f16", "mp23", "mp", "double", "mp1e3", "F64"])
def test_unknown_rung_is_an_error_that_lists_the_ladder(name: str) -> None:
    """A name that is no rung is refused with the names that are."""
    with pytest.raises(ValueError, match="f32, f64, f80, f128 or mpN"):
        rung(name)


def spinning(omega: tuple[Fraction, ...], end: Fraction, inertia: int = 3) -> Scene:
    """A free body of moments 1, 2, inertia, sampled eleven times."""
    moments = (Fraction(1), Fraction(2), Fraction(inertia))
    clock = Clock(Fraction(0), tuple(end * k / 10 for k in range(11)))
    body = RigidBody(tensors.diagonal(moments))
    return Scene("spinning", "", "euler", frozenset(), body, Spin(omega), clock)


def largest_error(problem: Problem) -> float:
    """The largest relative error of omega against the exact solution."""
    answer = Taylor().solve(problem).motion(300)
    truth = solution(problem.given).motion(problem.given.clock.elapsed, 40)
    with mp.workdps(40):
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


@pytest.mark.parametrize("digits", [4, 8, 16, 20, 40])
def test_start_near_the_unstable_axis_keeps_its_first_flip(digits: int) -> None:
    """omega = (10^-d, 1, 0) is right at its first flip (trap T3: heyoka alone is wrong by 4e-8 to 1).

    In principal axes the rounding of each component is relative to itself, so nothing is lost but the
    roundings of the steps: thirty units leave room for those of some two hundred steps.
    """
    growth = math.sqrt(1 / 3)
    flip = Fraction(digits * math.log(10) / growth).limit_denominator(1000)
    scene = spinning((Fraction(1, 10**digits), Fraction(1), Fraction(0)), flip)
    assert largest_error(pose(scene, rung("f64"))) <= 30 * 2.0**-53


def test_heyoka_alone_is_silently_wrong_there() -> None:
    """The same start without the step cap ends in success and is wrong by more than 10^-9."""
    flip = 40 * math.log(10) / math.sqrt(1 / 3)
    w = hy.make_vars("a", "b", "c")
    system = [
        (w[0], -hy.par[0] * w[1] * w[2]),
        (w[1], hy.par[1] * w[2] * w[0]),
        (w[2], -hy.par[2] * w[0] * w[1]),
    ]
    plain = hy.taylor_adaptive(system, [1e-40, 1.0, 0.0], pars=[1.0, 1.0, 1 / 3])
    outcome, *_ = plain.propagate_until(flip)
    # The inertia 1, 2, 3 leaves w1' = -w2 w3, w2' = w3 w1, w3' = -w1 w2/3.
    scene = spinning((Fraction(1, 10**40), Fraction(1), Fraction(0)), Fraction(flip))
    exact = solution(scene).motion([Fraction(flip)], 20)["omega"][0]
    error = max(abs(float(a) - b) for a, b in zip(exact, plain.state, strict=True))
    assert outcome == hy.taylor_outcome.time_limit
    assert error > 1e-9


@pytest.mark.parametrize("name", LADDER)
def test_error_falls_with_the_rung(name: str) -> None:
    """Each rung's error is some hundred of its own units of roundoff, no coarser rung's (trap T1)."""
    problem = pose(load("euler/generic"), rung(name))
    answer = Taylor().solve(problem).motion(600)
    truth = solution(problem.given).motion(problem.given.clock.elapsed, 90)
    with mp.workdps(90):
        error = max(
            mp.norm(list(a - b)) for a, b in zip(answer["omega"], truth["omega"], strict=True)
        )
        # The attainable error of this orbit is 500 units; ten times that is the gate.
        assert error <= 5000 * mp.mpf(2) ** -problem.rung.bits


def test_backward_and_late_starts_agree_with_the_truth() -> None:
    """Negative time is integrated as well as positive, and the start may be anywhere."""
    scene = spinning((Fraction(3, 4), Fraction(-1, 2), Fraction(7, 8)), Fraction(-50))
    far = Fraction(10) ** 16
    late = replace(scene, clock=Clock(far, tuple(far + t for t in scene.clock.instants)))
    for asked in (scene, late):
        assert largest_error(pose(asked, rung("f64"))) <= 1000 * 2.0**-53


def test_run_that_leaves_the_range_is_not_scored() -> None:
    """A moment that spins a float32 body beyond 10^38 ends non-finite or refused, never with a score."""
    scene = spinning((Fraction(1), Fraction(1), Fraction(1)), Fraction(10) ** 60)
    pushed = replace(
        scene, body=replace(scene.body, moment=(Fraction(1), Fraction(0), Fraction(0)))
    )
    (verdict,) = run(pushed, "taylor", "f32").verdicts
    assert verdict.verdict in (Status.FAIL, Status.REFUSED)
    assert verdict.max is None


@pytest.mark.parametrize("outcome", [o for o in Outcome if o is not Outcome.FINISHED])
def test_unfinished_run_fails_without_a_number(
    outcome: Outcome, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever stopped a solver, the verdict is fail with the outcome's sentence, and no error is 0."""
    from verify.solvers.taylor import driver

    monkeypatch.setattr(driver, "_propagate", lambda integrator, problem: (outcome, 7, []))
    (verdict,) = run("euler/generic", "taylor", "f64").verdicts
    assert verdict.verdict is Status.FAIL
    assert verdict.outcome == outcome.value
    assert (verdict.max, verdict.mean, verdict.final, verdict.ratio) == (None,) * 4


def test_step_limit_is_an_outcome(monkeypatch: pytest.MonkeyPatch) -> None:
    """A run that needs more steps than it is allowed stops and says so."""
    from verify.solvers.taylor import driver

    monkeypatch.setattr(driver, "_STEPS_PER_RADIAN", 0)
    long = spinning((Fraction(3, 4), Fraction(-1, 2), Fraction(7, 8)), Fraction(10**6))
    assert Taylor().solve(pose(long, rung("f64"))).outcome is Outcome.STEP_LIMIT


def test_runs_are_repeatable_whatever_ran_before() -> None:
    """A reused integrator carries nothing from one problem to the next: same bits again."""
    problem = pose(load("euler/generic"), rung("f64"))
    first = Taylor().solve(problem).quantities["omega"]
    Taylor().solve(pose(load("euler/about-max-axis"), rung("f64")))
    assert np.array_equal(first, Taylor().solve(problem).quantities["omega"])


def test_compiled_code_is_kept_apart_by_processor(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The disk cache is a folder named for this processor, inside the user's cache or the one named."""
    before = hy.llvm_state.get_diskcache_path()
    monkeypatch.setenv("HEYOKA_CACHE_DIR", str(tmp_path))
    use_own_cache()
    assert Path(hy.llvm_state.get_diskcache_path()) == tmp_path / processor_key()
    hy.llvm_state.set_diskcache_path(str(before))


def _answer(problem: Problem) -> object:
    """The sound answer as doubles, in the columns of a callback."""
    return Taylor().solve(problem).quantities["omega"].astype(float)


def test_callback_is_judged_like_any_solver() -> None:
    """A callable that returns states passes where its numbers are right."""
    verdicts = run("euler/generic", Callback(_answer), "f64").verdicts
    assert {v.verdict for v in verdicts} == {Status.PASS}


def test_callback_of_the_wrong_shape_or_that_raises_is_not_scored() -> None:
    """A misshapen answer and an exception are outcomes with their own sentences."""
    (misshapen,) = run("euler/generic", Callback(lambda p: _answer(p)[:, :2]), "f64").verdicts
    assert misshapen.verdict is Status.FAIL
    assert "expected states of shape (101, 3), got (101, 2)" in misshapen.because

    def broken(problem: Problem) -> object:
        raise ZeroDivisionError("by zero")

    (raised,) = run("euler/generic", Callback(broken), "f64").verdicts
    assert "ZeroDivisionError: by zero" in raised.because


@pytest.mark.parametrize(
    "value",
    [0.1, 3, np.float32(0.1), np.longdouble(1) / 3, np.int64(-7), mp.mpf("0.3"), Fraction(5, 8)],
)
def test_callback_numbers_are_taken_exactly(value: object) -> None:
    """Whatever number type a callable answers in, the judge sees that number and no other."""
    problem = pose(load("euler/generic"), rung("f64"))
    states = np.full((101, 3), value, dtype=object)
    held = Callback(lambda _: states).solve(problem).quantities["omega"][50, 1]
    exact = int(value) if isinstance(value, np.integer) else value
    assert Fraction(*held.as_integer_ratio()) == Fraction(*exact.as_integer_ratio())


@pytest.mark.parametrize("value", ["1.5", None, 1j, True])
def test_callback_answer_that_is_no_number_is_misshapen(value: object) -> None:
    """Text, None, complex numbers and booleans are refused with what was got."""
    states = np.full((101, 3), value, dtype=object)
    (verdict,) = run("euler/generic", Callback(lambda _: states), "f64").verdicts
    assert verdict.verdict is Status.FAIL
    assert "expected real numbers, got" in verdict.because


def test_zero_quaternion_fails() -> None:
    """A callable that leaves the attitude at zero has no attitude, and fails its gate by NaN."""

    def without_attitude(problem: Problem) -> object:
        sound = Taylor().solve(problem).quantities
        return np.hstack([sound["omega"], 0 * sound["quaternion"]])

    verdicts = run("euler/with-attitude", Callback(without_attitude), "f64").verdicts
    found = {v.quantity: v.verdict for v in verdicts}
    assert found["attitude"] is Status.FAIL
    assert found["omega"] is Status.PASS


def test_what_would_take_days_is_not_begun() -> None:
    """1e60 turns are more than can be stepped through: the outcome is the bound on steps, at once."""
    generic = load("euler/generic")
    whirling = replace(generic, initial=Spin((Fraction(10**60), Fraction(10**59), Fraction(1))))
    trajectory = Taylor().solve(pose(whirling, rung("f64")))
    assert trajectory.outcome is Outcome.STEP_LIMIT
    assert trajectory.steps == 0
