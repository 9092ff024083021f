"""The shipped scenes under loads: complete, and the motions that their sources published."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from mpmath import mp

import taylor_verify as tv
from taylor_verify.scenes import library
from taylor_verify.scenes.reading.reader import load

# What people simulate: heavy tops, satellites, vehicles, bodies in air and water.
EXPECTED = {
    "lagrange-top",
    "kovalevskaya-top",
    "heavy-top",
    "pitch-libration",
    "gravity-gradient",
    "eccentric-orbit",
    "magnetic-torquing",
    "pd-thrusters",
    "pd-wheels",
    "pid",
    "wheel-saturation",
    "thruster-pulses",
    "sampled-controller",
    "vehicle-depth",
    "vehicle-weight-low",
    "vehicle-drag-thrust",
    "vehicle-in-a-current",
    "falling-plate",
    "rocket",
    "gz-added-mass",
    "nasa-brick-damped",
}
DEGREE = np.pi / 180


def test_every_motion_that_people_simulate_is_shipped() -> None:
    """The folder has these scenes, no fewer and no others, so that a missing one fails."""
    assert set(library.names("loads")) == {f"loads/{name}" for name in EXPECTED}


@pytest.mark.parametrize("name", sorted(EXPECTED))
def test_a_loaded_scene_names_its_source_and_what_it_tells(name: str) -> None:
    """Each scene has a source, and a sentence that begins with the word Tells."""
    text = library.find(f"loads/{name}").read_text(encoding="utf-8")
    comment = " ".join(line.lstrip("# ") for line in text.splitlines() if line.startswith("#"))
    assert load(f"loads/{name}").source
    assert ". Tells whether " in comment


# The end states of added_mass.cc in gz-sim, after one second: centre, angle and axis of the attitude,
# velocity and angular velocity in space axes; and its tolerances.
GZ = {
    "1": (
        (0.1615036362557803, 0.10710173528687592, -0.0024940422102210013),
        0.31351100787675423,
        (0.9487133476959254, 0.2967465880246766, -0.10901580802481375),
        (0.32087488227940963, 0.212772641112832, -0.010283659814296216),
        (0.0031500380024329826, 0.0022451901112414984, -0.052564274312245286),
    ),
    "0.1": (
        (0.19339397146633158, 0.18238590690754014, -0.0006146904921505786),
        0.3185857744101227,
        (0.9309057658841812, 0.3615623345327693, -0.051837566405069514),
        (0.386607475883442, 0.36477533916100213, -0.002544369239292084),
        (0.0005006537195657914, 0.0007044864197475587, -0.012889587224151892),
    ),
    "10": (
        (0.0616809222579082, 0.020951194425796703, -0.0006836779301496875),
        0.2990323477528498,
        (0.992866493007573, 0.11317163977508175, -0.03752741682373132),
        (0.12296544056644206, 0.04157265120194949, -0.002832810385198371),
        (0.0017159692398096078, 0.00022402938638815302, -0.014274584996716126),
    ),
}
CENTRE, ANGLE, AXIS, VELOCITY, RATE = 1e-3, 1e-5, 1e-4, 1e-5, 1e-4
ADDED = ("236.14304779483277", "901.6370915802705", "64.40264939859075")


@pytest.mark.parametrize("density", GZ)
def test_the_published_states_of_gz_sims_test_are_its_motion(density: str, tmp_path: Path) -> None:
    """Bodies 1, 2 and 3 of that test, in fluids of 1, 0.1 and 10 times the density of the body, end
    within its tolerances of the states that it expects."""
    text = library.find("loads/gz-added-mass").read_text(encoding="utf-8")
    for number in ADDED:
        text = text.replace(number, str(float(number) * float(density)))
    scene = tmp_path / "body.toml"
    scene.write_text(text, encoding="utf-8")
    motion = tv.exact(str(scene), [1], digits=12)
    R, centre = (np.array(motion[name][0], dtype=float) for name in ("attitude", "centre"))
    body = load(str(scene)).body
    impulse = [*motion["linear_impulse"][0], *motion["angular_impulse"][0]]
    velocities = np.array(body.energy_matrix, dtype=float) @ np.array(impulse, dtype=float)
    U, Omega = R @ velocities[:3], R @ velocities[3:]
    angle = np.arccos((np.trace(R) - 1) / 2)
    axis = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / (2 * np.sin(angle))
    expected = GZ[density]
    assert np.linalg.norm(centre - expected[0]) <= CENTRE
    assert abs(angle - expected[1]) <= ANGLE
    assert np.linalg.norm(axis - expected[2]) <= AXIS
    assert np.linalg.norm(U - expected[3]) <= VELOCITY
    assert np.linalg.norm(Omega - expected[4]) <= RATE


# Rates in deg/s of simulations 2 and 4 of NASA's check case 3, which have the density of the height
# above the geoid, at 1 s, 5 s and 9.8 s.
NASA = {
    "1": ((4.104765, 21.849667, 28.071732), (4.104876, 21.849796, 28.071862)),
    "5": ((-4.133840, 3.189336, 21.723567), (-4.134981, 3.190209, 21.724972)),
    "9.8": ((-0.146120, -0.054174, 8.866398), (-0.146261, -0.054254, 8.868763)),
}


@pytest.mark.parametrize("time", NASA)
def test_the_published_rates_of_the_damped_brick_are_its_motion(time: str) -> None:
    """The exact motion is no farther from either of two simulations of NASA than they are apart, or
    than the thousandth that the speed of the fall leaves out."""
    omega = np.array(
        tv.exact("loads/nasa-brick-damped", [time], digits=12)["omega"][0], dtype=float
    )
    two = np.array(NASA[time])
    apart = np.linalg.norm(two[0] - two[1])
    for rates in two:
        left_out = 1e-3 * np.linalg.norm(rates)
        assert np.linalg.norm(omega / DEGREE - rates) <= apart + left_out


def test_kovalevskayas_integral_is_conserved() -> None:
    """|(w1 + i w2)^2 - (g1 + i g2)|^2 with g = R^T e3 keeps its value to the proven digits: no gate
    knows this integral, which holds for I1 = I2 = 2 I3 and the weight in the equator alone."""
    motion = tv.exact("loads/kovalevskaya-top", [0, 1, 2], digits=30)
    with mp.workdps(40):
        values = []
        for (w1, w2, _), R in zip(motion["omega"], motion["attitude"], strict=True):
            g1, g2 = R[2][0], R[2][1]
            values.append((w1 * w1 - w2 * w2 - g1) ** 2 + (2 * w1 * w2 - g2) ** 2)
        assert all(abs(value - values[0]) <= 1e-28 * values[0] for value in values)
