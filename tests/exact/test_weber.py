"""Weber's case of Clebsch's second: theta functions of genus two, against Taylor.

The twins at the end are faults put in on purpose; the comparison they name must notice each.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cache
from itertools import cycle, pairwise

import numpy as np
import pytest
from builders.numbers import apart, overlap
from builders.scenes import one_instant, vector
from flint import ctx
from mpmath import mp, mpf

from taylor_verify.exact import integral
from taylor_verify.exact.balls import midpoint
from taylor_verify.exact.elements import elements
from taylor_verify.exact.kirchhoff import closed
from taylor_verify.exact.kirchhoff.integrable import CYCLIC
from taylor_verify.exact.kirchhoff.weber import quotients
from taylor_verify.exact.kirchhoff.weber.characteristics import HALF_PERIODS
from taylor_verify.exact.kirchhoff.weber.curve import Curve, curve
from taylor_verify.exact.kirchhoff.weber.periods import branch_points
from taylor_verify.exact.kirchhoff.weber.quotients import WeberBalls
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import NO_CLOSED_FORM, NoClosedForm, Unsettled
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import exact_value
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse, Motion
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

DIGITS = 42
TIMES = [Fraction(0), Fraction(1, 3), Fraction(-3, 2), Fraction(3)]


CLEBSCH = ("1", "3/2", "1/2")
ALIKE = ("3/4", "3/4", "3/4")


def built(
    x: Vector,
    y: Vector,
    r: Vector,
    p: Vector,
    coupling: Fraction = Fraction(1, 8),
) -> Scene:
    """A scene whose T is sum (p_i x_i^2 + r_i y_i^2)/2 and a multiple of x.y, which is nothing here."""
    body = ImmersedBody(tensors.diagonal(p), tensors.diagonal((coupling,) * 3), tensors.diagonal(r))
    return one_instant(body, Impulse(x, y))


def second(r: Vector, theta: Fraction, shared: Fraction = Fraction(4)) -> Vector:
    """The p of Clebsch's second case."""
    return tuple(shared + theta * r[j] * r[k] for _, j, k in CYCLIC)


# Starts, by what is special about them; y is across x in all.
STARTS: dict[str, tuple[Vector, Vector]] = {
    "plain": (vector("3/4", "-1/2", "1"), vector("1/2", "-1/4", "-1/2")),
    "x_1 = 0": (vector("0", "-1/2", "1"), vector("1/2", "1", "1/2")),
    "x along axis 2": (vector("0", "3/4", "0"), vector("1/2", "0", "-1/3")),
    "x along axis 3": (vector("0", "0", "-1"), vector("1/2", "1/3", "0")),
    "y = 0": (vector("3/4", "-1/2", "1"), vector("0", "0", "0")),
    "y_3 = 0": (vector("3/4", "-1/2", "1"), vector("1/2", "3/4", "0")),
    "fast": (vector("1/4", "1/2", "-1/3"), vector("2", "-1", "0")),
}
BODIES: dict[str, tuple[Vector, Vector]] = {
    "r alike": (vector(*ALIKE), vector("1", "7/4", "1/2")),
    "theta > 0": (vector(*CLEBSCH), second(vector(*CLEBSCH), Fraction(1, 2))),
    "theta < 0": (vector("1/2", "1", "5/4"), second(vector("1/2", "1", "5/4"), Fraction(-3, 4))),
}


@cache
def case(start: str, body: str) -> Scene:
    return built(*STARTS[start], *BODIES[body])


def curve_of(scene: Scene) -> Curve:
    weber_curve = curve(scene)
    assert weber_curve is not None
    return weber_curve


def shipped() -> Scene:
    return load("kirchhoff/weber")


# Against Taylor.


# Every start, the bodies by turns.
@pytest.mark.parametrize(("body", "start"), [*zip(cycle(BODIES), STARTS, strict=False)])
def test_the_balls_hold_the_taylor_motion(body: str, start: str) -> None:
    """x and y to 42 digits, forward and backward, of both families and from every kind of start."""
    scene = case(start, body)
    exact_motion = solution(scene)
    assert (exact_motion.regime, exact_motion.route) == ("weber", "arb")
    motion = exact_motion.motion(TIMES, DIGITS)
    truth = TaylorSolution(scene).motion(TIMES, DIGITS)
    with mp.workdps(DIGITS + 30):
        assert apart(truth, motion) <= 2 * mpf(10) ** -DIGITS
    assert overlap(truth, motion)


