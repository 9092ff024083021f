"""Closed forms under a constant moment, in balls, against the enclosure.

Legend as in taylor_verify.exact.euler.moments.regime.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest
from builders.free_spins import rotation
from builders.numbers import apart as distance
from builders.scenes import vector
from flint import arb
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from taylor_verify.exact.elements import elements
from taylor_verify.exact.euler import closed
from taylor_verify.exact.euler.moments import erf
from taylor_verify.exact.euler.moments.kummer import KummerTurn
from taylor_verify.exact.euler.moments.regime import LoadedSpin
from taylor_verify.exact.kirchhoff.solid import short_digits
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import NO_CLOSED_FORM, NoClosedForm
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import exact_value
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Clock, Impulse, Motion, Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

DIGITS = 40
ONE, TWO = Fraction(1), Fraction(2)
FRAME = (ONE, Fraction(-2), Fraction(1, 3), TWO)

REGIMES = {
    "spin-up": "axial-moment",
    "moment-spherical": "spherical-moment",
    "moment-along-axis": "axial-moment",
    "moment-across-axis": "transverse-moment",
    "moment-across-no-spin": "transverse-moment",
    "moment-oblique": "oblique-moment",
    "moment-oblique-symmetry": "axial-moment",
    "moment-backward": "oblique-moment",
}


def loaded(inertia: Matrix, moment: Vector, omega: Vector, attitude: bool = False) -> Scene:
    track = frozenset({"attitude"} if attitude else ())
    clock = Clock(Fraction(0), (Fraction(0), ONE))
    return Scene(
        "drawn", "drawn", "euler", track, RigidBody(inertia, moment), Spin(omega, FRAME), clock
    )


def revolved(axis: Vector, simple: Fraction, double: Fraction) -> Matrix:
    """The tensor with the moment J_s about this axis and J_d across it, exactly."""
    squared = tensors.dot(axis, axis)
    return tuple(
        tuple(
            (double if i == j else Fraction(0)) + (simple - double) * p * q / squared
            for j, q in enumerate(axis)
        )
        for i, p in enumerate(axis)
    )


def apart(one: Motion, other: Motion) -> mpf:
    """The largest distance of a row from its like, in parts of its norm."""
    with mp.workdps(3 * DIGITS):
        return distance(one, other)


# What two numbers of so many digits may differ by.
BOTH = 2 * mpf(10) ** -DIGITS


def spin_of(scene: Scene) -> LoadedSpin:
    assert isinstance(scene.body, RigidBody)
    assert isinstance(scene.initial, Spin)
    return LoadedSpin(scene.body.inertia, scene.body.moment, scene.initial.omega)


# The shipped scenes.


@pytest.mark.parametrize("name", REGIMES)
def test_the_closed_form_is_the_taylor_motion(name: str) -> None:
    """Both agree to forty digits, before the start and after it, in all that the scene tracks."""
    scene = load(f"euler/{name}")
    exact = solution(scene, "arb")
    assert exact.regime == REGIMES[name]
    end = scene.clock.elapsed[-1]
    times = [Fraction(0), end / 7, end * Fraction(2, 3), -end / 3]
    truth = TaylorSolution(scene).motion(times, DIGITS)
    assert apart(exact.motion(times, DIGITS), truth) <= BOTH


# Bodies drawn at random, with what is exactly or nearly degenerate drawn often.

components = st.one_of(
    st.integers(-300, 300).map(lambda n: Fraction(n, 100)),
    st.just(Fraction(0)),
    st.builds(lambda n, e: Fraction(n, 7) / 10**e, st.integers(-9, 9), st.integers(1, 20)),
)
vectors = st.tuples(components, components, components)
positive = st.integers(100, 400).map(lambda n: Fraction(n, 100))
times = st.integers(-40, 40).map(lambda n: Fraction(n, 11))


@st.composite
def scenes(draw: st.DrawFn) -> Scene:
    """Two or three equal moments about any rational axis; the moment often along it or across it."""
    axis = tuple(Fraction(draw(st.integers(-3, 3))) for _ in range(3))
    assume(any(axis))
    double = draw(positive)
    near = double * (1 + Fraction(1, 10 ** draw(st.integers(3, 20))))
    simple = draw(st.one_of(positive, st.just(double), st.just(near)))
    free = draw(vectors)
    moment = {
        "free": free,
        "along": tensors.scaled(free[0], axis),
        "across": tensors.cross(axis, free),
    }[draw(st.sampled_from(["free", "along", "across"]))]
    assume(any(moment))
    scene = loaded(revolved(axis, simple, double), moment, draw(vectors), attitude=True)
    try:
        solution(scene, "arb")
    except NoClosedForm:
        return replace(scene, track=frozenset())
    return scene


@settings(max_examples=12, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(scenes(), times)
def test_drawn_bodies_move_as_the_enclosure(scene: Scene, t: Fraction) -> None:
    """Gaps and moments to 1e-20, any axis: the enclosure knows of no regime."""
    expected = TaylorSolution(scene).motion([t], DIGITS)
    assert apart(solution(scene, "arb").motion([t], DIGITS), expected) <= BOTH


# Kummer's turn.


class OneBranch(KummerTurn):
    """Broken on purpose: s as a root of z, which is never negative: Kummer's odd solution is even."""

    def _since_nearest(self, s: Fraction) -> list[arb]:
        return super()._since_nearest(abs(s))


def test_a_root_of_z_for_s_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    """The Taylor motion sees the wrong branch where s is negative."""
    scene = load("euler/moment-spherical")
    truth = TaylorSolution(scene).motion([Fraction(6)], DIGITS)
    monkeypatch.setattr(erf, "KummerTurn", OneBranch)
    assert not apart(solution(scene, "arb").motion([Fraction(6)], DIGITS), truth) <= mpf("1e-3")


