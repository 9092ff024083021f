"""The reductions of a free solid, and the cases that they lead to: exact conditions, two routes, Taylor."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np
import pytest
from builders.numbers import apart, closed_routes, motions_of_taylor
from builders.scenes import COUPLE, FORCE, GENERAL, one_instant, vector
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from taylor_verify.exact.carried import Back
from taylor_verify.exact.elements import elements
from taylor_verify.exact.kirchhoff import displaced, isotropic
from taylor_verify.exact.kirchhoff.displaced import about, centred, moved
from taylor_verify.exact.kirchhoff.isotropic import less_coupling, less_linear
from taylor_verify.exact.kirchhoff.reduced import Reduced
from taylor_verify.exact.kirchhoff.solid import solid, velocities
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import NO_CLOSED_FORM, Number, Time
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.models.problem import pose
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import rung
from taylor_verify.numbers.rotation import rotation_matrix
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.records.precisions import LADDER
from taylor_verify.scenes.bodies import ImmersedBody, RigidBody
from taylor_verify.scenes.motion import Impulse, Motion, Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

DIGITS = 25
TIMES = [Fraction(0), Fraction(2, 3), Fraction(-1, 3)]
LITTLE = Fraction(1, 10**60)
AWAY = vector("0.5", "-0.25", "0.75")
FRAME = (Fraction(1), Fraction(2), Fraction(-1), Fraction(3))
PLACE = vector("1", "-2", "0.5")
C = (vector(1.25, 0.125, -0.25), vector(0.125, 0.75, 0.125), vector(-0.25, 0.125, 0.5))
X, Y = vector("0.5", "-0.25", "0.75"), vector("0.5", "-0.75", "0.25")


def multiple(value: str) -> Matrix:
    return tensors.diagonal((Fraction(value),) * 3)


def whole(body: ImmersedBody, x: Vector = X, y: Vector = Y) -> Scene:
    """A scene with attitude and centre, neither of them the usual one."""
    return one_instant(body, Impulse(x, y, FRAME, PLACE), "attitude", "centre")


def isotropic_body() -> Scene:
    return whole(ImmersedBody(multiple("1.5"), multiple("0.25"), C))


def impulse_free() -> Scene:
    """No linear impulse, and A as it likes: the centre needs B = b 1."""
    return whole(ImmersedBody(GENERAL.linear, multiple("0.25"), C), x=vector(0, 0, 0))


def revolved() -> Scene:
    six = ("1", "1", "1.5"), ("0.125", "0.125", "0.25"), ("0.75", "0.75", "1.25")
    return whole(ImmersedBody(*(tensors.diagonal(vector(*entries)) for entries in six)))


def held_screw() -> Scene:
    """All 21 coefficients, and the loads that keep x and y as they are."""
    U, Omega = velocities(GENERAL, Impulse(X, Y))
    force = tensors.cross(Omega, X)
    couple = tensors.plus(tensors.cross(Omega, Y), tensors.cross(U, X))
    return whole(replace(GENERAL, force=force, couple=couple))


CASES: dict[str, tuple[Callable[[], Scene], str]] = {
    "isotropic": (isotropic_body, "max-axis"),
    "impulse-free": (impulse_free, "max-axis"),
    "revolved": (revolved, "four-roots"),
}


def closed_motions(scene: Scene, times: list[Fraction] = TIMES) -> list[Motion]:
    return [solution(scene, route).motion(times, DIGITS) for route in closed_routes(scene)]


# The reductions themselves.


REDUCTIONS: dict[str, Callable[[Reduced], Reduced]] = {
    "moved": lambda start: about(start, AWAY, "somewhere"),
    "less b": lambda start: less_coupling(start, Fraction(-1, 3)),
    "all": lambda start: less_linear(less_coupling(centred(start), Fraction(1, 7)), Fraction(1, 5)),
}


@cache
def unreduced(x: Vector) -> Motion:
    return TaylorSolution(whole(GENERAL, x=x)).motion(TIMES, DIGITS)


@pytest.mark.parametrize(("name", "x"), [("moved", X), ("all", X), ("less b", vector(0, 0, 0))])
def test_the_way_back_leads_to_the_motion_of_the_scene(name: str, x: Vector) -> None:
    """A body of 21 coefficients, reduced, integrated and carried back, moves as it does unreduced.

    Without linear impulse a multiple in B is a straight drift: space does not turn.
    """
    scene = whole(GENERAL, x=x)
    reduced = REDUCTIONS[name](Reduced(scene))
    inner = TaylorSolution(reduced.scene)
    motion = reduced.carried_back(inner).motion(TIMES, DIGITS)
    with mp.workdps(DIGITS + 20):
        assert apart(motion, unreduced(x)) <= 3 * mpf(10) ** -DIGITS


def wrongly(change: Callable[[dict[str, Any], dict[str, Any]], None], right: Back) -> Back:
    """A way back that is changed after the event, given what came in and what went out."""

    def back(rows: dict[str, Any], elapsed: list[Time], number: Number) -> None:
        before = {name: entries.copy() for name, entries in rows.items()}
        right(rows, elapsed, number)
        change(before, rows)

    return back


def on_the_right(before: dict[str, Any], rows: dict[str, Any]) -> None:
    """R' Q for Q R'."""
    turns = rows["attitude"] @ before["attitude"].transpose(0, 2, 1)
    rows["attitude"] = before["attitude"] @ turns


def turned_wrongly(monkeypatch: pytest.MonkeyPatch) -> Scene:
    """Space is turned on the wrong side on the way back from a body with b 1 less in B."""
    right = isotropic._turned
    monkeypatch.setattr(
        isotropic, "_turned", lambda b, start: wrongly(on_the_right, right(b, start))
    )
    return isotropic_body()


def moved_wrongly(monkeypatch: pytest.MonkeyPatch) -> Scene:
    """The displacement back goes by -d: y and the path are wrong in their first digit."""
    right = displaced.moved_back
    monkeypatch.setattr(
        displaced, "moved_back", lambda d, start: right(tensors.scaled(Fraction(-1), d), start)
    )
    return moved(revolved(), AWAY)


@pytest.mark.parametrize("route", ["arb", "mpmath"])
@pytest.mark.parametrize(("twin", "off"), [(turned_wrongly, 1e-3), (moved_wrongly, 0.1)])
def test_a_wrong_way_back_is_seen(
    twin: Callable[[pytest.MonkeyPatch], Scene],
    off: float,
    route: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The broken twins of the two ways back."""
    scene = twin(monkeypatch)
    motion = solution(scene, route).motion(TIMES, DIGITS)
    with mp.workdps(DIGITS + 20):
        assert apart(motion, TaylorSolution(scene).motion(TIMES, DIGITS)) > off


