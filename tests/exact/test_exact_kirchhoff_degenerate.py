"""Clebsch's body where its quartic has a repeated root, wherever that and the start lie."""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

import pytest
from builders.clebsch import STOUT
from builders.numbers import apart
from builders.scenes import one_instant
from mpmath import mp, mpf

from taylor_verify.exact.kirchhoff.quartic import Nutation, repeated_root
from taylor_verify.exact.kirchhoff.regime import regime
from taylor_verify.exact.route import solution
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.scenes.bodies import Clebsch
from taylor_verify.scenes.motion import Impulse

DIGITS = 40


def nutation(solid: Clebsch, start: Sequence[Fraction]) -> Nutation:
    return Nutation.of(solid, Impulse(tuple(start[:3]), tuple(start[3:])))


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
    """Wherever the double root and the start lie, the closed form is the motion of Taylor.

    If p' >= p, f has one real root, or infinity, beyond each pole, so that only at a pole can one
    of them meet a turning point.
    """
    times = [Fraction(2), Fraction(-1)]
    for solid, start in random_double_roots(place, 3):
        n, root = nutation(solid, start), repeated_root(nutation(solid, start).f)
        assert root is not None
        assert root**2 == n.F2 or solid.p_prime < solid.p
        scene = one_instant(solid.body(), Impulse(tuple(start[:3]), tuple(start[3:])))
        truth = TaylorSolution(scene).motion(times, DIGITS)
        exact = solution(scene, "arb")
        assert exact.regime in ("hyperbolic", "trigonometric", "algebraic")
        with mp.workdps(DIGITS + 20):
            motion = exact.motion(times, DIGITS)
            assert apart(truth, motion) <= 2 * mpf(10) ** -DIGITS
