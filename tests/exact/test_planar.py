"""Pendulums, pitch on an orbit, and a body that keeps its axis: by two routes and Taylor."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest
from builders.free_spins import rotation
from builders.numbers import apart, motions_of_taylor
from builders.numbers import apart as distance
from builders.scenes import one_instant, read_scene, vector
from builders.turns import by_turns
from mpmath import mp, mpf

from taylor_verify.exact.elements import elements
from taylor_verify.exact.euler.libration import pitch_of
from taylor_verify.exact.kirchhoff.plane import plane, regime
from taylor_verify.exact.kirchhoff.solid import short_digits
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import NO_CLOSED_FORM, NoClosedForm
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.scenes.bodies import ImmersedBody, RigidBody
from taylor_verify.scenes.motion import Impulse, Motion, Spin
from taylor_verify.scenes.reading.reader import load
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


# Pitch on a circular orbit

IN_ORBIT = [Fraction(1, 3), Fraction(5), Fraction(-3, 2)]


def orbiting(**changed: str) -> Scene:
    """A satellite under gravity gradient, whose axis 3 is the normal of the orbit."""
    given = {
        "inertia": "[1, 2, 3]", "o": '["cos(n*t)", "sin(n*t)", 0]', "omega": "[0, 0, 0.6]",
        "attitude": "[1, 0, 0, 0.3]", "more": "", "first": "3*n^2*(I33 - I22)*o2*o3",
        "last": "3*n^2*(I22 - I11)*o1*o2",
    } | changed  # fmt: skip
    moment = f'["{given["first"]}", "3*n^2*(I11 - I33)*o3*o1", "{given["last"]}"]'
    return read_scene(
        f"inertia = {given['inertia']}\nmoment = {moment}\n{given['more']}",
        f"omega = {given['omega']}\nattitude = {given['attitude']}",
        f'[define]\nn = "1/2"\n[space]\no = {given["o"]}',
        top='track = ["attitude"]',
    )


ALONG_1 = {"inertia": "[2, 1, 1.5]", "o": '[0, "cos(n*t)", "sin(n*t)"]', "omega": "[0.4, 0, 0]"}
PITCHING = {
    "about the vertical": ("planar-swing", {}),
    "about the other end": ("planar-swing", {"attitude": "[0.2, 0, 0, 1]"}),
    "upside down": ("planar-swing", {"attitude": "[0, 1, 0.3, 0]", "omega": "[0, 0, -0.6]"}),
    "on an orbit the other way": (
        "planar-swing",
        {"o": '["cos(n*t)", "-sin(n*t)", 0]', "omega": "[0, 0, -0.3]"},
    ),
    "about axis 1": ("planar-swing", {**ALONG_1, "attitude": "[1, 0.4, 0, 0]"}),
    "over and over": ("planar-turn", {"omega": "[0, 0, 3]"}),
    "towards the horizontal": ("planar-front", {"omega": "[0, 0, 1]", "attitude": "[1, 0, 0, 0]"}),
    "upright": ("planar-steady", {"omega": "[0, 0, 0.5]", "attitude": "[1, 0, 0, 0]"}),
    "level": ("planar-steady", {"omega": "[0, 0, 0.5]", "attitude": "[1, 0, 0, 1]"}),
}


@pytest.mark.parametrize("name", by_turns(PITCHING, 9, lambda name: PITCHING[name][0]))
def test_closed_routes_are_the_enclosed_motion(name: str) -> None:
    """Angular velocity and attitude, in every regime, about each end and each axis."""
    word, changed = PITCHING[name]
    scene = orbiting(**changed)
    assert elements(scene).regime == word
    assert motions_of_taylor(scene, word, IN_ORBIT, DIGITS)


def test_the_shipped_scene_swings_once_in_the_period_that_is_printed() -> None:
    """After its period the satellite is where the orbit alone would have turned it."""
    scene = load("loads/pitch-libration")
    period = elements(scene, 20)["period"].value
    after = solution(scene).motion([Fraction(int(period * 10**12), 10**12)], 15)["omega"][0]
    assert abs(after[2] - mpf("0.0011")) < mpf(10) ** -14


@pytest.mark.parametrize(
    "changed",
    [
        {"attitude": "[1, 0.3, 0, 0]"},
        {"omega": "[1e-9, 0, 0.6]"},
        {"inertia": "[[1, 0, 0.1], [0, 2, 0], [0.1, 0, 3]]"},
        {"o": '["cos(n*t)", "sin(2*n*t)", 0]'},
        {"o": '["cos(n*t)", "1.001*sin(n*t)", 0]'},
        {"o": '["cos(n*t)", "sin(n*t)", 1e-9]'},
        {"o": '["cos(n*t + 1e-9)", "sin(n*t)", 0]'},
        {"last": "3*n^2*(I22 - I11)*o1*o2 + 1e-9*o1"},
        {"first": "1e-9*o1"},
        {"more": 'damping = "1e-9"'},
        {"more": "weight = { force = [0, 0, 1], at = [0.1, 0, 0] }"},
    ],
)
def test_whatever_is_no_such_moment_has_no_closed_form(changed: dict[str, str]) -> None:
    """A moment that leaves the plane by a part in 10^9, or reads another angle, is none."""
    assert pitch_of(orbiting(**changed)) is None


def test_from_an_attitude_that_is_not_rational_the_motion_is_enclosed() -> None:
    """A turn of 0.3 rad has no rational matrix: there is no closed form, and the route is proven."""
    scene = read_scene(
        'inertia = [1, 1, 2]\nmoment = ["sin(t)", 0, 0]',
        "omega = [1, 0, 0]\nrotation_vector = [0.3, 0.2, 0.1]",
    )
    exact = solution(scene)
    assert exact.route == "taylor"
    (row,) = exact.motion([Fraction(1)], DIGITS)["omega"]
    assert abs(row[0] - 2 + mp.cos(1)) < mpf(10) ** -15


# A fixed axis

FIXED_DIGITS = 40
ONE, TWO = Fraction(1), Fraction(2)
FRAME = (ONE, Fraction(-2), Fraction(1, 3), TWO)


def loaded(inertia: Matrix, moment: Vector, omega: Vector, attitude: bool = False) -> Scene:
    track = ("attitude",) if attitude else ()
    return one_instant(RigidBody(inertia, moment), Spin(omega, FRAME), *track)


def row_apart(one: Motion, other: Motion) -> mpf:
    """The largest distance of a row from its like, in parts of its norm."""
    with mp.workdps(3 * FIXED_DIGITS):
        return distance(one, other)


# What two numbers of so many digits may differ by.
BOTH = 2 * mpf(10) ** -FIXED_DIGITS


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
    expected = TaylorSolution(scene).motion(times, FIXED_DIGITS)
    assert set(expected.quantities) == {"omega", "attitude"}
    assert row_apart(exact.motion(times, FIXED_DIGITS), expected) <= BOTH


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
