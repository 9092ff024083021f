"""Damped motions: both closed forms, Taylor series of the damped equations, and what is conserved."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from builders.numbers import apart, closed_routes, overlap
from builders.scenes import everything
from builders.turns import by_turns
from mpmath import mp

from taylor_verify.exact.damping import without_damping
from taylor_verify.exact.elements import elements
from taylor_verify.exact.invariants import invariants
from taylor_verify.exact.registry import kind_of
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import NO_CLOSED_FORM, NoClosedForm, Unsettled
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

DIGITS = 25
# A scene of every regime of a rigid body and of a solid in a fluid.
RIGID = (
    *("euler/rest", "euler/spherical", "euler/steady-middle-axis", "euler/axisymmetric"),
    *("euler/separatrix-full-tensor", "euler/about-max-axis", "euler/full-tensor"),
)
FLUID = (
    *(
        "kirchhoff/rest",
        "kirchhoff/steady-spin",
        "kirchhoff/euler-top",
        "kirchhoff/four-real-roots",
    ),
    *("kirchhoff/two-real-roots", "kirchhoff/cubic", "kirchhoff/trigonometric"),
    *("kirchhoff/algebraic", "kirchhoff/falling-away", "kirchhoff/onto-the-axis"),
    *("kirchhoff/planar-swing", "kirchhoff/planar-turn"),
    *("kirchhoff/oblate-about-axis-1", "kirchhoff/remus-100", "kirchhoff/weber"),
)
NEAR = [Fraction(3, 2), Fraction(-1, 3), Fraction(0)]


def damped(name: str, damping: Fraction, start: Fraction = Fraction(0)) -> Scene:
    """The scene with this damping and all that its closed form tracks."""
    scene = load(name)
    scene = replace(scene, body=replace(scene.body, damping=damping))  # type: ignore[type-var]
    scene = replace(scene, clock=replace(scene.clock, start=start))
    if name == "kirchhoff/weber":
        return scene
    return everything(scene)


# Every fourth regime with one sign, by turns, and slowly with the other.
@pytest.mark.parametrize(
    ("name", "damping"),
    [
        pytest.param(name, damping, marks=() if n % 8 == 3 * k else pytest.mark.slow)
        for n, name in enumerate([*RIGID, *FLUID])
        for k, damping in enumerate([Fraction(7, 20), Fraction(-1, 5)])
    ],
)
def test_all_routes_agree(name: str, damping: Fraction) -> None:
    """Closed forms and Taylor series of the equations with -c z overlap in every regime, for either sign.

    The series know nothing of the theorem. The regime is that of the body without damping.
    """
    scene = damped(name, damping)
    routes = (*closed_routes(scene), "taylor")
    balls, *others = (solution(scene, route).motion(NEAR, DIGITS) for route in routes)
    for other in others:
        assert overlap(balls, other)
    free = replace(scene, body=scene.body.undamped)
    assert solution(scene).regime == solution(free).regime


@pytest.mark.parametrize("e", by_turns([-30, -12, 3], 2))
@pytest.mark.parametrize("name", by_turns(["euler/full-tensor", "kirchhoff/four-real-roots"], 2))
def test_the_size_of_the_damping(name: str, e: int) -> None:
    """Rates of either sign agree, from 1e-30, where 1 - e^{-ct} has no digits in doubles, to 1e3."""
    for sign in (1, -1):
        scene = damped(name, sign * Fraction(10) ** e)
        times = [Fraction(1, 100), Fraction(-1, 300)]
        balls, mpmath, series = (
            solution(scene, route).motion(times, DIGITS) for route in ("arb", "mpmath", "taylor")
        )
        assert overlap(balls, mpmath)
        assert overlap(balls, series)


def test_the_decay_counts_from_the_start() -> None:
    """A motion that begins at t = 1000 is that from t = 0, instant by instant since its start."""
    for name in ("euler/full-tensor", "kirchhoff/four-real-roots"):
        early, late = (
            damped(name, Fraction(1, 3), start) for start in (Fraction(0), Fraction(1000))
        )
        one, other = (solution(scene).motion(NEAR, DIGITS) for scene in (early, late))
        assert apart(one, other) == 0


@pytest.mark.parametrize("name", ["euler/full-tensor", "euler/axisymmetric"])
def test_a_damped_body_turns_no_further_than_its_horizon(name: str) -> None:
    """After any time at all the attitude is that of the free body at 1/c, to all digits asked for."""
    scene = damped(name, Fraction(1, 7))
    free = replace(scene, body=scene.body.undamped)
    far = solution(scene).motion([Fraction(10) ** 4], DIGITS)
    there = solution(free).motion([Fraction(7)], DIGITS)
    with mp.workdps(DIGITS + 10):
        difference = far["attitude"][0] - there["attitude"][0]
        assert mp.norm(list(difference.flat)) <= mp.mpf(10) ** (2 - DIGITS)
        assert 0 < mp.norm(list(far["omega"][0])) <= mp.mpf(10) ** -600


@pytest.mark.parametrize(
    "name", ["euler/full-tensor", "kirchhoff/four-real-roots", "kirchhoff/lyapunov"]
)
@pytest.mark.parametrize("damping", [Fraction(7, 20), Fraction(-1, 5)])
def test_what_is_conserved(name: str, damping: Fraction) -> None:
    """T, |H|^2, F^2, FG and a fourth integral, times e^{2ct}; in space R H e^{ct} and so on."""
    scene = damped(name, damping)
    times = [Fraction(0), Fraction(1), Fraction(5, 2)]
    with mp.workdps(DIGITS + 10):
        motion = solution(scene, "taylor").motion(times, DIGITS)
        grown = without_damping(scene, motion, times)
        conserved = invariants(scene)
        assert {one.name for one in conserved} >= (
            {"H2", "H_space"} if "omega" in grown.quantities else {"F2", "FG", "y_space"}
        )
        for invariant in conserved:
            rows = invariant.value(grown)
            plain = invariant.value(motion)
            change = np.max(abs(rows - rows[:1])) / invariant.scale(grown)
            assert change <= mp.mpf(10) ** (3 - DIGITS), invariant.name
            assert np.max(abs(plain - plain[:1])) > 0.1 * np.max(abs(plain[:1]))


def test_an_undamped_body_is_itself() -> None:
    """A damping of zero is none: the same body, the same parts, the same equations, the same motion."""
    for name in ("euler/full-tensor", "kirchhoff/four-real-roots", "euler/gyrostat"):
        scene = load(name)
        assert damped(name, Fraction(0)).body == scene.body == scene.body.undamped
        assert hash(damped(name, Fraction(0)).body) == hash(scene.body)
        assert "damping" not in scene.body.parts()
        one = kind_of(scene.body).equations(scene.body)
        other = kind_of(scene.body).equations(replace(scene.body, damping=Fraction(0)))  # type: ignore[type-var]
        assert all(np.array_equal(a, b) for a, b in zip(one, other, strict=True))
        motion = solution(scene).motion(NEAR, DIGITS)
        assert without_damping(scene, motion, NEAR) is motion


@pytest.mark.parametrize(
    "name", ["euler/gyrostat", "euler/constant-moment", "kirchhoff/constant-loads"]
)
def test_loads_and_wheels_leave_it_to_the_series(name: str) -> None:
    """Damping with a constant load or wheels has no closed form, and an enclosed motion all the same."""
    scene = damped(name, Fraction(1, 10))
    for route in ("arb", "mpmath"):
        with pytest.raises(NoClosedForm, match="damping together with"):
            solution(scene, route)
    exact = solution(scene)
    assert (exact.regime, exact.route) == (NO_CLOSED_FORM, "taylor")
    motion = exact.motion([Fraction(1)], DIGITS)
    assert max(motion.radius) <= mp.mpf(10) ** -DIGITS
    assert elements(scene).regime == NO_CLOSED_FORM


def test_what_is_out_of_reach_is_said_in_time() -> None:
    """A growth of e^100000 ends in a sentence, with the rows of the other times, and no number for it."""
    scene = damped("kirchhoff/four-real-roots", Fraction(-1))
    for route in ("arb", "mpmath"):
        with pytest.raises(Unsettled, match="the time of the motion without damping") as doubt:
            solution(scene, route).motion([Fraction(1), Fraction(10) ** 5], DIGITS)
        assert doubt.value.places == (0,)
        assert doubt.value.motion is not None
        with pytest.raises(Unsettled, match="2000 digits"):
            solution(scene, route).evaluate([Fraction(10) ** 5], DIGITS)


def test_a_growth_within_reach_has_its_digits() -> None:
    """The phase at e^60 has 26 digits before its point, and both routes agree behind it."""
    scene = damped("euler/full-tensor", Fraction(-3))
    balls, mpmath = (solution(scene, r).motion([Fraction(20)], DIGITS) for r in ("arb", "mpmath"))
    assert overlap(balls, mpmath)


def test_elements_tell_the_horizon() -> None:
    """The elements are those of the body without damping, with 1/c and the periods until then."""
    scene = load("euler/damped")
    damped, free = elements(scene), elements(replace(scene, body=scene.body.undamped))
    assert damped.regime == free.regime
    assert damped["period"].value == free["period"].value
    assert damped["horizon"].value == 20
    assert mp.almosteq(damped["periods_to_rest"].value, 20 / free["period"].value, 1e-12)
    assert "e^{ct}" in damped["T"].meaning
    assert "horizon" not in elements(load("euler/damped-negative"))
