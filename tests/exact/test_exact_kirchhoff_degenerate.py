"""Clebsch's body where its quartic degenerates, held to its equations and to two other routes."""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

import pytest
from builders.clebsch import (
    FALLING,
    GENERIC,
    PLAIN,
    STOUT,
    UPRIGHT,
    around,
    at_the_border,
    body,
    derivative,
    falling,
    slope,
)
from builders.scenes import one_instant, vector
from builders.turns import by_turns
from mpmath import mp, mpf

from taylor_verify.exact.kirchhoff.closed import closed_form
from taylor_verify.exact.kirchhoff.jacobi import NutatingBody
from taylor_verify.exact.kirchhoff.quartic import Nutation, Polynomial, repeated_root, value
from taylor_verify.exact.kirchhoff.regime import regime
from taylor_verify.exact.solution import Quantities
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.scenes.bodies import Clebsch
from taylor_verify.scenes.motion import Impulse, Motion
from taylor_verify.scenes.scene import Scene

DIGITS = 40
# Both routes promise DIGITS of |x| and of |y|, which here are below 10.
AGREEMENT = Fraction(1, 10 ** (DIGITS - 2))


def scene(solid: Clebsch, start: Sequence[Fraction]) -> Scene:
    return one_instant(solid.body(), Impulse(tuple(start[:3]), tuple(start[3:])))


def nutation(solid: Clebsch, start: Sequence[Fraction]) -> Nutation:
    return Nutation.of(solid, Impulse(tuple(start[:3]), tuple(start[3:])))


def rows(motion: Motion | Quantities) -> list[list[mpf]]:
    """x1 x2 x3 y1 y2 y3 at each time."""
    pairs = zip(motion["linear_impulse"], motion["angular_impulse"], strict=True)
    return [[*x, *y] for x, y in pairs]


def distance(a: Sequence[mpf | Fraction], b: Sequence[mpf | Fraction]) -> mpf:
    with mp.workdps(DIGITS + 30):
        pairs = zip(a, b, strict=True)
        return max(abs(mp.convert(p) - mp.convert(q)) for p, q in pairs)


# Bodies whose quartic has a repeated root. With z0, F^2, FG, y3 and h = r (y1^2 + y2^2) of the
# start, and D = p - p', s = q - q',
#
#     f/r = (F^2 - z^2) [D (z^2 - z0^2) + 2 s y3 (z - z0) + h] - r (FG - y3 z)^2
#
# is linear in D and s: two conditions on f make them rational.


def doubled(start: Sequence[Fraction], d: Fraction, solid: Clebsch) -> Clebsch | None:
    """The body with p' and q' changed so that f(d) = f'(d) = 0, or None if there is none."""
    n, r = nutation(solid, start), solid.r
    y3, z0, gap = n.y3, n.z, n.F2 - d**2
    h = r * (start[3] ** 2 + start[4] ** 2)
    by_D, by_D_slope = d**2 - z0**2, 2 * d
    by_s, by_s_slope = 2 * y3 * (d - z0), 2 * y3
    level = gap * h - r * (n.FG - y3 * d) ** 2
    level_slope = -2 * d * h + 2 * r * y3 * (n.FG - y3 * d)
    a, b = gap * by_D, gap * by_s
    c, e = gap * by_D_slope - 2 * d * by_D, gap * by_s_slope - 2 * d * by_s
    determinant = a * e - b * c
    if determinant == 0:
        return None
    D = (b * level_slope - level * e) / determinant
    s = (level * c - a * level_slope) / determinant
    return positive(replace(solid, p_prime=solid.p - D, q_prime=solid.q - s))


def positive(solid: Clebsch) -> Clebsch | None:
    """The body if its energy is positive definite."""
    across = solid.p > 0 and solid.p * solid.r > solid.q**2
    along = solid.p_prime > 0 and solid.p_prime * solid.r_prime > solid.q_prime**2
    return solid if across and along else None


def required(solid: Clebsch | None) -> Clebsch:
    assert solid is not None
    return solid


