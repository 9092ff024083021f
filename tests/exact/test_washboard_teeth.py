"""Washboard orbits with many teeth between the start, the turning point and the time asked for.

Legend as in taylor_verify.exact.euler.moments.washboard.board and teeth.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest
from builders.scenes import one_instant, vector
from builders.turns import by_turns
from builders.washboards import DIGITS, axial, board, gap
from flint import arb, ctx, fmpq
from mpmath import mpf

from taylor_verify.exact.euler.moments.washboard import teeth
from taylor_verify.exact.euler.moments.washboard.balls import Course, Turn
from taylor_verify.exact.euler.moments.washboard.speed import speed
from taylor_verify.exact.euler.moments.washboard.teeth import FarTeeth
from taylor_verify.exact.euler.moments.washboard.turnings import MOST_TEETH, located
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import NoClosedForm, Unsettled
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.numbers.tensors import diagonal
from taylor_verify.run import run
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

# A spin against a moment that is too small to stop it before it has passed so many teeth. In the first two
# the teeth are so deep that the body all but stops on each of the last.
SCENES = {
    87: axial(2, "1/50", vector(1, 1, -2)),
    159: axial(2, "1/20", vector(5, 6, -5)),
    2_387_323: axial(2, "1/20", vector("1/2", "3/5", -500)),
}
DEEP = SCENES[159]


def teeth_to_the_turn(scene: Scene) -> int:
    washboard = board(scene)
    with ctx.workprec(192):
        count = abs(located(washboard).lower) * speed(washboard).rate / arb.pi()
    return int(count.floor().unique_fmpz())


def tooth_by_tooth(turn: Turn, y: arb) -> arb:
    """The time of the bead to y, an integral for each tooth."""
    assert turn._teeth is not None
    time, last = arb(0), arb(0)
    while y * y > last * last + turn._teeth.width:
        stop = (last * last + turn._teeth.width).sqrt().mid()
        time, last = time + turn._way(last, stop), stop
    return time + turn._way(last, y)


@pytest.mark.parametrize("teeth", SCENES)
def test_the_start_lies_so_many_teeth_from_the_turn(teeth: int) -> None:
    """The scenes of this file are what they are said to be."""
    assert teeth_to_the_turn(SCENES[teeth]) == teeth


@pytest.mark.parametrize("teeth", SCENES)
def test_the_closed_form_is_the_taylor_motion(teeth: int) -> None:
    """Both ways from the start; the recursion knows of no tooth and no turning point."""
    scene, rate = SCENES[teeth], 1 if teeth < 1000 else 100
    times = [Fraction(0), Fraction(3, rate), Fraction(-2, rate)]
    exact, expected = solution(scene, "arb"), TaylorSolution(scene).motion(times, DIGITS)
    assert (exact.route, exact.regime) == ("arb", "washboard-run")
    assert gap(exact.motion(times, DIGITS), expected) <= 2 * mpf(10) ** -DIGITS


# Sixteen teeth before the turning point, and 87.
SLOWER = axial(2, "1/50", vector(1, 1, -1))


@pytest.mark.parametrize(
    ("scene", "before", "beyond"),
    [(SLOWER, 40, 120), pytest.param(SCENES[87], 200, 500, marks=pytest.mark.slow)],
    ids=["16", "87"],
)
def test_it_turns_back_as_the_taylor_motion_does(scene: Scene, before: int, beyond: int) -> None:
    """Through the turning point, many teeth after the start, and as many beyond it."""
    digits = 15
    times = [Fraction(before), Fraction(beyond)]
    expected = TaylorSolution(scene).motion(times, digits)
    assert expected["omega"][0][2] < 0 < expected["omega"][1][2]
    assert gap(solution(scene, "arb").motion(times, digits), expected) <= 2 * mpf(10) ** -digits


# The sum over the teeth.


def far_and_near(bits: int) -> tuple[arb, arb]:
    """The time from the turn to the start, 159 teeth away: all at once, and tooth by tooth."""
    with ctx.workprec(bits):
        turn = Course(board(DEEP))._lower
        y = turn.place(arb(0)).mid()
        assert isinstance(turn._level, arb)
        assert isinstance(turn._teeth, FarTeeth)
        return turn._level - turn._teeth.level(turn.sigma(y)), tooth_by_tooth(turn, y)


@pytest.mark.parametrize("bits", [64, 128, pytest.param(256, marks=pytest.mark.slow)])
def test_the_teeth_all_at_once_take_the_time_of_each(bits: int) -> None:
    """The balls of the two sums overlap, and half of the bits are proven."""
    once, each = far_and_near(bits)
    assert once.overlaps(each)
    assert once.rad() <= arb(2) ** (-bits // 2)


@pytest.mark.parametrize("place", by_turns([6, 1, 2, 4], 4))
def test_a_wrong_term_of_the_sum_over_teeth_is_caught(
    place: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A coefficient that is off by a part in a million: the balls no longer overlap."""
    sound = teeth._coefficients

    def broken(a: int, bits: int) -> list[fmpq]:
        terms = sound(a, bits)
        terms[place] *= 1 + fmpq(1, 10**6)
        return terms

    monkeypatch.setattr(teeth, "_coefficients", broken)
    once, each = far_and_near(128)
    assert not once.overlaps(each)


