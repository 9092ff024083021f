"""The scenes to begin with: what makes each of them tell a usual mistake in its first row."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from itertools import permutations

import pytest

from taylor_verify.numbers import tensors
from taylor_verify.numbers.rotation import rotation_matrix
from taylor_verify.numbers.tensors import Matrix, Vector
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