EVEN = body(1, 1, "1/10", "1/10", 1, "1/2")  # p' = p, q' = q
SCREW = body(1, 1, "1/10", "3/10", 1, "1/2")  # p' = p
TAIL = Fraction(1, 10**6)
TAIL_Z = (1 - TAIL**2) / (1 + TAIL**2)
TAIL_X = 2 * TAIL / (1 + TAIL**2)
FAR_OUT = (TAIL_X, Fraction(0), TAIL_Z, (1 - TAIL_Z) / (2 * TAIL_X), TAIL_X / 3, Fraction(1, 2))
TURNING = vector("1/2", "1/3", "1/2", "1/4", "1/6", "-1/2")  # y parallel to x across the axis

CASES = {
    "falling from the pole": (falling(PLAIN, FALLING), FALLING, "hyperbolic"),
    "falling from the pole, screw": (falling(SCREW, FALLING), FALLING, "hyperbolic"),
    "falling from the pole, far out": (falling(PLAIN, FAR_OUT), FAR_OUT, "hyperbolic"),
    "falling from the pole, a cubic": (
        # q' makes the rise of `falling` vanish, so that p' = p.
        body(1, 1, 0, "25/18", 1, 9),
        vector("3/5", 0, "4/5", "1/6", "1/2", "1/2"),
        "hyperbolic",
    ),
    "quadratic": (EVEN, GENERIC, "trigonometric"),
    "quadratic, y3 = 0": (SCREW, (*GENERIC[:5], Fraction(0)), "trigonometric"),
    "quadratic, over both poles": (
        SCREW,
        vector("3/5", "1/5", "4/5", "1/5", "-3/5", 0),
        "trigonometric",
    ),
    "quadratic, from the axis": (EVEN, UPRIGHT, "trigonometric"),
    "quadratic, from the axis, over both poles": (
        SCREW,
        vector(0, 0, -1, "1/3", "1/7", 0),
        "trigonometric",
    ),
    "quadratic, from a turning point": (EVEN, TURNING, "trigonometric"),
    "border": (at_the_border(STOUT, FALLING), FALLING, "algebraic"),
    "heteroclinic": (PLAIN, vector("3/5", 0, "4/5", 0, "3/5", 0), "heteroclinic"),
    "heteroclinic downwards, F irrational": (
        body(1, 2, "1/5", "-1/3", 1, "1/2"),
        vector("1/2", 1, 1, 1, "-1/2", 0),
        "heteroclinic",
    ),
    "top": (SCREW, vector(0, 0, 0, "1/5", "-1/4", "2/3"), "euler-top"),
    "top about its axis": (SCREW, vector(0, 0, 0, 0, 0, "2/3"), "euler-top"),
}

by_case = pytest.mark.parametrize(("solid", "start", "kind"), list(CASES.values()), ids=list(CASES))
of_each_kind = pytest.mark.parametrize(
    ("solid", "start", "kind"),
    by_turns(CASES.values(), 5, lambda solid, start, kind: kind),
    ids=list(CASES),
)


@by_case
def test_starts_where_it_is_told_to(solid: Clebsch, start: Sequence[Fraction], kind: str) -> None:
    """The closed form names its regime, and at time zero it is the initial state."""
    solution = closed_form(scene(solid, start))
    assert solution.regime == kind
    assert distance(rows(solution.motion([Fraction(0)], DIGITS))[0], start) <= AGREEMENT


@of_each_kind
def test_agrees_with_the_taylor_route(solid: Clebsch, start: Sequence[Fraction], kind: str) -> None:
    """The Taylor route from the same start leads to the same states, both ways in time."""
    times = [Fraction(3, 2), Fraction(12), Fraction(-7, 3), Fraction(-10)]
    problem = scene(solid, start)
    states = rows(closed_form(problem).motion(times, DIGITS))
    expected = rows(TaylorSolution(problem).motion(times, DIGITS))
    for a, b in zip(states, expected, strict=True):
        assert distance(a, b) <= AGREEMENT


