"""Shipped scenes: those to begin with tell usual mistakes, those under loads move as published."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from itertools import permutations

import numpy as np
import pytest
from mpmath import mp

import taylor_verify as tv
from taylor_verify.numbers import tensors
from taylor_verify.numbers.rotation import rotation_matrix
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.scenes import library
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import IDENTITY, Quaternion, Spin
from taylor_verify.scenes.reading.reader import load

# A tenth of omega is told from it in any file.
VISIBLE = Fraction(1, 10)


def start() -> tuple[Matrix, Vector, Quaternion]:
    scene = load("euler/oblique-start")
    assert isinstance(scene.body, RigidBody)
    assert isinstance(scene.initial, Spin)
    assert scene.track == {"attitude"}
    return scene.body.inertia, scene.initial.omega, scene.initial.attitude


def distance(a: Vector, b: Vector) -> Fraction:
    """The largest difference of a component."""
    return max(abs(p - q) for p, q in zip(a, b, strict=True))


def flat(m: Matrix) -> Vector:
    return tuple(entry for row in m for entry in row)


def test_the_first_scene_has_a_full_tensor_and_a_unit_quaternion() -> None:
    """No product of inertia is zero, no component of the start is, and the quaternion has length one."""
    inertia, omega, q = start()
    assert all(flat(inertia) + omega + q)
    assert tensors.dot(q, q) == 1
    assert all(flat(rotation_matrix(q)))


MISTAKES: dict[str, Callable[[Quaternion], Quaternion]] = {
    "the conjugate": lambda q: (q[0], -q[1], -q[2], -q[3]),
    "the scalar last": lambda q: (q[1], q[2], q[3], q[0]),
    "the scalar taken from the end": lambda q: (q[3], q[0], q[1], q[2]),
    "the identity": lambda _: IDENTITY,
}


@pytest.mark.parametrize("mistake", MISTAKES.values(), ids=MISTAKES)
def test_a_mistaken_quaternion_is_another_attitude_in_the_first_row(
    mistake: Callable[[Quaternion], Quaternion],
) -> None:
    """The conjugate, either order of the components and no attitude at all show at once."""
    _, _, q = start()
    assert distance(flat(rotation_matrix(mistake(q))), flat(rotation_matrix(q))) > VISIBLE


def test_axes_are_told_apart_in_the_first_row() -> None:
    """omega in space axes, by R or its transpose, and in permuted axes is another vector at the start;
    from the identity attitude the first of these is the same one."""
    _, omega, q = start()
    R = rotation_matrix(q)
    assert distance(tensors.apply(R, omega), omega) > VISIBLE
    assert distance(tensors.apply(tensors.transpose(R), omega), omega) > VISIBLE
    assert tensors.apply(rotation_matrix(IDENTITY), omega) == omega
    for order in permutations(range(3)):
        permuted = tuple(omega[i] for i in order)
        assert order == (0, 1, 2) or distance(permuted, omega) > VISIBLE


def test_a_mistaken_tensor_is_another_angular_acceleration_at_once() -> None:
    """A tensor cut to its diagonal, or with the products' sign turned, changes omega' at the start."""
    inertia, omega, _ = start()
    diagonal = tensors.diagonal(tuple(inertia[i][i] for i in range(3)))
    opposite = tuple(
        tuple(2 * d - e for d, e in zip(*rows, strict=True))
        for rows in zip(diagonal, inertia, strict=True)
    )
    right = acceleration(inertia, omega)
    for wrong in (diagonal, opposite):
        assert distance(acceleration(wrong, omega), right) > VISIBLE * max(map(abs, right))


def acceleration(inertia: Matrix, omega: Vector) -> Vector:
    """I^-1 (I omega x omega)."""
    momentum = tensors.apply(inertia, omega)
    return tensors.apply(tensors.inverse(inertia), tensors.cross(momentum, omega))


# Under loads

DEGREE = np.pi / 180


@pytest.mark.parametrize("name", library.names("loads"))
def test_a_loaded_scene_names_its_source_and_what_it_tells(name: str) -> None:
    """Each scene has a source, and a sentence that begins with the word Tells."""
    text = library.find(name).read_text(encoding="utf-8")
    comment = " ".join(line.lstrip("# ") for line in text.splitlines() if line.startswith("#"))
    assert load(name).source
    assert ". Tells whether " in comment


# The end state of added_mass.cc in gz-sim, after one second: centre, angle and axis of the attitude,
# velocity and angular velocity in space axes; and its tolerances.
GZ = (
    (0.1615036362557803, 0.10710173528687592, -0.0024940422102210013),
    0.31351100787675423,
    (0.9487133476959254, 0.2967465880246766, -0.10901580802481375),
    (0.32087488227940963, 0.212772641112832, -0.010283659814296216),
    (0.0031500380024329826, 0.0022451901112414984, -0.052564274312245286),
)
CENTRE, ANGLE, AXIS, VELOCITY, RATE = 1e-3, 1e-5, 1e-4, 1e-5, 1e-4


def test_the_published_state_of_gz_sims_test_is_its_motion() -> None:
    """Body 1 of that test, in a fluid of its own density, ends within its tolerances of the state that it
    expects."""
    scene = "loads/gz-added-mass"
    motion = tv.exact(scene, [1], digits=12)
    R, centre = (np.array(motion[name][0], dtype=float) for name in ("attitude", "centre"))
    body = load(scene).body
    impulse = [*motion["linear_impulse"][0], *motion["angular_impulse"][0]]
    velocities = np.array(body.energy_matrix, dtype=float) @ np.array(impulse, dtype=float)
    U, Omega = R @ velocities[:3], R @ velocities[3:]
    angle = np.arccos((np.trace(R) - 1) / 2)
    axis = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / (2 * np.sin(angle))
    assert np.linalg.norm(centre - GZ[0]) <= CENTRE
    assert abs(angle - GZ[1]) <= ANGLE
    assert np.linalg.norm(axis - GZ[2]) <= AXIS
    assert np.linalg.norm(U - GZ[3]) <= VELOCITY
    assert np.linalg.norm(Omega - GZ[4]) <= RATE


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