# So small a moment that F on the crests, where it is least, is a billionth of F between them.
NARROW = axial(0, "-1e-9", vector("1/2", "3/5", "1/10"))


@pytest.mark.slow
def test_teeth_that_all_but_stop_the_body_are_summed_too() -> None:
    """Balls agree with the recursion; F is small there by its second order."""
    times = [Fraction(0), Fraction(5)]
    expected = TaylorSolution(NARROW).motion(times, 25)
    exact = solution(NARROW, "arb")
    assert exact.regime == "washboard-run"
    assert gap(exact.motion(times, 25), expected) <= 2 * mpf(10) ** -25


# What is not waited for.


def test_a_start_too_many_teeth_from_its_turn_has_no_closed_form() -> None:
    """1e22 teeth are refused in words, and the Taylor route takes over."""
    weak = axial(2, "1e-22", vector("1/2", "3/5", -3))
    with pytest.raises(NoClosedForm, match=r"more than 1e\+20 teeth of the washboard"):
        solution(weak, "arb")
    assert solution(weak).route == "taylor"


@pytest.mark.slow
def test_a_time_too_many_teeth_away_is_not_waited_for() -> None:
    """The number of teeth grows with the square of the time: 1e23 units are refused in words."""
    assert MOST_TEETH == 10**40
    with pytest.raises(Unsettled, match=r"more than 1e\+40 teeth"):
        solution(DEEP, "arb").motion([Fraction(10**23)], 15)


# The judge.


@pytest.mark.slow
def test_a_scene_with_many_teeth_is_judged() -> None:
    """The shipped scene, and through its turning point and beyond: a verdict on float64, a pass."""
    scene = load("extremes/euler-washboard-many-teeth")
    assert teeth_to_the_turn(scene) == 159
    longer = replace(scene.clock, instants=tuple(Fraction(k) for k in range(401)))
    for each in (scene, replace(scene, clock=longer)):
        verdicts = run(each).verdicts
        assert [v.verdict.value for v in verdicts] == ["pass"] * len(verdicts)
        assert "omega" in {v.quantity for v in verdicts}


def test_where_integrals_are_hard_series_answer() -> None:
    """A moment of 1e-100 tips a spin about the middle axis at t = 399: in a second, and proven."""
    pushed = RigidBody(diagonal(vector(1, 2, 3)), vector(0, 0, "1e-100"))
    tipped = solution(one_instant(pushed, Spin(vector(0, 1, 0))))
    motion = tipped.motion([Fraction(10), Fraction(404)], 30)
    assert (tipped.route, tipped.evidence) == ("taylor", "proven")
    assert motion.radius[1] <= 1e-30
    assert abs(motion["omega"][1][1] + 0.922373734915401) <= 1e-14
