"""Triaxial bodies under a constant moment along a principal axis."""

from __future__ import annotations

from fractions import Fraction

from mpmath import mp, mpf

from builders.numbers import apart
from builders.scenes import vector
from taylor_verify.exact.euler.moments.washboard.board import Washboard
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Clock, Motion, Spin
from taylor_verify.scenes.scene import Scene

DIGITS = 45
FRAME = (Fraction(1), Fraction(-2), Fraction(1, 3), Fraction(2))


def loaded(inertia: Matrix, moment: Vector, omega: Vector, attitude: bool = False) -> Scene:
    track = frozenset({"attitude"} if attitude else ())
    clock = Clock(Fraction(0), (Fraction(0), Fraction(1)))
    return Scene(
        "drawn", "drawn", "euler", track, RigidBody(inertia, moment), Spin(omega, FRAME), clock
    )


def axial(axis: int, push: str, omega: Vector) -> Scene:
    """Moments 1, 2, 3 about the axes 1, 2, 3, and M along one of them."""
    moment = tuple(Fraction(push) if i == axis else Fraction(0) for i in range(3))
    return loaded(tensors.diagonal(vector(1, 2, 3)), moment, omega)


def gap(one: Motion, other: Motion) -> mpf:
    """The largest distance of a row from its like, in parts of its norm."""
    with mp.workdps(3 * DIGITS):
        return apart(one, other)


def board(scene: Scene) -> Washboard:
    assert isinstance(scene.body, RigidBody)
    assert isinstance(scene.initial, Spin)
    return Washboard(scene.body.inertia, scene.body.moment, scene.initial.omega)
