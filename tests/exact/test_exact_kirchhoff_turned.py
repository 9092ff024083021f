"""Clebsch's body about body axis 1 or 2: the closed forms in axes about it, against Taylor."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from mpmath import mp, mpf

from taylor_verify.exact.elements import elements
from taylor_verify.exact.invariants import invariants
from taylor_verify.exact.kirchhoff.axes import UPRIGHT, clebsch_about
from taylor_verify.exact.kirchhoff.closed import closed_form, enclosed
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import NO_CLOSED_FORM, NoClosedForm
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.scenes.bodies import Clebsch, ImmersedBody
from taylor_verify.scenes.motion import Clock, Impulse
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import diagonal

WHOLE = frozenset({"attitude", "centre"})
TIMES = [Fraction(-3, 2), Fraction(0), Fraction(7, 2)]
CLOCK = Clock(Fraction(0), tuple(TIMES))
# Every motion but the generic ones has a closed form of its own.
BODIES = {
    "four-roots": ("1", "2", "0.2", "0.5", "1.1", "0.7"),
    "two-roots": ("1.5", "0.8", "0.1", "0.4", "1", "1.25"),
    "cubic": ("1.2", "1.2", "0.1", "0.3", "0.9", "0.8"),
    "trigonometric": ("1.2", "1.2", "0.3", "0.3", "0.9", "0.8"),
}
START = Impulse(
    tuple(map(Fraction, ("0.6", "-0.4", "0.5"))),
    tuple(map(Fraction, ("0.2", "0.3", "0.8"))),
    (Fraction(1), Fraction(2), Fraction(-1), Fraction(3)),
    tuple(map(Fraction, ("2", "-1", "0.5"))),
)


def about(axis: int, six: tuple[str, ...], start: Impulse = START) -> Scene:
    """A body with these coefficients across and along one body axis."""
    p, p_prime, q, q_prime, r, r_prime = map(Fraction, six)

    def block(across: Fraction, along: Fraction) -> tuple[tuple[Fraction, ...], ...]:
        return diagonal(tuple(along if i == axis - 1 else across for i in range(3)))

    body = ImmersedBody(block(p, p_prime), block(q, q_prime), block(r, r_prime))
    return Scene("test", "test", "kirchhoff", WHOLE, body, start, CLOCK)


@pytest.mark.parametrize("axis", [1, 2])
@pytest.mark.parametrize("kind", BODIES)
def test_motion_about_another_axis_is_that_of_the_taylor_recursion(kind: str, axis: int) -> None:
    """Impulses, attitude and path agree, by both closed routes, with what knows the equations alone."""
    scene = about(axis, BODIES[kind])
    truth = TaylorSolution(scene).motion(TIMES, 30)
    for route in ("arb", "mpmath"):
        exact = solution(scene, route)
        assert (exact.regime, exact.route) == (kind, route)
        motion = exact.motion(TIMES, 30)
        with mp.workdps(40):
            for name, rows in truth.quantities.items():
                # Each of the two is promised to 30 digits of every vector and matrix.
                for row, other in zip(motion[name], rows, strict=True):
                    size = mp.norm(list(other.flat))
                    assert mp.norm(list((row - other).flat)) <= 2 * mpf(10) ** -30 * size


@pytest.mark.parametrize("axis", [1, 2])
def test_the_start_is_the_scenes_own(axis: int) -> None:
    """At time 0 every component stands where the scene wrote it."""
    scene = about(axis, BODIES["cubic"])
    motion = solution(scene).motion([Fraction(0)], 30)
    with mp.workdps(35):
        for name, start in (("linear_impulse", START.linear), ("angular_impulse", START.angular)):
            assert np.all(abs(motion[name][0] - [mp.convert(c) for c in start]) <= mpf(10) ** -29)
        assert np.all(abs(motion["centre"][0] - [2, -1, mpf("0.5")]) <= mpf(10) ** -28)


@pytest.mark.parametrize("axis", [1, 2])
def test_the_orbit_is_told_of_its_own_axis(axis: int) -> None:
    """Period and range are those of the body about axis 3; x3, y3 and the axis have other names."""
    scene = about(axis, BODIES["four-roots"])
    # A cyclic change of names mirrors nothing.
    linear, angular = (v[axis:] + v[:axis] for v in (START.linear, START.angular))
    named_anew = about(3, BODIES["four-roots"], replace(START, linear=linear, angular=angular))
    orbit, other = elements(scene), elements(named_anew)
    assert orbit.regime == other.regime == "four-roots"
    assert orbit["period"].value == other["period"].value
    assert orbit[f"x{axis}_low"].value == other["x3_low"].value
    text = " ".join([*orbit.sentences, *orbit, *(element.meaning for element in orbit.values())])
    assert f"x{axis} swings" in text
    assert "x3" not in text
    assert "y3" not in text


@pytest.mark.parametrize("axis", [1, 2, 3])
def test_y_along_the_axis_is_conserved(axis: int) -> None:
    """The fourth integral is y1, y2 or y3, as the axis is, and the Taylor motion keeps it."""
    scene = about(axis, BODIES["two-roots"])
    (fourth,) = (i for i in invariants(scene) if i.name.startswith("y") and i.name != "y_space")
    assert fourth.name == f"y{axis}"
    motion = TaylorSolution(scene).motion(TIMES, 30)
    with mp.workdps(40):
        values = fourth.value(motion)
        assert all(abs(v - mp.convert(START.angular[axis - 1])) <= mpf(10) ** -29 for v in values)


def test_a_body_with_a_choice_keeps_the_third_axis() -> None:
    """Where every axis is one of symmetry, or the third is, the axes are those of the body."""
    six = ("1.2", "1.2", "0.3", "0.3", "0.9", "0.9")
    for axis in (1, 2, 3):
        scene = about(axis, six)
        assert isinstance(scene.body, ImmersedBody)
        assert scene.body.axis_of_symmetry == 3
        clebsch = clebsch_about(scene.body)
        assert clebsch is not None
        assert clebsch[1] == UPRIGHT


def test_no_axis_is_found_where_there_is_none() -> None:
    """Two equal coefficients of one block alone, or an entry off a diagonal, are no symmetry."""
    body = Clebsch(*map(Fraction, BODIES["cubic"])).body()
    unequal = replace(body, angular=diagonal((Fraction(1), Fraction(2), Fraction(3))))
    slanted = replace(
        body, coupling=((Fraction(0), Fraction(1, 9), Fraction(0)), *body.coupling[1:])
    )
    assert body.axis_of_symmetry == 3
    assert (unequal.axis_of_symmetry, slanted.axis_of_symmetry) == (None, None)
    scene = replace(about(3, BODIES["cubic"]), body=unequal)
    assert solution(scene).regime == NO_CLOSED_FORM
    for solve in (closed_form, enclosed):
        with pytest.raises(NoClosedForm, match="Clebsch's form about any axis"):
            solve(scene)


def test_under_loads_there_is_no_closed_form() -> None:
    """Under a force there is no closed form about any axis, and the reason is the force."""
    scene = about(1, BODIES["cubic"])
    loaded = replace(scene, body=replace(scene.body, force=(Fraction(0), Fraction(1), Fraction(0))))
    with pytest.raises(NoClosedForm, match="a force or a couple acts"):
        solution(loaded, "arb")