# The cases, by both routes and against Taylor.


@pytest.mark.parametrize("away", [vector(0, 0, 0), AWAY], ids=["centred", "displaced"])
@pytest.mark.parametrize("name", CASES)
def test_closed_routes_are_the_taylor_motion(name: str, away: Vector) -> None:
    """Impulses, attitude and centre, about the special origin and beside it."""
    build, word = CASES[name]
    assert motions_of_taylor(moved(build(), away), word, TIMES, DIGITS)


def test_a_screw_held_by_loads_is_the_taylor_motion() -> None:
    """x and y stay as they are, exactly; the body turns about one line and advances along it."""
    motion, *_ = motions_of_taylor(held_screw(), "steady", TIMES, DIGITS)
    assert np.all(motion["linear_impulse"] == motion["linear_impulse"][0])


@pytest.mark.parametrize("x", [vector(0, 0, 0), X], ids=["at rest", "drifting"])
def test_a_body_that_does_not_turn_goes_straight_on(x: Vector) -> None:
    """Omega = 0 under no loads: U is constant, and the path is rational."""
    body = ImmersedBody(multiple("1.5"), tensors.ZERO_MATRIX, C)
    scene = whole(body, x, vector(0, 0, 0))
    assert solution(scene).regime in ("steady", "rest")
    motion = solution(scene, "arb").motion(TIMES, DIGITS)
    way = tensors.scaled(Fraction(3, 2) * TIMES[1], tensors.apply(rotation_matrix(FRAME), x))
    with mp.workdps(DIGITS + 20):
        for c, first, step in zip(motion["centre"][1], PLACE, way, strict=True):
            assert abs(c - mp.convert(first + step)) <= mpf(10) ** (1 - DIGITS)


@pytest.mark.parametrize("track", [frozenset(), frozenset({"attitude"})])
def test_without_linear_impulse_impulse_and_attitude_are_always_closed(track: set[str]) -> None:
    """A and B are as they like; with the centre there is no closed form."""
    start = Impulse(vector(0, 0, 0), Y, FRAME, PLACE)
    scene = one_instant(GENERAL, start, *track)
    expected = TaylorSolution(scene).motion(TIMES, DIGITS)
    with mp.workdps(DIGITS + 20):
        for motion in closed_motions(scene):
            assert apart(motion, expected) <= 2 * mpf(10) ** -DIGITS
    pathless = one_instant(GENERAL, start, "attitude", "centre")
    assert solution(pathless).regime == NO_CLOSED_FORM
    assert elements(pathless).regime == NO_CLOSED_FORM
    assert "The path of the origin has no closed form." in elements(pathless).sentences


