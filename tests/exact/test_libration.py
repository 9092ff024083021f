"""Pitch on a circular orbit: the closed form by two routes, each inside the enclosure of the equations."""

from __future__ import annotations

from fractions import Fraction

import pytest
from builders.routes import motions_of_taylor
from builders.scenes import read_scene
from builders.turns import by_turns
from mpmath import mp, mpf

from taylor_verify.exact.elements import elements
from taylor_verify.exact.euler.libration import pitch_of
from taylor_verify.exact.route import solution
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

DIGITS = 25
TIMES = [Fraction(1, 3), Fraction(5), Fraction(-3, 2)]


def orbiting(**changed: str) -> Scene:
    """A satellite under gravity gradient, whose axis 3 is the normal of the orbit."""
    given = {
        "inertia": "[1, 2, 3]", "o": '["cos(n*t)", "sin(n*t)", 0]', "omega": "[0, 0, 0.6]",
        "attitude": "[1, 0, 0, 0.3]", "more": "", "first": "3*n^2*(I33 - I22)*o2*o3",
        "last": "3*n^2*(I22 - I11)*o1*o2",
    } | changed  # fmt: skip
    moment = f'["{given["first"]}", "3*n^2*(I11 - I33)*o3*o1", "{given["last"]}"]'
    return read_scene(
        f"inertia = {given['inertia']}\nmoment = {moment}\n{given['more']}",
        f"omega = {given['omega']}\nattitude = {given['attitude']}",
        f'[define]\nn = "1/2"\n[space]\no = {given["o"]}',
        top='track = ["attitude"]',
    )


ALONG_1 = {"inertia": "[2, 1, 1.5]", "o": '[0, "cos(n*t)", "sin(n*t)"]', "omega": "[0.4, 0, 0]"}
PITCHING = {
    "about the vertical": ("planar-swing", {}),
    "about the other end": ("planar-swing", {"attitude": "[0.2, 0, 0, 1]"}),
    "upside down": ("planar-swing", {"attitude": "[0, 1, 0.3, 0]", "omega": "[0, 0, -0.6]"}),
    "on an orbit the other way": (
        "planar-swing",
        {"o": '["cos(n*t)", "-sin(n*t)", 0]', "omega": "[0, 0, -0.3]"},
    ),
    "about axis 1": ("planar-swing", {**ALONG_1, "attitude": "[1, 0.4, 0, 0]"}),
    "over and over": ("planar-turn", {"omega": "[0, 0, 3]"}),
    "towards the horizontal": ("planar-front", {"omega": "[0, 0, 1]", "attitude": "[1, 0, 0, 0]"}),
    "upright": ("planar-steady", {"omega": "[0, 0, 0.5]", "attitude": "[1, 0, 0, 0]"}),
    "level": ("planar-steady", {"omega": "[0, 0, 0.5]", "attitude": "[1, 0, 0, 1]"}),
}


@pytest.mark.parametrize("name", by_turns(PITCHING, 9, lambda name: PITCHING[name][0]))
def test_closed_routes_are_the_enclosed_motion(name: str) -> None:
    """Angular velocity and attitude, in every regime, about each end and each axis."""
    word, changed = PITCHING[name]
    scene = orbiting(**changed)
    assert elements(scene).regime == word
    assert motions_of_taylor(scene, word, TIMES, DIGITS)


def test_the_shipped_scene_swings_once_in_the_period_that_is_printed() -> None:
    """After its period the satellite is where the orbit alone would have turned it."""
    scene = load("loads/pitch-libration")
    period = elements(scene, 20)["period"].value
    after = solution(scene).motion([Fraction(int(period * 10**12), 10**12)], 15)["omega"][0]
    assert abs(after[2] - mpf("0.0011")) < mpf(10) ** -14


@pytest.mark.parametrize(
    "changed",
    [
        {"attitude": "[1, 0.3, 0, 0]"},
        {"omega": "[1e-9, 0, 0.6]"},
        {"inertia": "[[1, 0, 0.1], [0, 2, 0], [0.1, 0, 3]]"},
        {"o": '["cos(n*t)", "sin(2*n*t)", 0]'},
        {"o": '["cos(n*t)", "1.001*sin(n*t)", 0]'},
        {"o": '["cos(n*t)", "sin(n*t)", 1e-9]'},
        {"o": '["cos(n*t + 1e-9)", "sin(n*t)", 0]'},
        {"last": "3*n^2*(I22 - I11)*o1*o2 + 1e-9*o1"},
        {"first": "1e-9*o1"},
        {"more": 'damping = "1e-9"'},
        {"more": "weight = { force = [0, 0, 1], at = [0.1, 0, 0] }"},
    ],
)
def test_whatever_is_no_such_moment_has_no_closed_form(changed: dict[str, str]) -> None:
    """A moment that leaves the plane by a part in 10^9, or reads another angle, is none."""
    assert pitch_of(orbiting(**changed)) is None


def test_from_an_attitude_that_is_not_rational_the_motion_is_enclosed() -> None:
    """A turn of 0.3 rad has no rational matrix: there is no closed form, and the route is proven."""
    scene = read_scene(
        'inertia = [1, 1, 2]\nmoment = ["sin(t)", 0, 0]',
        "omega = [1, 0, 0]\nrotation_vector = [0.3, 0.2, 0.1]",
    )
    exact = solution(scene)
    assert exact.route == "taylor"
    (row,) = exact.motion([Fraction(1)], DIGITS)["omega"]
    assert abs(row[0] - 2 + mp.cos(1)) < mpf(10) ** -15