def test_far_times_cost_no_digit() -> None:
    """After 10^12 units of time, and three more: Taylor leads from the one state to the other."""
    scene, far, on = shipped(), Fraction(10**12), Fraction(3)
    there = closed.enclosed(scene).motion([far, far + on], DIGITS)
    x, y = (
        tuple(exact_value(entry) for entry in there[name][0])
        for name in ("linear_impulse", "angular_impulse")
    )
    beyond = TaylorSolution(replace(scene, initial=Impulse(x, y))).motion([on], DIGITS)
    with mp.workdps(DIGITS + 30):
        for name in beyond.quantities:
            difference = mp.norm(list(beyond[name][0] - there[name][1]))
            # What is handed on is right to 10^-42; in three units of time the orbit makes of that
            # at most some ten times as much.
            assert difference <= 100 * mpf(10) ** -DIGITS


# What is Weber's, and what is not.


LITTLE = Fraction(1, 10**40)


def test_what_is_nearly_webers_is_not() -> None:
    """FG of 10^-40, or Clebsch's relation short by that, and there is no theta function."""
    scene = shipped()
    assert isinstance(scene.initial, Impulse)
    assert isinstance(scene.body, ImmersedBody)
    y = scene.initial.angular
    askew = replace(scene, initial=replace(scene.initial, angular=(y[0] + LITTLE, *y[1:])))
    with pytest.raises(NoClosedForm, match="only the motions with FG = 0"):
        curve(askew)
    p = tuple(scene.body.linear[n][n] for n in range(3))
    body = replace(scene.body, linear=tensors.diagonal((p[0] + LITTLE, *p[1:])))
    assert curve(replace(scene, body=body)) is None
    for other in (askew, replace(scene, body=body)):
        assert solution(other).regime == NO_CLOSED_FORM


# F_2 = y_3^2/(a_2 - a_1) + y_1^2/(a_2 - a_3) = 0, though a_2 - a_1 = a_3 - a_2: a_2 is a root of B.
DEGENERATE = built(vector("1/2", 0, "1/2"), vector(1, "-1/2", -1), vector(1, 1, 1), vector(1, 2, 3))
DECLINED = {
    "two branch points of Weber's curve coincide": DEGENERATE,
    "only the motions with FG = 0": built(
        vector(1, "1/2", 1), vector(1, 1, 1), *BODIES["theta > 0"]
    ),
    "of Clebsch's form": built(vector(1, 0, 1), vector(1, 1, -1), vector(1, 2, 3), vector(1, 2, 4)),
}


@pytest.mark.parametrize("reason", DECLINED)
def test_other_motions_are_declined_with_the_reason(reason: str) -> None:
    """A degenerate curve, FG that is not zero, another body: Taylor's, then."""
    with pytest.raises(NoClosedForm, match=reason):
        solution(DECLINED[reason], "arb")
    assert solution(DECLINED[reason]).route == "taylor"


def test_beside_a_degenerate_curve_the_balls_still_hold() -> None:
    """x_2 = 10^-12 beside it: two branch points all but coincide, and no digit is lost."""
    little = Fraction(1, 10**12)
    near = built(
        (Fraction(1, 2), little, Fraction(1, 2)),
        (1 + little, Fraction(-1, 2), Fraction(-1)),
        vector(1, 1, 1),
        vector(1, 2, 3),
    )
    times = [Fraction(-7, 2)]
    motion = closed.enclosed(near).motion(times, 30)
    truth = TaylorSolution(near).motion(times, 30)
    with ctx.workprec(200):
        e = branch_points(curve_of(near))
        assert min((b - a).mid() for a, b in pairwise(e)) < 1e-11
    with mp.workdps(60):
        assert apart(truth, motion) <= 2 * mpf(10) ** -30


