"""Two routes to a closed form, balls and mpmath, sharing no formula: they must overlap."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

import pytest
from builders.free_spins import rotation
from builders.numbers import overlap
from builders.routes import has_route
from builders.scenes import FRAME, PLACE, everything, one_instant
from builders.turns import by_turns
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from mpmath import mp

from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Unsettled
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Matrix
from taylor_verify.scenes.bodies import Clebsch, RigidBody
from taylor_verify.scenes.library import names
from taylor_verify.scenes.motion import Impulse, Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

Triple = tuple[Fraction, Fraction, Fraction]

DIGITS = 30


def agree(scene: Scene, times: list[Fraction]) -> bool:
    """Return True if the two routes agree within both radii, which are small."""
    motions = [solution(scene, route).motion(times, DIGITS) for route in ("arb", "mpmath")]
    is_narrow = all(radius <= mp.mpf(10) ** -DIGITS for m in motions for radius in m.radius)
    return is_narrow and overlap(*motions)


@pytest.mark.parametrize(
    "name", by_turns([name for name in names() if has_route(everything(load(name)), "mpmath")])
)
def test_on_every_shipped_scene(name: str) -> None:
    """Attitude and centre included, within the span of the scene, before it and after it."""
    scene = everything(load(name))
    end = scene.clock.elapsed[-1]
    assert agree(scene, [end / 7, end * Fraction(8, 9), -end / 3, 5 * end])


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
    return one_instant(RigidBody(inertia), Spin(omega, FRAME), "attitude")


@st.composite
def nutations(draw: st.DrawFn) -> Scene:
    """Clebsch's bodies: equal or nearly equal coefficients, starts on the axis, poles, small F.

    Some fall away from their axis, or all but do: x3 = F is a double root of f, but for a part of p'
    in up to 10^60.
    """
    p, r = draw(positive), draw(positive)
    p_prime = draw(st.one_of(positive, st.just(p), st.just(near(p, draw(st.integers(2, 30))))))
    r_prime = draw(st.one_of(positive, st.just(r)))
    q = draw(st.one_of(st.just(Fraction(0)), plain.map(lambda c: c / 10)))
    q_prime = draw(st.one_of(st.just(q), plain.map(lambda c: c / 10)))
    x, y = draw(vectors), draw(vectors)
    start = draw(st.sampled_from(["any", "any", "axis", "pole", "falling", "planar", "small"]))
    if start == "axis":
        x = (Fraction(0), Fraction(0), x[2])
    elif start in ("pole", "falling"):  # F is rational, and y3 = G: the pole is a root of f
        x = (Fraction(3, 5), Fraction(0), Fraction(4, 5))
        y = (y[0], y[1], 3 * y[0])
    if start == "falling":  # f'(F) = 0 too: f/(F - x3)^2 is finite there
        rise = r * (y[0] ** 2 + y[1] ** 2) + Fraction(2, 5) * (q - q_prime) * y[2]
        p_prime = p + rise * Fraction(25, 9) + draw(offsets)
    if start == "planar":
        x, y = (x[0], Fraction(0), x[2]), (Fraction(0), y[1], Fraction(0))
    elif start == "small":
        x = tensors.scaled(Fraction(1, 10 ** draw(st.integers(1, 12))), x)
    assume(q * q < p * r and q_prime * q_prime < p_prime * r_prime)
    body = Clebsch(p, p_prime, q, q_prime, r, r_prime).body()
    return one_instant(body, Impulse(x, y, FRAME, PLACE), "attitude", "centre")


def _overlap(examples: int, scenes: st.SearchStrategy[Scene]) -> Callable[[], None]:
    @settings(
        max_examples=examples,
        deadline=None,
        derandomize=True,
        suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much],
    )
    @given(scenes, st.lists(times, min_size=1, max_size=2, unique=True))
    def routes_overlap(scene: Scene, instants: list[Fraction]) -> None:
        assume(has_route(scene, "mpmath"))
        try:
            assert agree(scene, instants)
        except Unsettled:
            # e^(-10^12) of an orbit that falls onto its axis has no digits within reach.
            assert is_homoclinic(scene)

    return routes_overlap


def is_homoclinic(scene: Scene) -> bool:
    return solution(scene, "arb").regime in ("hyperbolic", "heteroclinic", "separatrix")


@pytest.mark.parametrize(("p", "p_prime"), [(1, 3), (3, 1), (1, 1 + Fraction(1, 10**24))])
@pytest.mark.parametrize("e", by_turns([21, 33, 60, 80]))
def test_on_starts_beside_a_pole_that_is_passed(e: int, p: int, p_prime: Fraction) -> None:
    """Where x leaves the axis by less than any working precision tells from nothing, on either side.

    mpmath had divided zero by zero at 1e-21, and found another motion at 1e-80.
    """
    body = Clebsch(*map(Fraction, (p, p_prime, 0, 0, 4, "1/100"))).body()
    for sign in (1, -1):
        x = (Fraction(0), sign * Fraction(5, 7) / 10**e, Fraction(6, 25))
        start = Impulse(x, (Fraction(7, 20), Fraction(0), Fraction(0)), FRAME, PLACE)
        scene = one_instant(body, start, "attitude", "centre")
        assert agree(scene, [Fraction(-7, 3), Fraction(5)])


@pytest.mark.parametrize("count", [12, pytest.param(1200, marks=pytest.mark.slow)])
@pytest.mark.parametrize("scenes", [spins(), nutations()], ids=["euler", "kirchhoff"])
def test_on_bodies_drawn_at_random(scenes: st.SearchStrategy[Scene], count: int) -> None:
    """Nearly equal moments, ratios to 10^12, zero components, turned axes, poles, |t| to 10^14."""
    _overlap(count, scenes)()
