"""Closed forms of the shipped scenes: after a billion periods, and at times that are balls."""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np
import pytest
from builders.routes import has_route
from builders.scenes import everything
from builders.turns import by_turns
from flint import arb, ctx
from mpmath import mp, mpf

from taylor_verify.exact.balls import Enclosed
from taylor_verify.exact.elements import elements
from taylor_verify.exact.kirchhoff.closed import case
from taylor_verify.exact.kirchhoff.quartic import Nutation
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import NO_CLOSED_FORM
from taylor_verify.numbers.irrational import ball
from taylor_verify.numbers.precision import exact_value
from taylor_verify.scenes.library import EXTREMES, WORST, names
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

DIGITS = 40
PERIODS = 10**9
# 1e9 periods of 60 digits are known to 1e-51 of one.
PERIOD_DIGITS = 60


def closed_scenes() -> list[str]:
    """Return all but damped motions, which never recur."""
    shipped = [name for name in names() if name.startswith(("euler/", "kirchhoff/"))]
    return [name for name in shipped if recurs(load(name))]


def recurs(scene: Scene) -> bool:
    exact = solution(scene)
    return exact.regime != NO_CLOSED_FORM and not scene.body.damping


def period(scene: Scene) -> Fraction | None:
    """By complete integrals in mpmath, not by the lattice of the balls; None where there is none."""
    orbit = elements(scene, PERIOD_DIGITS)
    return exact_value(orbit["period"].value) if "period" in orbit else None


def recurring(motion: Motion, row: int, scene: Scene) -> list[Any]:
    """Return what a period brings back: omega, or x along the axis of symmetry and the lengths of x and y.

    About another origin y has another length, and a body without an axis is not asked for more than |x|.
    """
    if "omega" in motion.quantities:
        return list(motion["omega"][row])
    x, y = motion["linear_impulse"][row], motion["angular_impulse"][row]
    exact, length = case(scene), mp.norm(list(x))
    if isinstance(exact.subject, Nutation) and not exact.subject.axes.is_upright:
        n = exact.subject.axes.n
        along = sum(mp.convert(a) * b for a, b in zip(n, x, strict=True))
        return [along / mp.norm([mp.convert(a) for a in n]), length, mp.norm(list(y))]
    if exact.reduced.words:
        return [length]
    axis = (scene.body.axis_of_symmetry or 3) - 1
    return [x[axis], length, mp.norm(list(y))]


def missed(scene: Scene, span: Fraction) -> mpf:
    """How far from its start the motion is after this time, in parts of omega or of the impulses."""
    motion = solution(scene).motion([Fraction(0), span], DIGITS)
    assert all(radius <= mpf(10) ** -DIGITS for radius in motion.radius)
    with mp.workdps(PERIOD_DIGITS):
        start, end = (np.array(recurring(motion, row, scene), dtype=object) for row in (0, 1))
        scale = mp.norm(list(start))
        return mp.norm(list(end - start)) / scale if scale else mp.norm(list(end))


# Two vectors of 40 digits; for each, what its length and its component may be off by.
RETURNS = 4 * mpf(10) ** -DIGITS


@pytest.mark.parametrize("name", by_turns(closed_scenes()))
def test_a_billion_periods_keep_forty_digits(name: str) -> None:
    """Every shipped closed form, all that it tracks; 1e9 units of time where there is no period."""
    scene = load(name)
    exact, once = solution(scene), period(scene)
    if once is not None:
        assert missed(scene, PERIODS * once) <= RETURNS
    else:
        motion = exact.motion([Fraction(PERIODS), -Fraction(PERIODS)], DIGITS)
        assert all(radius <= mpf(10) ** -DIGITS for radius in motion.radius)


@pytest.mark.slow
def test_no_extreme_scene_is_too_far() -> None:
    """Nor does any of the extremes with a closed form lose a digit: forty are proven of all of them."""
    is_answered = False
    for name in names(EXTREMES, WORST):
        scene = load(name)
        exact = solution(scene)
        if exact.regime != NO_CLOSED_FORM:
            (radius,) = exact.motion([PERIODS * (period(scene) or Fraction(1))], DIGITS).radius
            assert radius <= mpf(10) ** -DIGITS, name
            is_answered = True
    assert is_answered


@pytest.mark.parametrize("name", ["euler/generic", "kirchhoff/whole-motion"])
def test_a_period_wrong_in_its_45th_digit_is_noticed(name: str) -> None:
    """A billion times 1e-45 of a period is 1e-36, ten thousand times what is allowed."""
    scene = load(name)
    once = period(scene)
    assert once is not None
    off = once * (1 + Fraction(1, 10**45))
    assert not missed(scene, PERIODS * off) <= RETURNS


# Times that are balls


@cache
def free_forms() -> list[str]:
    """The shipped scenes without loads and wheels that have a closed form."""
    forms = []
    for name in names():
        scene = load(name)
        body = scene.body
        if body.is_free and not body.damping and "gyrostat" not in name:
            forms += [name] * has_route(scene, "arb")
    return forms


def all_that_is_closed(scene: Scene) -> Scene:
    """The scene with all that its closed form knows."""
    whole = everything(scene)
    return whole if has_route(whole, "arb") else scene


@pytest.mark.parametrize("name", free_forms())
def test_a_wide_ball_of_time_contains_the_motion_at_its_ends(name: str) -> None:
    """The enclosure at the ball 1/3 +- 1/1000 overlaps those at both of its ends and at its middle."""
    inner = solution(all_that_is_closed(load(name)), "arb")
    assert isinstance(inner, Enclosed)
    middle, reach = Fraction(1, 3), Fraction(1, 1000)
    with ctx.workprec(160):
        wide = inner.enclose([ball(middle) + arb(0, ball(reach))], 160)
        for t in (middle - reach, middle, middle + reach):
            narrow = inner.enclose([t], 160)
            for name, rows in narrow.items():
                pairs = zip(flat(wide[name][0]), flat(rows[0]), strict=True)
                assert all(one.is_finite() and one.overlaps(other) for one, other in pairs)


def flat(row: Any) -> list[Any]:
    """The entries of a vector or a matrix."""
    return [entry for part in row for entry in flat(part)] if hasattr(row, "__len__") else [row]