# The conditions are exact.


def with_entry(body: ImmersedBody, block: str, i: int, j: int, amount: Fraction) -> ImmersedBody:
    rows = [list(row) for row in getattr(body, block)]
    rows[i][j] += amount
    if block != "coupling" and i != j:
        rows[j][i] += amount
    return replace(body, **{block: tuple(map(tuple, rows))})


ENTRIES = [
    *(("linear", i, j) for i in range(3) for j in range(i, 3)),
    *(("coupling", i, j) for i in range(3) for j in range(i, 3)),
]


@pytest.mark.parametrize(("block", "i", "j"), ENTRIES)
def test_what_is_nearly_isotropic_is_not(block: str, i: int, j: int) -> None:
    """An entry of A or B that is 10^-60 off, where B is symmetric, leaves no closed form."""
    scene = isotropic_body()
    body = with_entry(solid(scene)[0], block, i, j, LITTLE)
    if block == "coupling" and i != j:
        body = with_entry(body, block, j, i, LITTLE)
    near = moved(replace(scene, body=body), AWAY)
    assert solution(moved(scene, AWAY)).regime == "max-axis"
    assert solution(near).regime == NO_CLOSED_FORM


@pytest.mark.parametrize("k", range(3))
def test_a_linear_impulse_of_1e_60_is_one(k: int) -> None:
    """A body without symmetry has no closed form any more."""
    x = tuple(LITTLE * (n == k) for n in range(3))
    assert solution(one_instant(GENERAL, Impulse(x, Y))).regime == NO_CLOSED_FORM


@pytest.mark.parametrize("name", ["force", "couple"])
@pytest.mark.parametrize("k", range(3))
def test_a_screw_that_is_nearly_held_is_not_steady(name: str, k: int) -> None:
    """A load 10^-60 off, and the motion leaves: an unstable screw must not look like a steady one."""
    scene = held_screw()
    body, _ = solid(scene)
    little = tuple(LITTLE * (n == k) for n in range(3))
    near = replace(body, **{name: tensors.plus(getattr(body, name), little)})
    assert solution(scene).regime == "steady"
    assert solution(replace(scene, body=near)).regime == NO_CLOSED_FORM


@pytest.mark.parametrize("k", range(6))
def test_a_start_that_is_nearly_steady_is_not(k: int) -> None:
    """The shipped unstable screw of a free body with a seed of 10^-60 in one component."""
    scene = load("kirchhoff/steady-screw")
    body, start = solid(scene)
    seed = tuple(LITTLE * (n == k) for n in range(6))
    moving = tensors.plus(start.moving, seed)
    assert solution(scene).regime == "steady"
    near = replace(start, linear=moving[:3], angular=moving[3:])
    assert solution(replace(scene, initial=near, body=body)).regime == NO_CLOSED_FORM


def test_under_loads_nothing_else_is_closed() -> None:
    """Each case has none under a force or a couple that does not hold it."""
    for build, _ in CASES.values():
        scene = build()
        body, _ = solid(scene)
        for loaded in (replace(body, force=FORCE), replace(body, couple=COUPLE)):
            assert solution(replace(scene, body=loaded)).regime == NO_CLOSED_FORM


# Weber's family beside other origins.


def test_weber_is_found_beside_its_origin() -> None:
    """A common b and another origin leave theta functions: the impulses, carried back."""
    scene = load("kirchhoff/weber")
    body, _ = solid(scene)
    screwed = replace(scene, body=replace(body, coupling=multiple("0.125")))
    aside = moved(screwed, AWAY)
    assert motions_of_taylor(aside, "weber", TIMES, DIGITS)


# Bodies drawn at random: small and large, and nearly degenerate.

entries = st.integers(-12, 12).map(lambda n: Fraction(n, 8))
vectors = st.tuples(entries, entries, entries)
sizes = st.sampled_from([0, 0, -20, -40, 6]).map(lambda e: Fraction(10) ** e)
starts = st.builds(
    lambda x, y, a, b: Impulse(tensors.scaled(a, x), tensors.scaled(b, y), FRAME, PLACE),
    *(vectors, vectors, sizes, sizes),
)
places = st.builds(tensors.scaled, sizes, vectors)


