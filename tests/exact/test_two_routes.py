"""Two routes to a closed form, balls and mpmath, sharing no formula: they must overlap."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction

import pytest
from builders.free_spins import rotation
from builders.routes import has_route
from builders.turns import by_turns
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mpmath import mp

from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Unsettled
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Matrix
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.library import names
from taylor_verify.scenes.motion import Clock, Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

Triple = tuple[Fraction, Fraction, Fraction]

DIGITS = 30
FRAME = (Fraction(1), Fraction(-2), Fraction(1, 3), Fraction(2))


def everything(scene: Scene) -> Scene:
    """The scene with its attitude, another one than the usual."""
    turned = replace(scene.initial, attitude=FRAME)
    return replace(scene, track=frozenset({"attitude"}), initial=turned)


def disagreement(scene: Scene, times: list[Fraction]) -> str:
    """Where the two routes lie further apart than both radii allow; nothing if they overlap."""
    one, other = (solution(scene, route).motion(times, DIGITS) for route in ("arb", "mpmath"))
    assert set(one.quantities) == set(other.quantities)
    with mp.workdps(DIGITS + 30):
        for name, rows in one.quantities.items():
            for k, time in enumerate(times):
                size = mp.norm(list(rows[k].flat))
                apart = mp.norm(list((rows[k] - other[name][k]).flat))
                allowed = (one.radius[k] + other.radius[k]) * (size if size else 1)
                if not apart <= allowed <= 3 * mp.mpf(10) ** -DIGITS * (size if size else 1):
                    return f"{name} at {time}: {mp.nstr(apart / (size or 1))}"
    return ""


@pytest.mark.parametrize(
    "name", by_turns([name for name in names() if has_route(load(name), "mpmath")])
)
def test_on_every_shipped_scene(name: str) -> None:
    """Attitude and centre included, within the span of the scene, before it and after it."""
    scene = everything(load(name))
    end = scene.clock.elapsed[-1]
    assert disagreement(scene, [end / 7, end * Fraction(8, 9), -end / 3, 5 * end]) == ""


# Bodies drawn at random, with what is exactly or nearly degenerate drawn often.

magnitudes = st.integers(-12, 12).map(lambda e: Fraction(10) ** e)
plain = st.integers(-300, 300).map(lambda n: Fraction(n, 100))
components = st.one_of(
    plain,
    st.just(Fraction(0)),
    st.builds(lambda n, e: Fraction(n, 7) / 10**e, st.integers(-9, 9), st.integers(1, 30)),
)
positive = st.integers(1, 400).map(lambda n: Fraction(n, 100))
vectors = st.tuples(components, components, components)
times = st.builds(
    lambda n, d, e: Fraction(n, d) * 10**e,
    st.integers(-50, 50),
    st.integers(1, 9),
    st.sampled_from([0, 0, 0, 1, 3, 6, 12]),
)


offsets = st.one_of(
    st.just(Fraction(0)),
    st.builds(
        lambda sign, e: sign * Fraction(1, 10**e), st.sampled_from([-1, 1]), st.integers(1, 60)
    ),
)


def near(value: Fraction, e: int) -> Fraction:
    return value * (1 + Fraction(1, 10**e))


@st.composite
def moments(draw: st.DrawFn) -> tuple[Fraction, Fraction, Fraction]:
    """Principal moments: any ratio to 10^12, any two equal or nearly so."""
    J1 = draw(positive)
    kind = draw(st.sampled_from(["plain", "ratio", "near", "equal"]))
    J2 = {
        "plain": draw(positive),
        "ratio": draw(positive) * draw(magnitudes),
        "near": near(J1, draw(st.integers(3, 30))),
        "equal": J1,
    }[kind]
    J3 = draw(st.one_of(positive, st.just(near(J2, draw(st.integers(3, 30))))))
    order = draw(st.permutations([J1, J2, J3]))
    return order[0], order[1], order[2]


def spinning() -> st.SearchStrategy[tuple[Triple, Triple]]:
    return st.tuples(moments(), vectors)


@st.composite
def beside_a_separatrix(draw: st.DrawFn) -> tuple[Triple, Triple]:
    """On it exactly, or beside it by a part in up to 10^60, which 1 - k^2 is then as small as.

    On it J_a (J_a - J_b) w_a^2 = J_c (J_b - J_c) w_c^2, which a rational J_b solves.
    """
    J_a, J_c, w_a, w_b, w_c = (draw(positive) for _ in range(5))
    along, across = J_a * w_a**2, J_c * w_c**2
    J_b = (J_a * along + J_c * across) / (along + across)
    signs = draw(st.tuples(*[st.sampled_from([-1, 1])] * 3))
    omega = (signs[0] * w_a * (1 + draw(offsets)), signs[1] * w_b, signs[2] * w_c)
    order = draw(st.permutations(range(3)))
    diagonal = (J_a, J_b, J_c)
    return _ordered(diagonal, order), _ordered(omega, order)


def _ordered(entries: Triple, order: list[int]) -> Triple:
    i, j, k = order
    return entries[i], entries[j], entries[k]


@st.composite
def spins(draw: st.DrawFn) -> Scene:
    """Free rigid bodies, some in axes turned by a rational rotation, some beside the separatrix."""
    diagonal, omega = draw(beside_a_separatrix() if draw(st.booleans()) else spinning())
    inertia: Matrix = tensors.diagonal(diagonal)
    if draw(st.booleans()):
        turn = rotation(draw(st.integers(1, 5)), draw(st.integers(-5, 5)), 1, 2)
        inertia = tensors.product(tensors.product(turn, inertia), tensors.transpose(turn))
        omega = tensors.apply(turn, omega)
    clock = Clock(Fraction(0), (Fraction(1),))
    spin = Spin(omega, FRAME)
    return Scene("drawn", "", "euler", frozenset({"attitude"}), RigidBody(inertia), spin, clock)


def _overlap(examples: int) -> Callable[[], None]:
    @settings(
        max_examples=examples,
        deadline=None,
        derandomize=True,
        suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much],
    )
    @given(spins(), st.lists(times, min_size=1, max_size=2, unique=True))
    def routes_overlap(scene: Scene, instants: list[Fraction]) -> None:
        try:
            assert disagreement(scene, instants) == ""
        except Unsettled:
            # e^(-10^12) of an orbit that falls onto its axis has no digits within reach.
            assert is_homoclinic(scene)

    return routes_overlap


def is_homoclinic(scene: Scene) -> bool:
    return solution(scene, "arb").regime == "separatrix"


def test_on_bodies_drawn_at_random() -> None:
    """Nearly equal moments, ratios to 10^12, zero components, turned axes, |t| to 10^14."""
    _overlap(20)()


@pytest.mark.slow
def test_on_thousands_of_bodies() -> None:
    """The same for twelve hundred bodies."""
    _overlap(1200)()