def test_attitude_and_path_have_no_closed_form() -> None:
    """The whole answer is Taylor's where they are tracked, and its impulses lie in the balls of Weber's."""
    scene, times = load("kirchhoff/weber-path"), [Fraction(4)]
    with pytest.raises(NoClosedForm, match="attitude and centre of Weber's motion"):
        solution(scene, "arb")
    whole = solution(scene)
    assert (whole.regime, whole.route) == (NO_CLOSED_FORM, "taylor")
    impulses = solution(replace(scene, track=frozenset()), "arb").motion(times, 20)
    motion = whole.motion(times, 20)
    with mp.workdps(30):
        for name in impulses.quantities:
            difference = mp.norm(list(impulses[name][0] - motion[name][0]))
            assert difference <= 2 * mpf(10) ** -20 * mp.norm(list(motion[name][0]))


def test_the_elements_of_the_whole_motion_keep_the_two_rates() -> None:
    """Where the attitude is tracked the regime is no closed form, and numbers and sentences stay."""
    whole, impulses = elements(load("kirchhoff/weber-path")), elements(shipped())
    assert (whole.regime, impulses.regime) == (NO_CLOSED_FORM, "weber")
    assert whole.numbers == impulses.numbers
    assert whole.sentences == impulses.sentences


def test_series_answer_where_no_integral_does(monkeypatch: pytest.MonkeyPatch) -> None:
    """Periods to so many bits would take hours: the enclosure answers, and the regime stays."""
    monkeypatch.setattr(integral, "_MOST_BITS", 100)
    exact = solution(shipped())
    assert exact.route == "arb"
    motion = exact.motion([Fraction(1, 3)], 40)
    assert (exact.regime, exact.route) == ("weber", "taylor")
    assert motion.radius.max() <= mpf(10) ** -40
    with pytest.raises(Unsettled, match="would take hours"):
        solution(shipped(), "arb").motion([Fraction(1, 3)], 40)


def test_the_angles_grow_at_the_rates_that_are_told() -> None:
    """After p/q turns of both angles, nearly whole, x and y are nearly those of the start."""
    scene = shipped()
    with mp.workdps(40):
        first, second = (elements(scene, 30)[n].value for n in ("first_rate", "second_rate"))
        # A time after which the first angle has turned 199 times; the second all but 448 times.
        turns, other = min(
            ((n, second / first * n) for n in range(1, 200)),
            key=lambda pair: abs(pair[1] - mp.nint(pair[1])),
        )
        t = 2 * mp.pi * turns / first
        time = Fraction(*(int(n) for n in t.as_integer_ratio()))
        left = 2 * mp.pi * abs(other - mp.nint(other))
        motion = solution(scene).motion([Fraction(0), time, time / 2], 20)
        x = motion["linear_impulse"]
        assert mp.norm(list(x[1] - x[0])) <= 4 * left
        assert mp.norm(list(x[2] - x[0])) >= mpf("0.01")


# Broken twins.


@pytest.mark.parametrize("other", range(5))
def test_a_wrong_theta_characteristic_is_seen(monkeypatch: pytest.MonkeyPatch, other: int) -> None:
    """theta of another branch point than a_1 in x_1: wrong by more than any tolerance, or NaN."""
    scene = case("plain", "r alike")
    own = curve_of(scene).places[0]
    truth = TaylorSolution(scene).motion(TIMES[1:], 20)
    broken = list(HALF_PERIODS)
    broken[own] = HALF_PERIODS[other]
    monkeypatch.setattr(quotients, "HALF_PERIODS", tuple(broken))
    with mp.workdps(30):
        wrong = apart(truth, midpoints(scene))
        # The right one among the five shows that the comparison lets through what it should.
        assert (wrong <= mpf(10) ** -20) is (other == own)
        assert other == own or not wrong <= mpf("0.01")


def midpoints(scene: Scene) -> Motion:
    """What the balls say at one precision, however wide they are."""
    spectral_curve = curve_of(scene)
    with ctx.workprec(200):
        rows = WeberBalls(spectral_curve).enclose(TIMES[1:], 200)
    centre = np.frompyfunc(midpoint, 1, 1)
    quantities = {name: centre(np.array(balls, dtype=object)) for name, balls in rows.items()}
    return Motion(quantities, np.zeros(len(TIMES) - 1))
