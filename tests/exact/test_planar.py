"""Motion in a plane of a body without symmetry: a pendulum, by two routes and against Taylor."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest
from builders.numbers import apart
from builders.routes import motions_of_taylor
from builders.scenes import one_instant
from mpmath import mp, mpf

from taylor_verify.exact.kirchhoff.plane import plane, regime
from taylor_verify.exact.route import solution
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Matrix
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.scene import Scene

DIGITS = 25
TIMES = [Fraction(1, 3), Fraction(3), Fraction(-2), Fraction(5)]
BROAD = ("1", "3/2", "3/4")
TURN = ("1", "2", "1/2")
# x along the two axes of the plane in cyclic order, y across it, and the regime where p_i < p_j.
STARTS = {
    "swing": ("3/4", "-1/2", "1/4", "planar-swing"),
    "swing, the other way on": ("-3/4", "1/2", "-1/4", "planar-swing"),
    "swing from its end": ("1", "-1/3", "0", "planar-swing"),
    "swing through the middle": ("-1", "0", "1/8", "planar-swing"),
    "turn": ("1/4", "1", "2", "planar-turn"),
    "turn backward": ("-1/4", "1", "-2", "planar-turn"),
    "turn from end on": ("0", "-1", "1/8", "planar-turn"),
    "front": ("1", "1/3", "1/2", "planar-front"),
    "front backward": ("1", "1/3", "-1/2", "planar-front"),
    "front, the other way on": ("-1", "1/3", "1/2", "planar-front"),
    "broadside on": ("1", "0", "0", "planar-steady"),
    "end on": ("0", "-1", "0", "planar-steady"),
    "no impulse": ("0", "0", "1", "planar-uniform"),
    "at rest": ("0", "0", "0", "planar-steady"),
}


def cyclic(k: int) -> tuple[int, int]:
    return (k + 1) % 3, (k + 2) % 3


def built(k: int, p: tuple[str, ...], start: tuple[str, ...]) -> Scene:
    """A body that moves across axis k; p of the axes i, j and k, and much besides out of the plane."""
    i, j = cyclic(k)
    A, C = ({n: Fraction(v) for n, v in zip((i, j, k), w, strict=True)} for w in (p, TURN))
    angular = [list(row) for row in tensors.diagonal((C[0], C[1], C[2]))]
    angular[k][k] = Fraction(1)
    angular[i][j] = angular[j][i] = Fraction(1, 10)
    coupling = [[Fraction(0)] * 3 for _ in range(3)]
    coupling[k][i], coupling[k][j] = Fraction(1, 8), Fraction(-1, 16)
    body = ImmersedBody(tensors.diagonal((A[0], A[1], A[2])), matrix(coupling), matrix(angular))
    x, y = [Fraction(0)] * 3, [Fraction(0)] * 3
    x[i], x[j], y[k] = (Fraction(v) for v in start)
    frame = (Fraction(1), Fraction(2), Fraction(-1), Fraction(3))
    place = (Fraction(1), Fraction(-2), Fraction(1, 3))
    return one_instant(body, Impulse(tuple(x), tuple(y), frame, place), "attitude", "centre")


def matrix(rows: list[list[Fraction]]) -> Matrix:
    return tuple(tuple(row) for row in rows)


def fitting(name: str, k: int, swapped: bool) -> tuple[Scene, str]:
    """The start, with p_j - p_i = 1/4 on a front so that the border is met exactly."""
    first, second, across, word = STARTS[name]
    p = ("1", "5/4", "2") if word == "planar-front" else BROAD
    if swapped:
        return built(k, (p[1], p[0], p[2]), (second, first, across)), word
    return built(k, p, (first, second, across)), word


# Every other start, the one order of p and the other by turns.
@pytest.mark.parametrize(
    ("name", "swapped"),
    [
        pytest.param(
            name, swapped, marks=() if n % 4 in (0, 3) and n % 2 == swapped else pytest.mark.slow
        )
        for n, name in enumerate(STARTS)
        for swapped in (False, True)
    ],
)
def test_closed_routes_are_the_taylor_motion(name: str, swapped: bool) -> None:
    """Impulses, attitude and centre, across one axis or another, whatever else T holds."""
    k = list(STARTS).index(name) % 3
    for motion in motions_of_taylor(*fitting(name, k, swapped), TIMES, DIGITS):
        assert not any(motion["linear_impulse"][:, k])
        assert not any(motion["angular_impulse"][:, [*cyclic(k)]].flat)


def test_the_border_of_swing_and_turn_is_decided_exactly() -> None:
    """A part in 10^40 of y more or less, and it turns over or comes back."""
    scene, _ = fitting("front", 2, False)
    assert isinstance(scene.initial, Impulse)
    for factor, word in (
        (1, "planar-front"),
        (1 + TINY, "planar-turn"),
        (1 - TINY, "planar-swing"),
    ):
        y = tuple(factor * e for e in scene.initial.angular)
        in_plane = plane(replace(scene, initial=replace(scene.initial, angular=y)))
        assert in_plane is not None
        assert regime(in_plane) == word


TINY = Fraction(1, 10**40)


def test_beside_the_border_closed_form_and_series_overlap() -> None:
    """1 - m = 10^-40: a period of some ninety units of argument, and no digit less."""
    scene, _ = fitting("front", 2, False)
    assert isinstance(scene.initial, Impulse)
    y = tuple((1 - TINY) * e for e in scene.initial.angular)
    near = replace(scene, initial=replace(scene.initial, angular=y))
    one, other = (solution(near, route).motion(TIMES, DIGITS) for route in ("arb", "taylor"))
    with mp.workdps(DIGITS + 20):
        assert apart(one, other) <= 2 * mpf(10) ** -DIGITS


@pytest.mark.parametrize(
    ("block", "row", "column"),
    [
        *(("linear", i, j) for i, j in ((0, 1), (0, 2), (1, 2))),
        *(("angular", i, 2) for i in (0, 1)),
        *(("coupling", i, j) for i in (0, 1) for j in range(3)),
        ("coupling", 2, 2),
    ],
)
def test_whatever_leads_out_of_the_plane_is_no_pendulum(block: str, row: int, column: int) -> None:
    """One entry of T more, of 2^-60, and there is no plane; each of them is looked at."""
    scene, _ = fitting("swing", 2, False)
    assert isinstance(scene.body, ImmersedBody)
    rows = [list(line) for line in getattr(scene.body, block)]
    rows[row][column] += Fraction(1, 2**60)
    if block != "coupling" and row != column:
        rows[column][row] += Fraction(1, 2**60)
    body = replace(scene.body, **{block: matrix(rows)})
    assert plane(scene) is not None
    assert plane(replace(scene, body=body)) is None


def test_a_start_or_a_load_out_of_the_plane_is_no_pendulum() -> None:
    """Each component that must be zero is looked at, and every load."""
    scene, _ = fitting("swing", 2, False)
    assert isinstance(scene.initial, Impulse)
    assert isinstance(scene.body, ImmersedBody)
    little = Fraction(1, 2**60)
    x, y = scene.initial.linear, scene.initial.angular
    for initial in (
        replace(scene.initial, linear=(*x[:2], little)),
        replace(scene.initial, angular=(little, *y[1:])),
        replace(scene.initial, angular=(y[0], little, y[2])),
    ):
        assert plane(replace(scene, initial=initial)) is None
    loaded = replace(scene.body, couple=(Fraction(0), Fraction(0), little))
    assert plane(replace(scene, body=loaded)) is None
