"""A triaxial body under a constant moment, in closed form: against the enclosed Taylor series.

Legend as in taylor_verify.exact.euler.moments.washboard.board.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from builders.scenes import vector
from builders.turns import by_turns
from builders.washboards import DIGITS, FRAME, axial, board, gap, loaded
from flint import acb, arb, ctx
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from taylor_verify.exact.balls import Undecidable
from taylor_verify.exact.conditioning import condition, differences
from taylor_verify.exact.elements import elements
from taylor_verify.exact.euler.moments.washboard import balls
from taylor_verify.exact.euler.moments.washboard.balls import Turn
from taylor_verify.exact.euler.moments.washboard.board import Washboard
from taylor_verify.exact.euler.moments.washboard.speed import Growing, speed
from taylor_verify.exact.euler.moments.washboard.turnings import _summit, regime, turnings
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import NO_CLOSED_FORM, NoClosedForm
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.models.problem import pose
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import exact_value, rung
from taylor_verify.numbers.tensors import Matrix
from taylor_verify.records.precisions import LADDER
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Motion, Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

SHIPPED = {
    "moment-middle-axis": "washboard-swing",
    "washboard-swing": "washboard-swing",
    "washboard-run": "washboard-run",
}


# A rotation with rational entries, so that the principal axes are rational and none is a body axis.
TURN: Matrix = tuple(
    tensors.scaled(Fraction(1, 9), vector(*row)) for row in ((1, 8, -4), (-4, 4, 7), (8, 1, 4))
)


def turned(scene: Scene) -> Scene:
    """The same body and motion in axes that are not principal."""
    assert isinstance(scene.body, RigidBody)
    assert isinstance(scene.initial, Spin)
    inertia = tensors.product(tensors.product(TURN, scene.body.inertia), tensors.transpose(TURN))
    moment, omega = (tensors.apply(TURN, v) for v in (scene.body.moment, scene.initial.omega))
    return replace(scene, body=RigidBody(inertia, moment), initial=Spin(omega, FRAME))


# In the middle axis' falling direction: J = (1, 8/3, 2), kappa = |M|^2/4, and v0 dies away with sigma.
FALLING = loaded(
    tensors.diagonal(vector(1, "8/3", 2)), vector(0, 0, "1/2"), vector(1, "-3/4", "-1/2")
)
SCENES = {
    "least swing": (axial(0, "1/10", vector("1/5", "7/10", "1/2")), "washboard-swing"),
    "least run": (axial(0, "-2/5", vector("1/5", "7/10", "1/2")), "washboard-run"),
    "middle": (axial(1, "-1/3", vector("1/2", "-1/4", "2/3")), "washboard-swing"),
    "middle falling": (FALLING, "washboard-run"),
    "greatest swing": (axial(2, "1/20", vector("1/2", "3/5", "-1/5")), "washboard-swing"),
    "greatest run": (axial(2, "1/20", vector("1/2", "3/5", "-1/2")), "washboard-run"),
    "steep run": (axial(2, "1", vector("1/2", "1/5", "-1")), "washboard-run"),
    "from rest below": (axial(1, "1/10", vector("1/9", 0, "1/10")), "washboard-swing"),
    "from rest above": (axial(0, "1/10", vector(0, "-1/2", "3/4")), "washboard-swing"),
    "from rest, steep": (axial(2, "-1/2", vector("1/2", "-1/5", 0)), "washboard-run"),
    "turned": (turned(axial(0, "1/10", vector("1/5", "7/10", "1/2"))), "washboard-swing"),
}
TIMES = tuple(map(Fraction, ("0", "1/3", "13/2", "-4", "-8")))

# What two numbers of so many digits may differ by.
BOTH = 2 * mpf(10) ** -DIGITS


@cache
def truth(name: str) -> Motion:
    return TaylorSolution(SCENES[name][0]).motion(TIMES, DIGITS)


# Against what knows nothing but the equations of motion.


@pytest.mark.parametrize("name", by_turns(SCENES, 2, lambda name: SCENES[name][1]))
def test_the_closed_form_is_the_taylor_motion(name: str) -> None:
    """To 45 digits on both sides of the start, along each axis, for every kind of end."""
    scene, word = SCENES[name]
    exact = solution(scene, "arb")
    assert (exact.route, exact.regime) == ("arb", word)
    assert gap(exact.motion(TIMES, DIGITS), truth(name)) <= BOTH


@pytest.mark.parametrize("name", SHIPPED)
def test_the_shipped_scenes_have_their_regime_on_every_rung(name: str) -> None:
    """Rounding leaves the moment along a principal axis, and the kind of motion what it is."""
    scene = load(f"euler/{name}")
    words = {solution(pose(scene, rung(step)).given).regime for step in LADDER}
    assert words == {SHIPPED[name]}


def test_it_holds_through_eleven_turning_points() -> None:
    """The shipped swing far beyond its end, where the other axes are not rational."""
    scene = load("euler/washboard-swing")
    exact = solution(scene, "arb")
    motion = exact.motion([Fraction(3 * k, 2) for k in range(41)], 15)
    spin = [float(row[2]) for row in motion["omega"]]
    assert sum(a * b < 0 for a, b in pairwise(spin)) == 11
    times = [Fraction(31), Fraction(60)]
    expected = TaylorSolution(scene).motion(times, DIGITS)
    assert gap(exact.motion(times, DIGITS), expected) <= BOTH


# What the motion is as a whole.


def test_a_million_periods_later_is_a_part_of_a_period_later() -> None:
    """Where no recursion follows: the period of the Taylor motion (below), as often as it is passed."""
    scene, elapsed = SCENES["greatest swing"][0], Fraction(13, 2)
    with mp.workdps(2 * DIGITS):
        period = exact_value(elements(scene, DIGITS + 10)["period"].value)
    near, far = (
        solution(scene, "arb").motion([t], DIGITS) for t in (elapsed, elapsed + 10**6 * period)
    )
    assert far.radius[0] <= mpf(10) ** -DIGITS
    # The period has ten digits more, of which the million takes six.
    assert gap(near, far) <= 10 * BOTH


def test_omega_recurs_after_its_period_by_the_taylor_motion() -> None:
    """The period that explain prints, twice over, and not before."""
    scene, _ = SCENES["middle"]
    period = exact_value(elements(scene, 50)["period"].value)
    motion = TaylorSolution(scene).motion([Fraction(0), period / 2, period, 2 * period], DIGITS)
    with mp.workdps(2 * DIGITS):
        start, half, once, twice = motion["omega"]
        for row in (once, twice):
            assert mp.norm(list(row - start)) <= mpf(10) ** -(DIGITS - 3)
        assert mp.norm(list(half - start)) >= mpf("0.1")


def kept_by(scene: Scene, motion: Motion) -> list[Any]:
    """2T J - |H|^2 at every time."""
    assert isinstance(scene.body, RigidBody)
    rows = [[mp.convert(entry) for entry in row] for row in scene.body.inertia]
    H = motion["omega"] @ np.array(rows, dtype=object)
    J = mp.convert(board(scene).axial_moment)
    return [J * (w @ h) - h @ h for w, h in zip(motion["omega"], H, strict=True)]


@pytest.mark.parametrize("name", ["least run", "middle", "turned"])
def test_what_elements_says_is_conserved_is(name: str) -> None:
    """2T J - |H|^2 of the Taylor motion at every time."""
    scene, _ = SCENES[name]
    conserved = elements(scene, 30)["2TJ-H2"].value
    with mp.workdps(2 * DIGITS):
        assert all(abs(now - conserved) <= mpf("1e-29") for now in kept_by(scene, truth(name)))


@pytest.mark.parametrize("name", SCENES)
def test_the_ends_are_where_the_spin_is_zero_and_nowhere_between(name: str) -> None:
    """F is proven positive on a cover of the interval from end to end, and encloses 0 at both."""
    washboard = board(SCENES[name][0])
    with ctx.workprec(160):
        F, ends = speed(washboard), turnings(washboard)
        top = ends.upper if ends.upper is not None else ends.lower + 10 / F.rate
        assert F.squared(ends.lower).contains(0)
        assert ends.upper is None or F.squared(ends.upper).contains(0)
        quotient, parts = F.quotient(ends.lower), 1024
        from_above = quotient if ends.upper is None else F.quotient(ends.upper)
        for k in range(parts):
            # F over the distance to the lower end, and over that to the upper one, is positive.
            z = (top - ends.lower) * (arb(k) / parts).union(arb(k + 1) / parts)
            middle = 2 * k < parts
            if middle or ends.upper is None:
                assert quotient(acb(z)).real > 0
            else:
                down = (top - ends.lower) - z
                assert from_above(acb(-down)).real < 0


@pytest.mark.parametrize("moment", ["1/1000", "1/10", "1"])
def test_from_rest_the_ends_are_sought_from_where_the_spin_is_greatest(moment: str) -> None:
    """There F is positive and its slope is zero, however near it lies to the start."""
    washboard = board(axial(1, moment, vector("1/9", 0, "1/10")))
    assert not washboard.never_climbs
    with ctx.workprec(160):
        F = speed(washboard)
        assert isinstance(F, Growing)
        summit = _summit(F)
        assert F.squared(summit) > 0
        assert abs(F.derivative(summit)) <= F.slope * arb(2) ** -100


# Between a swing and a run.


def test_a_precision_that_tells_no_swing_from_a_run_says_so() -> None:
    """Halved until both differ by 2^-20, which 24 bits do not tell and 40 bits do."""
    low, high = Fraction(-1, 5), Fraction(-1, 2)

    def washboard(spin: Fraction) -> Washboard:
        return board(axial(2, "1/20", (Fraction(1, 2), Fraction(3, 5), spin)))

    for _ in range(20):
        middle = (low + high) / 2
        is_swing = regime(washboard(middle)) == "washboard-swing"
        low, high = (middle, high) if is_swing else (low, middle)
    for spin, is_swing in ((low, True), (high, False)):
        with ctx.workprec(40):
            assert (turnings(washboard(spin)).upper is not None) == is_swing
        with ctx.workprec(24), pytest.raises(Undecidable):
            turnings(washboard(spin))


def test_a_swing_and_a_run_a_part_in_ten_to_the_twelve_apart_are_told() -> None:
    """No rational start is on the separatrix; on either side of it the routes overlap with Taylor.

    Halved in between a swing and a run until they differ by 2^-40.
    """
    low, high = Fraction(-1, 5), Fraction(-1, 2)

    def start(spin: Fraction) -> Scene:
        return axial(2, "1/20", (Fraction(1, 2), Fraction(3, 5), spin))

    for _ in range(40):
        middle = (low + high) / 2
        is_swing = regime(board(start(middle))) == "washboard-swing"
        low, high = (middle, high) if is_swing else (low, middle)
    times, digits = [Fraction(30)], 25
    for spin, word in ((low, "washboard-swing"), (high, "washboard-run")):
        expected = TaylorSolution(start(spin)).motion(times, digits)
        exact = solution(start(spin), "arb")
        assert exact.regime == word
        assert gap(exact.motion(times, digits), expected) <= 2 * mpf(10) ** -digits


def test_what_falls_exactly_never_climbs_again() -> None:
    """v0 along the direction that dies away: a run; turned by 1e-40, a swing with a far upper end."""
    assert board(FALLING).never_climbs
    assert isinstance(FALLING.initial, Spin)
    a, b, c = FALLING.initial.omega
    beside = replace(FALLING, initial=Spin((a, b + Fraction(1, 10**40), c), FRAME))
    climbing = solution(beside, "arb")
    assert climbing.regime == "washboard-swing"
    # The difference has grown by e^(Omega sigma), less than e^10 here, from 1e-40 of omega.
    rows = (exact.motion([Fraction(4)], 36) for exact in (climbing, solution(FALLING, "arb")))
    assert gap(*rows) <= mpf("1e-35")
    far = solution(FALLING, "arb").motion([Fraction(10**4)], DIGITS)["omega"][0]
    assert abs(far[0]) <= mpf("1e-1000")
    assert far[2] >= 2000


# What keeps its axis.

STEADY = loaded(
    tensors.diagonal(vector(1, 2, 3)), vector("-2/3", "1/2", "-1/3"), vector(1, "2/3", "1/2")
)


def balanced(scene: Scene) -> Scene:
    """The moment that the gyroscopic one balances."""
    assert isinstance(scene.body, RigidBody)
    assert isinstance(scene.initial, Spin)
    H = tensors.apply(scene.body.inertia, scene.initial.omega)
    moment = tensors.cross(scene.initial.omega, H)
    body = RigidBody(scene.body.inertia, moment)
    return replace(scene, body=body, track=frozenset({"attitude"}))


STRAIGHT = replace(axial(1, "1/3", vector(0, -1, 0)), track=frozenset({"attitude"}))


@pytest.mark.parametrize("route", ["arb", "mpmath"])
@pytest.mark.parametrize(
    ("scene", "word"),
    [
        (balanced(STEADY), "steady-moment"),
        (balanced(turned(STEADY)), "steady-moment"),
        (STRAIGHT, "straight-moment"),
        (turned(STRAIGHT), "straight-moment"),
    ],
)
def test_a_fixed_axis_has_its_attitude_too(scene: Scene, word: str, route: str) -> None:
    """omega constant, or growing along its own axis: R by Taylor, from a start that is not 1."""
    exact = solution(scene, route)
    assert exact.regime == word
    expected = TaylorSolution(scene).motion(TIMES, DIGITS)
    assert set(expected.quantities) == {"omega", "attitude"}
    assert gap(exact.motion(TIMES, DIGITS), expected) <= BOTH
    assert elements(scene, 15).regime == word


# Bodies drawn at random.

components = st.one_of(
    st.integers(-20, 20).map(lambda n: Fraction(n, 10)),
    st.just(Fraction(0)),
    st.builds(lambda n, e: Fraction(n, 7) / 10**e, st.integers(-9, 9), st.integers(1, 20)),
)


@st.composite
def boards(draw: st.DrawFn) -> Scene:
    """Any triaxial body of moments 1/2 to 4 with M along a principal axis, often in turned axes."""
    moments = [Fraction(draw(st.integers(2, 16)), 4) for _ in range(3)]
    assume(len(set(moments)) == 3)
    axis = draw(st.integers(0, 2))
    push = Fraction(draw(st.sampled_from([-1, 1])) * draw(st.integers(1, 40)), 50)
    moment = tuple(push if i == axis else Fraction(0) for i in range(3))
    omega = draw(st.tuples(components, components, components))
    scene = loaded(tensors.diagonal(tuple(moments)), moment, omega)
    return turned(scene) if draw(st.booleans()) else scene


QUIET = [HealthCheck.too_slow]


@settings(max_examples=12, deadline=None, suppress_health_check=QUIET)
@given(boards(), st.integers(-60, 60).map(lambda n: Fraction(n, 11)))
def test_drawn_bodies_move_as_the_taylor_motion(scene: Scene, t: Fraction) -> None:
    """Starts at rest, on an axis, or 1e-20 beside one: the balls are the recursion's numbers."""
    expected = TaylorSolution(scene).motion([t], DIGITS)
    assert gap(solution(scene, "arb").motion([t], DIGITS), expected) <= BOTH


