"""Ellipsoids without a fluid: Euler's top at the pace of an irrational mass."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest
from builders.numbers import apart
from builders.routes import motions_of_taylor
from builders.scenes import one_instant, vector
from mpmath import mp, mpf

from taylor_verify.exact.elements import elements
from taylor_verify.exact.route import solution
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.bodies import Ellipsoid
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.named_numbers import entrywise
from taylor_verify.scenes.scene import Scene

TIMES = [Fraction(0), Fraction(7, 3), Fraction(-2)]
X = vector("0.5", "-0.25", 1)
FRAME = (Fraction(1), Fraction(2), Fraction(-1), Fraction(3))


def ellipsoid(semi_axes: Vector, y: Vector, fluid: str = "0") -> Scene:
    body = Ellipsoid(semi_axes, Fraction(1, 50), Fraction(fluid)).body()
    start = Impulse(X, y, FRAME, vector(1, -2, "0.5"))
    return one_instant(body, start, "attitude", "centre")


@pytest.mark.parametrize(
    ("semi_axes", "y", "word"),
    [
        (vector(3, 2, 1), vector("0.5", "0.75", "-0.25"), "min-axis"),
        (vector(3, 2, 1), vector("0.2", "0.3", "1.5"), "max-axis"),
        (vector(4, 2, 1), vector("0.5", "-1.2", 2), "separatrix"),
        (vector(3, 2, 1), vector(0, "0.5", 0), "steady"),
        (vector(2, 2, 1), vector("0.5", "0.75", "-0.25"), "trigonometric"),
        (vector(2, 2, 2), vector("0.5", "0.75", "-0.25"), "trigonometric"),
    ],
)
def test_closed_routes_are_the_taylor_motion(semi_axes: Vector, y: Vector, word: str) -> None:
    """Impulses, attitude and centre, in every regime."""
    assert motions_of_taylor(ellipsoid(semi_axes, y), word, TIMES, 25)


@pytest.mark.parametrize(("factor", "word"), [(-1, "max-axis"), (0, "separatrix"), (1, "min-axis")])
def test_the_separatrix_is_decided_without_the_mass(factor: int, word: str) -> None:
    """y1 : y3 = 1 : 4, and 10^-160 more or less, beyond the digits of the rationals of the body."""
    little = Fraction(factor, 10**160)
    y = (Fraction(1, 2) + little, Fraction(-6, 5), Fraction(2))
    assert solution(ellipsoid(vector(4, 2, 1), y)).regime == word
    assert elements(ellipsoid(vector(4, 2, 1), y)).regime == word


def test_the_routes_agree_beyond_the_digits_of_the_rationals() -> None:
    """At 200 digits: nothing is rounded to the 120 that a solver gets."""
    times = [Fraction(2, 3), Fraction(-1, 2)]
    scene = ellipsoid(vector(3, 2, 1), vector("0.5", "0.75", "-0.25"))
    one, other = (solution(scene, route).motion(times, 200) for route in ("arb", "mpmath"))
    expected = solution(scene, "taylor").motion(times, 130)
    with mp.workdps(220):
        assert apart(one, other) <= 2 * mpf(10) ** -200
        assert apart(one, expected) <= 2 * mpf(10) ** -130


def test_the_elements_are_in_the_time_of_the_scene() -> None:
    """y recurs after one period, and not after the half of it; T is that of the body."""
    scene = ellipsoid(vector(3, 2, 1), vector("0.5", "0.75", "-0.25"))
    orbit = elements(scene, 30)
    period = Fraction(str(mp.nstr(orbit["period"].value, 30)))
    motion = solution(scene).motion([Fraction(0), period / 2, period], 25)
    with mp.workdps(40):
        y = motion["angular_impulse"]
        assert max(abs(entry) for entry in y[2] - y[0]) <= mpf(10) ** -23
        assert max(abs(entry) for entry in y[1] - y[0]) > 0.1
        assert orbit["rate"].value * orbit["flip_time"].value > 2
    rational = replace(scene, body=scene.body.changed(lambda _, part: entrywise(Fraction, part)))
    for name, element in elements(rational, 30).items():
        assert abs(orbit[name].value - element.value) <= mpf(10) ** -28 * abs(element.value)


def test_a_little_fluid_ends_it() -> None:
    """With a fluid of 10^-30 of its density an ellipsoid of three different axes has no closed form."""
    y = vector("0.5", "0.75", "-0.25")
    assert solution(ellipsoid(vector(3, 2, 1), y, "1e-30")).route == "taylor"
