"""Two routes to a closed form must overlap; no digit is lost after long times, or at balls of time."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np
import pytest
from builders.free_spins import rotation
from builders.numbers import has_route, overlap
from builders.scenes import FRAME, PLACE, everything, one_instant
from builders.turns import by_turns
from flint import arb, ctx
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from taylor_verify.exact.balls import Enclosed
from taylor_verify.exact.elements import elements
from taylor_verify.exact.kirchhoff.closed import case
from taylor_verify.exact.kirchhoff.quartic import Nutation
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import NO_CLOSED_FORM, Unsettled
from taylor_verify.numbers import tensors
from taylor_verify.numbers.irrational import ball
from taylor_verify.numbers.precision import exact_value
from taylor_verify.numbers.tensors import Matrix
from taylor_verify.scenes.bodies import Clebsch, RigidBody
from taylor_verify.scenes.library import EXTREMES, WORST, names
from taylor_verify.scenes.motion import Impulse, Motion, Spin
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


# Long times

FORTY = 40
PERIODS = 10**9
# 1e9 periods of 60 digits are known to 1e-51 of one.
PERIOD_DIGITS = 60


def closed_scenes() -> list[str]:
    """Return all but damped motions, which never recur."""
    shipped = [name for name in names() if name.startswith(("euler/", "kirchhoff/"))]
    return [name for name in shipped if recurs(load(name))]


def recurs(scene: Scene) -> bool:
    exact = solution(scene)
    return exact.regime != NO_CLOSED_FORM and not scene.body.damping


def period(scene: Scene) -> Fraction | None:
    """By complete integrals in mpmath, not by the lattice of the balls; None where there is none."""
    orbit = elements(scene, PERIOD_DIGITS)
    return exact_value(orbit["period"].value) if "period" in orbit else None


def recurring(motion: Motion, row: int, scene: Scene) -> list[Any]:
    """Return what a period brings back: omega, or x along the axis of symmetry and the lengths of x and y.

    About another origin y has another length, and a body without an axis is not asked for more than |x|.
    """
    if "omega" in motion.quantities:
        return list(motion["omega"][row])
    x, y = motion["linear_impulse"][row], motion["angular_impulse"][row]
    exact, length = case(scene), mp.norm(list(x))
    if isinstance(exact.subject, Nutation) and not exact.subject.axes.is_upright:
        n = exact.subject.axes.n
        along = sum(mp.convert(a) * b for a, b in zip(n, x, strict=True))
        return [along / mp.norm([mp.convert(a) for a in n]), length, mp.norm(list(y))]
    if exact.reduced.words:
        return [length]
    axis = (scene.body.axis_of_symmetry or 3) - 1
    return [x[axis], length, mp.norm(list(y))]


def missed(scene: Scene, span: Fraction) -> mpf:
    """How far from its start the motion is after this time, in parts of omega or of the impulses."""
    motion = solution(scene).motion([Fraction(0), span], FORTY)
    assert all(radius <= mpf(10) ** -FORTY for radius in motion.radius)
    with mp.workdps(PERIOD_DIGITS):
        start, end = (np.array(recurring(motion, row, scene), dtype=object) for row in (0, 1))
        scale = mp.norm(list(start))
        return mp.norm(list(end - start)) / scale if scale else mp.norm(list(end))


# Two vectors of 40 digits; for each, what its length and its component may be off by.
RETURNS = 4 * mpf(10) ** -FORTY


@pytest.mark.parametrize("name", by_turns(closed_scenes()))
def test_a_billion_periods_keep_forty_digits(name: str) -> None:
    """Every shipped closed form, all that it tracks; 1e9 units of time where there is no period."""
    scene = load(name)
    exact, once = solution(scene), period(scene)
    if once is not None:
        assert missed(scene, PERIODS * once) <= RETURNS
    else:
        motion = exact.motion([Fraction(PERIODS), -Fraction(PERIODS)], FORTY)
        assert all(radius <= mpf(10) ** -FORTY for radius in motion.radius)


@pytest.mark.slow
def test_no_extreme_scene_is_too_far() -> None:
    """Nor does any of the extremes with a closed form lose a digit: forty are proven of all of them."""
    is_answered = False
    for name in names(EXTREMES, WORST):
        scene = load(name)
        exact = solution(scene)
        if exact.regime != NO_CLOSED_FORM:
            (radius,) = exact.motion([PERIODS * (period(scene) or Fraction(1))], FORTY).radius
            assert radius <= mpf(10) ** -FORTY, name
            is_answered = True
    assert is_answered


@pytest.mark.parametrize("name", ["euler/generic", "kirchhoff/whole-motion"])
def test_a_period_wrong_in_its_45th_digit_is_noticed(name: str) -> None:
    """A billion times 1e-45 of a period is 1e-36, ten thousand times what is allowed."""
    scene = load(name)
    once = period(scene)
    assert once is not None
    off = once * (1 + Fraction(1, 10**45))
    assert not missed(scene, PERIODS * off) <= RETURNS


# Times that are balls


@cache
def free_forms() -> list[str]:
    """The shipped scenes without loads and wheels that have a closed form."""
    forms = []
    for name in names():
        scene = load(name)
        body = scene.body
        if body.is_free and not body.damping and "gyrostat" not in name:
            forms += [name] * has_route(scene, "arb")
    return forms


def all_that_is_closed(scene: Scene) -> Scene:
    """The scene with all that its closed form knows."""
    whole = everything(scene)
    return whole if has_route(whole, "arb") else scene


@pytest.mark.parametrize("name", free_forms())
def test_a_wide_ball_of_time_contains_the_motion_at_its_ends(name: str) -> None:
    """The enclosure at the ball 1/3 +- 1/1000 overlaps those at both of its ends and at its middle."""
    inner = solution(all_that_is_closed(load(name)), "arb")
    assert isinstance(inner, Enclosed)
    middle, reach = Fraction(1, 3), Fraction(1, 1000)
    with ctx.workprec(160):
        wide = inner.enclose([ball(middle) + arb(0, ball(reach))], 160)
        for t in (middle - reach, middle, middle + reach):
            narrow = inner.enclose([t], 160)
            for name, rows in narrow.items():
                pairs = zip(flat(wide[name][0]), flat(rows[0]), strict=True)
                assert all(one.is_finite() and one.overlaps(other) for one, other in pairs)


def flat(row: Any) -> list[Any]:
    """The entries of a vector or a matrix."""
    return [entry for part in row for entry in flat(part)] if hasattr(row, "__len__") else [row]
