"""What a scene makes of an ellipsoid: which body is solved, how it moves, in a fluid and without."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest
from builders.numbers import apart, motions_of_taylor
from builders.scenes import one_instant, vector
from mpmath import mp, mpf

from taylor_verify.exact.elements import elements
from taylor_verify.exact.ellipsoid import sentences
from taylor_verify.exact.route import solution
from taylor_verify.models.problem import pose
from taylor_verify.numbers.precision import rung
from taylor_verify.numbers.tensors import Vector, cross, dot
from taylor_verify.records.faults import Refused
from taylor_verify.records.precisions import LADDER
from taylor_verify.scenes import library
from taylor_verify.scenes.bodies import Ellipsoid, ImmersedBody
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.named_numbers import entrywise
from taylor_verify.scenes.reading.reader import load, read
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.stand_in import STAND_IN_BITS, StandIn

SCENES = [
    name for name in library.names("kirchhoff") if "/ellipsoid-" in name or "-about-axis-" in name
]


@pytest.mark.parametrize("name", SCENES)
def test_shipped_ellipsoids_are_what_their_files_say(name: str) -> None:
    """Every shipped ellipsoid has its shape, the numbers that it means, and a sentence on its bits."""
    body = load(name).body
    assert isinstance(body, ImmersedBody)
    assert body.ellipsoid is not None
    for block, exact in (
        (body.linear, body.ellipsoid.inertias.masses),
        (body.angular, body.ellipsoid.inertias.moments),
    ):
        for i in range(3):
            number = block[i][i]
            assert isinstance(number, StandIn)
            assert number.exactly * exact[i] == 1
    text = " ".join(sentences(body))
    assert "The exact motion is that of these numbers themselves" in text
    assert f"with {STAND_IN_BITS} bits at most" in text


SPHEROIDS = {
    "kirchhoff/ellipsoid-prolate": 3,
    "kirchhoff/ellipsoid-disc": 3,
    "kirchhoff/oblate-about-axis-1": 1,
    "kirchhoff/prolate-about-axis-2": 2,
    "kirchhoff/ellipsoid-needle": 1,
}


@pytest.mark.parametrize("name", SPHEROIDS)
def test_a_spheroid_is_clebschs_body_on_every_rung(name: str) -> None:
    """Rounding leaves the axis of symmetry, the closed form and the motion's regime what they are."""
    scene = load(name)
    regime = solution(scene, "arb").regime
    for rung_name in LADDER:
        given_to_solver = pose(scene, rung(rung_name)).given
        assert isinstance(given_to_solver.body, ImmersedBody)
        assert given_to_solver.body.axis_of_symmetry == SPHEROIDS[name]
        assert given_to_solver.body.ellipsoid is None
        assert solution(given_to_solver, "arb").regime == regime


def test_in_a_sphere_y_stays_and_x_turns_about_it() -> None:
    """x(t) is x(0) turned about y by the angle -r |y| t, and y does not change."""
    scene = load("kirchhoff/ellipsoid-sphere")
    x, y, t = scene.initial.linear, scene.initial.angular, Fraction(19, 4)
    motion = solution(scene).motion([t], 40)
    with mp.workdps(50):
        size = mp.sqrt(mp.convert(dot(y, y)))
        turn = -mp.convert(scene.body.angular[0][0] * t) * size
        share, across = mp.convert(dot(x, y)) / size**2, cross(y, x)
        for i in range(3):
            along = share * mp.convert(y[i])
            rest, aside = mp.convert(x[i]) - along, mp.convert(across[i]) / size
            expected = along + mp.cos(turn) * rest + mp.sin(turn) * aside
            # 40 digits of vectors of size one were asked for, and 2 are given for their sizes.
            assert abs(motion["linear_impulse"][0][i] - expected) <= mpf(10) ** -38
            assert abs(motion["angular_impulse"][0][i] - mp.convert(y[i])) <= mpf(10) ** -38


def test_all_faults_of_an_ellipsoid_are_told_at_once() -> None:
    """Two axes, a density and an unknown key give four lines, and no coefficients are formed."""
    text = (library.cases_directory() / "kirchhoff/ellipsoid-neutral.toml").read_text()
    wrong = "{ semi_axes = [0, 2, -1], density = -1, fluid_density = 1, mass = 3 }"
    right = "{ semi_axes = [3, 2, 1], density = 1, fluid_density = 1 }"
    assert right in text
    with pytest.raises(Refused) as caught:
        read(text.replace(right, wrong), "wrong")
    assert [fault.rpartition(" @ ")[2].partition(" ")[0] for fault in caught.value.faults] == [
        "body.ellipsoid.semi_axes[0]",
        "body.ellipsoid.semi_axes[2]",
        "body.ellipsoid.density",
        "body.ellipsoid.mass",
    ]


# Without a fluid

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
