"""Clebsch's body in every regime: closed forms, against each other for long and against Taylor.

The twins at the end are faults put in on purpose; the comparison with Taylor must notice each.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np
import pytest
from builders.clebsch import (
    BLUNT,
    COUPLED,
    EVEN,
    FALLING,
    GENERIC,
    MOTIONS,
    PLAIN,
    SHARP,
    STOUT,
    State,
    at_the_border,
    body,
    exact,
    falling,
)
from builders.numbers import closed_routes, overlap
from builders.scenes import one_instant, vector
from builders.turns import by_turns
from flint import acb, arb, ctx
from mpmath import mpf

from taylor_verify.exact import lattice
from taylor_verify.exact.balls import Undecidable
from taylor_verify.exact.kirchhoff import orbit
from taylor_verify.exact.kirchhoff.closed import enclosed
from taylor_verify.exact.kirchhoff.space import CayleyKlein
from taylor_verify.exact.kirchhoff.wave import Rise, SquareIntegral
from taylor_verify.exact.kirchhoff.weierstrass import Orbit
from taylor_verify.exact.route import CLOSED_ROUTES, solution
from taylor_verify.exact.solution import NoClosedForm, Unsettled
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.numbers.irrational import ball
from taylor_verify.numbers.precision import exact_value
from taylor_verify.scenes.bodies import Clebsch
from taylor_verify.scenes.motion import Impulse, Motion
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

DIGITS = 30
TILTED = vector(2, -1, 1, 3)  # not of unit length
ASIDE = vector(1, -2, "1/2")


of_each_regime = pytest.mark.parametrize(
    "name", by_turns(MOTIONS, len(MOTIONS), lambda name: MOTIONS[name][2])
)


def whole(solid: Clebsch, start: State) -> Scene:
    """A scene with attitude and centre, neither of them the usual one."""
    impulse = Impulse(tuple(start[:3]), tuple(start[3:]), TILTED, ASIDE)
    return one_instant(solid.body(), impulse, "attitude", "centre")


def scene(name: str) -> Scene:
    solid, start, _ = MOTIONS[name]
    return whole(Clebsch(*exact(solid)), exact(start))


# The comparison.


def motion_by(asked: Scene, route: str, times: Sequence[Fraction], digits: int = DIGITS) -> Motion:
    """The motion by a route, with its digits."""
    motion = solution(asked, route).motion(times, digits)
    assert all(radius <= mpf(10) ** -digits for radius in motion.radius)
    return motion


@cache
def truth(asked: Scene, times: tuple[Fraction, ...]) -> Motion:
    return TaylorSolution(asked).motion(times, DIGITS)


def is_taylors(asked: Scene, route: str, times: Sequence[Fraction]) -> bool:
    """Return whether a route finds impulses, attitude and centre as Taylor does."""
    try:
        return overlap(motion_by(asked, route, times), truth(asked, tuple(times)))
    except Unsettled:
        return False


@of_each_regime
def test_agrees_with_taylor(name: str) -> None:
    """Regime, impulses, attitude and centre, both ways in time and beside the start, on closed routes."""
    asked, times = scene(name), vector(1, "-2/3", 0, "1/1000000007")
    for route in closed_routes(asked):
        assert solution(asked, route).regime == MOTIONS[name][2]
        assert is_taylors(asked, route, times)


@of_each_regime
@pytest.mark.parametrize("bits", [60, 100, 170])
def test_a_ball_at_any_precision_holds_the_truth(name: str, bits: int) -> None:
    """Component by component, however coarse: what is found with 80 digits lies in every ball."""
    times = vector("3/2", -40)
    fine = motion_by(scene(name), "arb", times, 80)
    with ctx.workprec(bits):
        try:
            coarse: Any = enclosed(scene(name))
            rows = coarse.enclose(times, bits)
        except Undecidable:
            pytest.skip("a branch is open at this precision")
    with ctx.workprec(400):
        # The finer number is known to 80 digits of its vector, which is below 10000.
        blur = ball(Fraction(1, 10**76))
        for quantity, entries in rows.items():
            wide = np.array(entries, dtype=object).flat
            for narrow, coarse_ball in zip(fine[quantity].flat, wide, strict=True):
                assert coarse_ball.overlaps(arb(ball(exact_value(narrow)), blur))


def test_a_short_way_has_its_digits() -> None:
    """The centre has all the digits asked for 1e-30 units of time after it leaves the origin."""
    for name in (
        "four real roots",
        "cubic, third root above",
        "heteroclinic",
        "quadratic",
        "steady",
    ):
        asked = scene(name)
        asked = replace(asked, initial=replace(asked.initial, centre=vector(0, 0, 0)))
        for route in closed_routes(asked):
            assert is_taylors(asked, route, [Fraction(1, 10**30)])


def test_a_way_that_two_precisions_would_lose_has_its_digits() -> None:
    """Impulses of 1e-150 move the centre by as little: both would agree on a wrong one."""
    asked, times = load("extremes/kirchhoff-impulses-1e-150"), [Fraction(5)]
    assert overlap(motion_by(asked, "arb", times, 40), motion_by(asked, "mpmath", times, 40))


# Difficult bodies.

TINY = "1/1000000000000000000000000000000"
SHY, OVER = "999999999999999999999999999999/1" + "0" * 30, "1" + "0" * 29 + "1/1" + "0" * 30


def beside(solid: Clebsch, change: Fraction) -> Clebsch:
    return replace(solid, p_prime=solid.p_prime + change)


A_BIT = Fraction(TINY)
FAR_OUT = vector("2000000/1000000000001", 0, "999999999999/1000000000001", "1/2000000", 0, "1/2")
ADVERSARIAL: dict[str, tuple[Clebsch, State]] = {
    # 1 - k^2 is about 1e-30 and 1e-60 beside a homoclinic and a heteroclinic motion.
    "beside falling": (beside(falling(PLAIN, FALLING), A_BIT), FALLING),
    "beyond falling": (beside(falling(body(*EVEN.split()), FALLING), -(A_BIT**2)), FALLING),
    "beside the border": (beside(at_the_border(STOUT, FALLING), A_BIT), FALLING),
    "falling, far out": (falling(PLAIN, FAR_OUT), FAR_OUT),
} | {
    name: (body(*six.split()), exact(start))
    for name, six, start in [
        ("beside heteroclinic", COUPLED, f"3/5 0 4/5 0 3/5 {TINY}"),
        ("beside steady", SHARP, f"{TINY} 0 1 0 {TINY} 3"),
        ("p' nearly p", f"1 {OVER} 1/10 3/10 1 1/2", GENERIC),
        ("p' nearly p, below", f"1 {SHY} 1/10 3/10 1 1/2", GENERIC),
        ("q' nearly q", f"1 2 {OVER} 1 3 2", GENERIC),
        ("both nearly", f"2 {2 * Fraction(OVER)} 1 {SHY} 1 3/2", GENERIC),
        ("q' nearly q, p' = p", f"2 2 1 {OVER} 1 3/2", GENERIC),
        ("nearly through the pole", BLUNT, f"3/5 0 4/5 1/3 1/7 {SHY}"),
        ("nearly through the lower pole", BLUNT, f"3/5 0 4/5 3 1/7 -{SHY}"),
        ("nearly from the axis", EVEN, f"{TINY} 0 1 1/3 1/7 1"),
        ("slender and heavy", "1e-6 1e6 0 0 1e-3 1e3", "1e-3 0 1e-6 1 1 1e-3"),
        ("weak impulse", SHARP, "1e-12 2e-12 -1e-12 1/3 1/7 1"),
        ("no G", SHARP, "1 0 0 0 1/3 1/4"),
        ("no x3", BLUNT, "1 1/2 0 1/5 1/3 1/4"),
        ("only y", BLUNT, "1 0 0 0 1 0"),
    ]
}


@pytest.mark.parametrize("name", by_turns(ADVERSARIAL, 8))
def test_difficult_bodies_are_solved(name: str) -> None:
    """Closed routes find what Taylor finds, and find the same after 1e6 units of time."""
    asked = whole(*ADVERSARIAL[name])
    routes = closed_routes(asked)
    assert all(is_taylors(asked, route, vector("3/2", -1)) for route in routes)
    times = vector("17/3", -100 if "falling" in name else -(10**6))
    balls = motion_by(asked, "arb", times)
    assert all(overlap(balls, motion_by(asked, route, times)) for route in routes[1:])


@pytest.mark.parametrize("name", ADVERSARIAL)
def test_difficult_bodies_settle_to_few_digits_and_to_many(name: str) -> None:
    """Three digits are not refused because the way there takes hundreds, and hold what 150 find."""
    times = vector(2, -100 if "falling" in name else -(10**12), Fraction(1, 10**100))
    few, many = (motion_by(whole(*ADVERSARIAL[name]), "arb", times, digits) for digits in (3, 150))
    assert overlap(few, many)


# What is decided in rationals.


@pytest.mark.parametrize("route", CLOSED_ROUTES)
def test_other_bodies_have_no_closed_form_here(route: str) -> None:
    """Loads, and an energy that is not of Clebsch's form, are declined with the reason."""
    asked = scene("two real roots")
    loaded = replace(asked, body=replace(asked.body, force=vector(0, 0, 1)))
    with pytest.raises(NoClosedForm, match="force or a couple"):
        solution(loaded, route)
    with pytest.raises(NoClosedForm, match="not of Clebsch's form"):
        solution(load("kirchhoff/general-body"), route)