class WrongSign(LoadedSpin):
    """Broken on purpose: the chirp bends the wrong way."""

    @property
    def bending(self) -> Fraction:
        return -super().bending


@pytest.mark.parametrize("name", ["moment-along-axis", "moment-oblique"])
def test_a_chirp_that_bends_the_wrong_way_is_caught(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The Taylor motion sees the sign of the quadratic term of phi."""
    scene = load(f"euler/{name}")
    truth = TaylorSolution(scene).motion([Fraction(2)], DIGITS)
    monkeypatch.setattr(closed, "LoadedSpin", WrongSign)
    assert not apart(solution(scene, "arb").motion([Fraction(2)], DIGITS), truth) <= mpf("1e-3")


# Regimes, and where there is no closed form.

TOP = revolved(vector(0, 0, 1), TWO, ONE)
TINY = Fraction(1, 10**300)


@pytest.mark.parametrize(
    ("moment", "regime"),
    [
        ((0, 0, 1), "axial-moment"),
        ((TINY, 0, 1), "oblique-moment"),
        ((1, 1, 0), "transverse-moment"),
        ((1, 1, TINY), "oblique-moment"),
    ],
)
def test_the_regime_is_decided_in_rationals(moment: tuple[Fraction, ...], regime: str) -> None:
    """A moment 1e-300 off the axis is off the axis."""
    scene = loaded(TOP, tuple(map(Fraction, moment)), vector(1, 0, 1))
    assert solution(scene, "arb").regime == regime


def test_nearly_across_is_nearly_the_transverse_motion() -> None:
    """With e.M = 1e-60 the error functions are at 1e60, and their difference is the sine's to 1e-40."""
    omega, t = vector(1, 2, 1), [Fraction(5), Fraction(-30)]
    across = loaded(TOP, vector(1, 1, 0), omega)
    beside = loaded(TOP, (ONE, ONE, Fraction(1, 10**60)), omega)
    motions = [solution(scene, "arb").motion(t, DIGITS) for scene in (across, beside)]
    assert apart(*motions) <= BOTH


@pytest.mark.parametrize(
    ("scene", "what"),
    [
        (loaded(tensors.diagonal(vector(1, 2, 3)), vector(0, 1, 1), vector(1, 1, 1)), "three"),
        (loaded(TOP, vector(1, 0, 0), vector(1, 1, 1), attitude=True), "not along its axis"),
        (loaded(TOP, vector(1, 0, 1), vector(1, 1, 1), attitude=True), "not along its axis"),
        (loaded(TOP, vector(1, 0, "1e-999"), vector(1, 1, 1)), "too weak beside the spin"),
        (
            loaded(TOP, vector(0, 0, "-1e-3"), vector(2, 2, "0.3"), attitude=True),
            "so weak a moment",
        ),
        (loaded(TOP, vector(0, 0, "1e-999"), vector(0, 0, 1), attitude=True), "so weak a moment"),
    ],
)
def test_where_there_is_no_closed_form_it_says_so(scene: Scene, what: str) -> None:
    """Both closed routes refuse, and the Taylor route takes over under the word for it."""
    for route in ("arb", "mpmath"):
        with pytest.raises(NoClosedForm, match=what):
            solution(scene, route)
    exact = solution(scene)
    assert (exact.route, exact.regime) == ("taylor", NO_CLOSED_FORM)


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


@pytest.mark.parametrize(
    ("scene", "word"),
    [
        (STEADY, "steady-moment"),
        (turned(STEADY), "steady-moment"),
        (STRAIGHT, "straight-moment"),
        (turned(STRAIGHT), "straight-moment"),
    ],
)
def test_a_fixed_axis_has_its_attitude_too(scene: Scene, word: str) -> None:
    """omega constant, or growing along its own axis: R by Taylor, from a start that is not 1."""
    exact, times = solution(scene, "arb"), [Fraction(0), Fraction(13, 2), Fraction(-4)]
    assert exact.regime == word == elements(scene, 15).regime
    expected = TaylorSolution(scene).motion(times, DIGITS)
    assert set(expected.quantities) == {"omega", "attitude"}
    assert apart(exact.motion(times, DIGITS), expected) <= BOTH


def test_across_the_axis_omega_recurs_after_the_period() -> None:
    """The one loaded motion with a period; without spin, and with any part along the axis, none."""
    scene = load("euler/moment-across-axis")
    period = elements(scene, 50)["period"].value
    exact = solution(scene)
    motion = exact.motion([Fraction(1), 1 + exact_value(period)], DIGITS)
    start, end = motion["omega"]
    with mp.workdps(2 * DIGITS):
        assert mp.norm(list(end - start)) <= BOTH * mp.norm(list(start))
    for name in ("moment-across-no-spin", "moment-oblique", "spin-up", "moment-spherical"):
        orbit = elements(load(f"euler/{name}"), 15)
        assert orbit.regime == REGIMES[name]
        assert len(orbit) == 0


@pytest.mark.parametrize("faster", [1, 1000, Fraction(1, 1000)])
def test_the_digits_of_a_short_way_do_not_depend_on_the_unit_of_time(faster: Fraction) -> None:
    """A way of 1e-9 beside a lever of 1: nine digits, in seconds as in milliseconds."""
    start = Impulse(vector(1, 0, 0), vector(0, 1, 0))
    U, time = vector(Fraction(faster, 1000), 0, 0), Fraction(1, 10**6) / faster
    assert short_digits(U, start, [time]) == 9