@by_case
def test_obeys_the_equations_of_motion(
    solid: Clebsch, start: Sequence[Fraction], kind: str
) -> None:
    """x' = x x Omega and y' = y x Omega + x x U, before and after the start."""
    # No rate here is above 10 per unit of time: differences err by less than 1e-48 * 1e9 / 630.
    h, digits = Fraction(1, 10**6), DIGITS + 10
    solution = closed_form(scene(solid, start))
    for middle in (Fraction(-39, 7), Fraction(13, 3)):
        near = rows(solution.evaluate(around(middle, h), digits))
        with mp.workdps(digits + 10):
            assert distance(slope(near, h), derivative(solid, near[4])) <= AGREEMENT


def random_start(rng: random.Random, place: str) -> tuple[Fraction, ...]:
    """Small rationals: anywhere, on the axis, at a turning point, or on the way to a pole."""

    def between(low: int, high: int) -> Fraction:
        return Fraction(rng.randint(6 * low, 6 * high), 6)

    x1, x2, x3, y1, y2, y3 = (between(-1, 1) for _ in range(6))
    if place == "axis":
        x1 = x2 = Fraction(0)
    if place == "turning point":
        y1, y2 = y1 * x1, y1 * x2
    if place == "to a pole":
        side = rng.choice([1, -1])
        x1, x2, x3, y1 = Fraction(3, 5), Fraction(0), Fraction(4 * side, 5), side * y3 / 3
    return x1, x2, x3, y1, y2, y3


def random_double_roots(place: str, number: int) -> list[tuple[Clebsch, tuple[Fraction, ...]]]:
    """Bodies with p, q, r fixed whose quartic from a random start has a random double root."""
    rng, cases = random.Random(place), list[tuple[Clebsch, tuple[Fraction, ...]]]()
    while len(cases) < number:
        start, d = random_start(rng, place), Fraction(rng.randint(-9, 9), 6)
        solid = doubled(start, d, STOUT) if any(start[:3]) else None
        if solid is None:
            continue
        n = nutation(solid, start)
        if regime(n) not in ("steady", "heteroclinic"):
            cases.append((solid, start))
    return cases


PLACES = ("anywhere", "axis", "turning point", "to a pole")


@pytest.mark.parametrize("place", PLACES)
def test_a_double_root_anywhere(place: str) -> None:
    """Wherever the double root and the start lie, the Taylor route finds the same motion."""
    times = [Fraction(2), Fraction(-5)]
    for solid, start in random_double_roots(place, 4):
        problem = scene(solid, start)
        solution = closed_form(problem)
        assert solution.regime in ("hyperbolic", "trigonometric", "algebraic")
        states = rows(solution.motion(times, DIGITS))
        expected = rows(TaylorSolution(problem).motion(times, DIGITS))
        for a, b in zip(states, expected, strict=True):
            assert distance(a, b) <= AGREEMENT


def test_double_roots_of_both_kinds_are_met() -> None:
    """The random double roots give hyperbolic and trigonometric motion; off the poles p' < p.

    If p' >= p, f has one real root, or infinity, beyond each pole, so that only at a pole can one
    of them meet a turning point.
    """
    met = set()
    for place in PLACES:
        for solid, start in random_double_roots(place, 4):
            n = nutation(solid, start)
            met.add(regime(n))
            root = repeated_root(n.f)
            assert root is not None
            assert root**2 == n.F2 or solid.p_prime < solid.p
    assert met >= {"hyperbolic", "trigonometric"}


ELEMENTARY = [
    name for name, (_, _, kind) in CASES.items() if kind not in ("euler-top", "trigonometric")
]


@pytest.mark.parametrize("name", ELEMENTARY)
def test_is_the_limit_of_elliptic_motions(name: str) -> None:
    """A body whose p' differs by 1e-60 moves in elliptic functions, and as good as alike."""
    solid, start, _ = CASES[name]
    beside = replace(solid, p_prime=solid.p_prime + Fraction(1, 10**60))
    times = [Fraction(5, 3), Fraction(-2)]
    neighbour = closed_form(scene(beside, start))
    assert neighbour.regime in ("four-roots", "two-roots")
    states = rows(closed_form(scene(solid, start)).motion(times, DIGITS))
    # In so short a time a difference grows by far less than 1e20.
    for a, b in zip(states, rows(neighbour.motion(times, DIGITS)), strict=True):
        assert distance(a, b) <= AGREEMENT


