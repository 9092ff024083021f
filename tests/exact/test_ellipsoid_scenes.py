"""What a scene makes of an ellipsoid: which body is solved, how it moves, what is told of it."""

from __future__ import annotations

from fractions import Fraction

import pytest
from mpmath import mp, mpf

from taylor_verify.exact.ellipsoid import sentences
from taylor_verify.exact.route import solution
from taylor_verify.models.problem import pose
from taylor_verify.numbers.precision import rung
from taylor_verify.numbers.tensors import cross, dot
from taylor_verify.records.faults import Refused
from taylor_verify.records.precisions import LADDER
from taylor_verify.scenes import library
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.reading.reader import load, read
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
