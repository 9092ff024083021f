"""A body that keeps its axis under a constant moment, in balls, against the enclosure."""

from __future__ import annotations

from fractions import Fraction

import pytest
from builders.free_spins import rotation
from builders.numbers import apart as distance
from builders.scenes import one_instant, vector
from mpmath import mp, mpf

from taylor_verify.exact.elements import elements
from taylor_verify.exact.kirchhoff.solid import short_digits
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import NO_CLOSED_FORM, NoClosedForm
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Impulse, Motion, Spin
from taylor_verify.scenes.scene import Scene

DIGITS = 40
ONE, TWO = Fraction(1), Fraction(2)
FRAME = (ONE, Fraction(-2), Fraction(1, 3), TWO)


def loaded(inertia: Matrix, moment: Vector, omega: Vector, attitude: bool = False) -> Scene:
    track = ("attitude",) if attitude else ()
    return one_instant(RigidBody(inertia, moment), Spin(omega, FRAME), *track)


def apart(one: Motion, other: Motion) -> mpf:
    """The largest distance of a row from its like, in parts of its norm."""
    with mp.workdps(3 * DIGITS):
        return distance(one, other)


# What two numbers of so many digits may differ by.
BOTH = 2 * mpf(10) ** -DIGITS


# What keeps its axis.

TRIAXIAL = tensors.diagonal(vector(1, 2, 3))


def balanced(inertia: Matrix, omega: Vector) -> Scene:
    """The body under the moment that its gyroscopic one balances."""
    moment = tensors.cross(omega, tensors.apply(inertia, omega))
    return loaded(inertia, moment, omega, attitude=True)


def turned(scene: Scene) -> Scene:
    """The scene in axes that are not principal: body and motion are the same."""
    assert isinstance(scene.body, RigidBody)
    assert isinstance(scene.initial, Spin)
    turn = rotation(1, 2, -1, 3)
    inertia = tensors.product(tensors.product(turn, scene.body.inertia), tensors.transpose(turn))
    moment, omega = (tensors.apply(turn, v) for v in (scene.body.moment, scene.initial.omega))
    return loaded(inertia, moment, omega, attitude=True)


STEADY = balanced(TRIAXIAL, vector(1, "2/3", "1/2"))
STRAIGHT = loaded(TRIAXIAL, vector(0, "1/3", 0), vector(0, -1, 0), attitude=True)
REVOLVED = tensors.diagonal(vector(1, 1, 2))


@pytest.mark.parametrize(
    ("scene", "word"),
    [
        (STEADY, "steady-moment"),
        (turned(STEADY), "steady-moment"),
        (STRAIGHT, "straight-moment"),
        (turned(STRAIGHT), "straight-moment"),
        (loaded(REVOLVED, vector(0, 0, "1/3"), vector(0, 0, -1), attitude=True), "straight-moment"),
        (loaded(REVOLVED, vector("1/3", 1, 0), vector(0, 0, 0), attitude=True), "straight-moment"),
    ],
)
def test_a_fixed_axis_has_its_attitude_too(scene: Scene, word: str) -> None:
    """omega constant, or growing along its own axis: R by Taylor, from a start that is not 1."""
    exact, times = solution(scene, "arb"), [Fraction(0), Fraction(13, 2), Fraction(-4)]
    assert exact.regime == word == elements(scene, 15).regime
    expected = TaylorSolution(scene).motion(times, DIGITS)
    assert set(expected.quantities) == {"omega", "attitude"}
    assert apart(exact.motion(times, DIGITS), expected) <= BOTH


def test_a_moment_that_turns_the_axis_leaves_no_closed_form() -> None:
    """Both closed routes refuse, and the enclosure takes over under the word for it."""
    for moment in (vector(0, 1, 1), vector(1, 0, 0), vector("1e-300", 0, "1/3")):
        scene = loaded(REVOLVED, moment, vector(0, 0, 1))
        for route in ("arb", "mpmath"):
            with pytest.raises(NoClosedForm, match="a constant moment turns the axis"):
                solution(scene, route)
        assert solution(scene).route == "taylor"
        assert solution(scene).regime == elements(scene).regime == NO_CLOSED_FORM


@pytest.mark.parametrize("faster", [1, 1000, Fraction(1, 1000)])
def test_the_digits_of_a_short_way_do_not_depend_on_the_unit_of_time(faster: Fraction) -> None:
    """A way of 1e-9 beside a lever of 1: nine digits, in seconds as in milliseconds."""
    start = Impulse(vector(1, 0, 0), vector(0, 1, 0))
    U, time = vector(Fraction(faster, 1000), 0, 0), Fraction(1, 10**6) / faster
    assert short_digits(U, start, [time]) == 9