# Broken twins: Taylor's motion agrees with the closed form, and with none of these. The sign of the phase
# is turned in test_broken_twins.


def lost_windings(monkeypatch: pytest.MonkeyPatch) -> None:
    """The principal argument instead of the continuous one."""

    def principal(quotient: acb, rough: arb) -> arb:
        return quotient.arg()

    monkeypatch.setattr(lattice, "nearest_turn", principal)


def no_advance(monkeypatch: pytest.MonkeyPatch) -> None:
    """The centre keeps its height along the impulse."""
    monkeypatch.setattr(Orbit, "_advances", lambda self, times, *rest: [arb(0)] * len(times))


def transposed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Space to body instead of body to space."""
    right = CayleyKlein.frame
    monkeypatch.setattr(
        CayleyKlein, "frame", lambda self: [list(row) for row in zip(*right(self), strict=True)]
    )


def no_rise(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without Z, which the impulses in space do not see."""
    monkeypatch.setattr(Rise, "at", lambda self, t, place: mpf(0))


def lost_periods(monkeypatch: pytest.MonkeyPatch) -> None:
    """An integral of the third kind that forgets its whole periods."""
    at = SquareIntegral.at
    monkeypatch.setattr(SquareIntegral, "at", lambda self, place: at(self, replace(place, turns=0)))