@st.composite
def inertias(draw: st.DrawFn) -> Matrix:
    """Positive definite matrices, some with two eigenvalues that agree, or agree to 10^-40."""
    if draw(st.booleans()):
        gap = draw(st.sampled_from([Fraction(0), LITTLE, Fraction(1, 10**12)]))
        return tensors.diagonal((Fraction(1), 1 + gap, Fraction(draw(st.integers(1, 9)), 4)))
    a, b, c = draw(vectors), draw(vectors), draw(vectors)
    rows = tuple(
        tensors.plus(row, unit) for row, unit in zip((a, b, c), multiple("4"), strict=True)
    )
    return tensors.product(rows, tensors.transpose(rows))


@given(inertias(), starts, places, entries)
@settings(max_examples=12, deadline=None)
def test_the_routes_overlap_on_tops(C: Matrix, start: Impulse, d: Vector, b: Fraction) -> None:
    """Isotropic linear parts of every size about every origin, in every regime."""
    body = ImmersedBody(multiple("9"), tensors.diagonal((b / 20,) * 3), C)
    scene = moved(one_instant(body, start, "attitude", "centre"), d)
    one, *others = closed_motions(scene, [Fraction(0), Fraction(1, 3), Fraction(-400)])
    with mp.workdps(DIGITS + 20):
        assert all(apart(one, other) <= 2 * mpf(10) ** -DIGITS for other in others)


# What ships, and what is said of it.

SHIPPED = {
    "euler/separatrix": "separatrix",
    "euler/separatrix-full-tensor": "separatrix",
    "euler/oblique-symmetry": "axisymmetric",
    "kirchhoff/axis-beside-the-origin": "four-roots",
    "kirchhoff/displaced-origin": "max-axis",
    "kirchhoff/no-linear-impulse": "min-axis",
    "kirchhoff/steady-screw": "steady",
    "kirchhoff/steady-screw-under-loads": "steady",
    "kirchhoff/weber": "weber",
}


@pytest.mark.parametrize("step", LADDER)
@pytest.mark.parametrize("name", SHIPPED)
def test_what_ships_is_of_its_case_on_every_rung(name: str, step: str) -> None:
    """The conditions of a special orbit, which are dyadic, survive the rounding of each rung."""
    scene = load(name)
    for asked in (scene, pose(scene, rung(step)).given):
        assert solution(asked).regime == SHIPPED[name]


def test_the_elements_are_those_of_the_inner_motion() -> None:
    """y of a displaced top recurs about its own origin after the period of the top, x.y as ever."""
    scene = moved(isotropic_body(), AWAY)
    assert elements(scene)["period"].value == elements(isotropic_body())["period"].value
    axis = elements(load("kirchhoff/axis-beside-the-origin")).sentences
    assert any("y3 about that origin" in line for line in axis)


def test_the_pitch_of_a_screw_is_its_way_in_one_turn() -> None:
    """After one turn the attitude is back, and the centre has gone the pitch along the axis."""
    scene = held_screw()
    orbit = elements(scene, 30)
    period = Fraction(str(mp.nstr(orbit["turn_period"].value, 30)))
    motion = solution(scene).motion([Fraction(0), period], DIGITS)
    with mp.workdps(40):
        turned = motion["attitude"][1] - motion["attitude"][0]
        assert max(abs(entry) for entry in turned.flat) <= mpf(10) ** -23
        way = mp.norm(list(motion["centre"][1] - motion["centre"][0]))
        assert abs(way - abs(orbit["pitch"].value)) <= mpf(10) ** -23


# A rigid body under a moment that its own rotation balances.


@pytest.mark.parametrize("moments", [(1, 2, 3), (1, 1, 3), (2, 1, 1)], ids=str)
def test_a_balanced_rotation_is_steady_with_its_attitude(moments: tuple[int, ...]) -> None:
    """I w0 x w0 + M = 0 holds for bodies with equal moments too; 10^-60 off it does not."""
    inertia, omega = tensors.diagonal(tuple(map(Fraction, moments))), vector("0.5", "-0.75", 1)
    moment = tensors.cross(omega, tensors.apply(inertia, omega))
    scene = one_instant(RigidBody(inertia, moment), Spin(omega, FRAME), "attitude")
    expected = TaylorSolution(scene).motion(TIMES, DIGITS)
    exact = solution(scene, "arb")
    assert exact.regime == elements(scene).regime == "steady-moment"
    with mp.workdps(DIGITS + 20):
        assert apart(exact.motion(TIMES, DIGITS), expected) <= 2 * mpf(10) ** -DIGITS
    near = replace(scene, body=RigidBody(inertia, (moment[0] + LITTLE, *moment[1:])))
    assert solution(near).regime == NO_CLOSED_FORM