@pytest.mark.parametrize("name", [n for n in CASES if CASES[n][2] == "hyperbolic"])
def test_hyperbolic_motion_comes_from_the_double_root_and_returns(name: str) -> None:
    """On both sides x3 ends at the repeated root, which it approaches as e^(-sqrt(f''/2) |t|)."""
    solid, start, _ = CASES[name]
    n = nutation(solid, start)
    d = repeated_root(n.f)
    assert d is not None
    square, cubic, quartic = _expanded(n.f, d)
    assert square > 0
    for side in (1, -1):
        times = [Fraction(side * t) for t in (100, 101)]
        z = [row[2] for row in rows(closed_form(scene(solid, start)).motion(times, 300))]
        with mp.workdps(300):
            first, second = (at - mp.convert(d) for at in z)
            pace = mp.exp(-mp.sqrt(mp.convert(square)))
            # What the ratio lacks is of the size of z - d itself.
            size = mp.convert((abs(cubic) + abs(quartic)) / square) + 1
            assert abs(second / first - pace) <= 10 * size * abs(first)
            assert 0 < abs(first) <= mpf(10) ** -12


def _expanded(f: Polynomial, d: Fraction) -> tuple[Fraction, Fraction, Fraction]:
    """The coefficients of (z-d)^2, (z-d)^3, (z-d)^4 of f, by Horner's scheme."""
    coefficients = list((Fraction(0),) * (5 - len(f)) + f)
    for end in range(5, 0, -1):
        for k in range(1, end):
            coefficients[k] += d * coefficients[k - 1]
    return coefficients[2], coefficients[1], coefficients[0]


@pytest.mark.parametrize("name", [n for n in CASES if CASES[n][2] == "trigonometric"])
def test_trigonometric_motion_recurs(name: str) -> None:
    """x3 and y1^2 + y2^2 recur after a million periods, and x3 is elsewhere after half of one."""
    solid, start, _ = CASES[name]
    solution = closed_form(scene(solid, start))
    assert isinstance(solution, NutatingBody)
    with mp.workdps(80):
        period = Fraction(str(solution.elements(70)["period"]))
    whole, third = rows(solution.motion([10**6 * period, period / 3], DIGITS))
    assert distance([whole[2]], [start[2]]) <= AGREEMENT
    with mp.workdps(DIGITS + 20):
        size = whole[3] ** 2 + whole[4] ** 2
    assert distance([size], [start[3] ** 2 + start[4] ** 2]) <= 10 * AGREEMENT
    assert distance([third[2]], [start[2]]) > Fraction(1, 1000)


def test_only_elliptic_and_trigonometric_motion_recurs() -> None:
    """Where x3 never returns, the period is infinite."""
    for name in ELEMENTARY:
        solution = closed_form(scene(*CASES[name][:2]))
        assert isinstance(solution, NutatingBody)
        assert "period" not in solution.elements(20)


def _times(a: Polynomial, b: Polynomial) -> Polynomial:
    product = [Fraction(0)] * (len(a) + len(b) - 1)
    for i, c in enumerate(a):
        for j, d in enumerate(b):
            product[i + j] += c * d
    return tuple(product)


@pytest.mark.parametrize(
    ("factor", "times"), [((1, 0, 1), 2), ((1, 5), 3), ((1, -1, -3), 2), ((2,), 2)]
)
def test_a_single_repeated_root_is_found(factor: tuple[int, ...], times: int) -> None:
    """The repeated root is exact, whatever the others are."""
    root = Fraction(-7, 3)
    polynomial = vector(*factor)
    for _ in range(times):
        polynomial = _times(polynomial, (Fraction(1), -root))
    assert value(polynomial, root) == 0
    assert repeated_root(polynomial) == root


@pytest.mark.parametrize("square", [(1, 0, -2), (1, 0, 1), (1, -1, 0)])
def test_two_repeated_roots_are_not_one(square: tuple[int, ...]) -> None:
    """A square of a quadratic with distinct roots has no single repeated root."""
    assert repeated_root(_times(vector(*square), vector(*square))) is None
    assert repeated_root(vector(*square)) is None