def fixed_chart(monkeypatch: pytest.MonkeyPatch) -> None:
    """Euler's theta kept in [0, pi]: wrong once the axis has passed the pole."""
    root = orbit.Pole.root

    def at_the_pole(pole: orbit.Pole, place: Any, weight: mpf) -> tuple[mpf, mpf]:
        size, slope = root(pole, place, weight)
        return abs(size), slope

    monkeypatch.setattr(orbit.Pole, "root", at_the_pole)


Twin = Callable[[pytest.MonkeyPatch], None]
# Each with the time up to which it is not wrong yet, where there is one.
TWINS: list[tuple[Twin, str, str, str | None]] = [
    (lost_windings, "arb", "two real roots", "1/10"),
    (no_advance, "arb", "two real roots", None),
    (transposed, "mpmath", "four real roots", None),
    (no_rise, "mpmath", "four real roots", None),
    (lost_periods, "mpmath", "four real roots", "1/10"),
    (fixed_chart, "mpmath", "through the pole", "1/10"),
]


@pytest.mark.parametrize(("twin", "route", "name", "unseen"), by_turns(TWINS, 3))
def test_a_broken_twin_is_noticed(
    twin: Twin, route: str, name: str, unseen: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Beyond a nutation each is; within half a turn some cannot be, and only a long time tells."""
    asked, times = scene(name), vector(3) if unseen is None else vector(3, 8)
    assert is_taylors(asked, route, times)
    twin(monkeypatch)
    assert not is_taylors(asked, route, times)
    assert unseen is None or is_taylors(asked, route, vector(unseen))