# Broken on purpose.


class OneBranch(Turn):
    """Broken on purpose: nu as the positive root of F, on whichever side of the turning point."""

    def nu(self, y: arb) -> arb:
        return abs(super().nu(y))


def test_a_turning_point_on_the_wrong_branch_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    """The Taylor motion sees the sign of nu; 2T J - |H|^2 does not."""
    scene, _ = SCENES["least swing"]
    times = [Fraction(k) for k in range(1, 9)]
    expected = TaylorSolution(scene).motion(times, DIGITS)
    turning = [float(row[0]) for row in expected["omega"]]
    assert min(turning) < 0 < max(turning)
    monkeypatch.setattr(balls, "Turn", OneBranch)
    motion = solution(scene, "arb").motion(times, DIGITS)
    assert not gap(motion, expected) <= mpf("1e-3")
    with mp.workdps(2 * DIGITS):
        conserved = kept_by(scene, motion)
        assert max(abs(value - conserved[0]) for value in conserved) <= mpf("1e-40")


# Where it is not used.


def test_the_condition_comes_from_variational_equations(monkeypatch: pytest.MonkeyPatch) -> None:
    """Differences of a quadrature at hundreds of digits are never formed."""
    scene = load("euler/moment-middle-axis")
    assert solution(scene).by_quadrature
    assert not solution(load("euler/generic")).by_quadrature

    def refused(*_: object) -> None:
        raise AssertionError("differences of the exact solution were asked for")

    monkeypatch.setattr(differences, "derivatives", refused)
    carried = condition.transition(scene, [Fraction(0), Fraction(5)])
    assert carried.norms("omega", "momentum")[1] > 0


@pytest.mark.parametrize(
    ("scene", "what"),
    [
        (replace(SCENES["middle"][0], track=frozenset({"attitude"})), "the attitude of a body"),
        (
            loaded(tensors.diagonal(vector(1, 2, 3)), vector(0, 1, "1e-300"), vector(1, 1, 1)),
            "no principal axis",
        ),
    ],
)
def test_where_there_is_no_closed_form_it_says_so(scene: Scene, what: str) -> None:
    """The closed form is refused, and the Taylor route takes over under the word for it."""
    with pytest.raises(NoClosedForm, match=what):
        solution(scene, "arb")
    exact = solution(scene)
    assert (exact.route, exact.regime) == ("taylor", NO_CLOSED_FORM)
