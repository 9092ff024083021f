"""Steady screws of any solid: they are motions, there are three, and what is said of them is so."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from random import Random
from typing import Any

import numpy as np
import pytest
from flint import arb, ctx
from mpmath import mp, mpf

from taylor_verify.exact.balls import ball, midpoint
from taylor_verify.exact.elements import elements
from taylor_verify.exact.kirchhoff.screws import (
    Screw,
    Stability,
    is_steady,
    screws,
    screws_beside,
    turn_of,
)
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.models.problem import pose
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import exact_value, rung
from taylor_verify.numbers.tensors import Matrix
from taylor_verify.records.precisions import LADDER
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.reading.reader import load

F2 = Fraction(5, 4)


def drawn(seed: int) -> tuple[ImmersedBody, Fraction]:
    """A body with 21 coefficients and a positive T, and a lambda."""
    draw = Random(seed)

    def symmetric() -> list[list[Fraction]]:
        rows = [[Fraction(draw.randint(-2, 2), 10) for _ in range(3)] for _ in range(3)]
        return [
            [
                Fraction(draw.randint(10, 20), 10) if i == j else rows[max(i, j)][min(i, j)]
                for j in range(3)
            ]
            for i in range(3)
        ]

    while True:
        coupling = [[Fraction(draw.randint(-5, 5), 10) for _ in range(3)] for _ in range(3)]
        body = ImmersedBody(matrix(symmetric()), matrix(coupling), matrix(symmetric()))
        if tensors.is_positive_definite(body.energy_matrix):
            return body, Fraction(draw.randint(-20, 20), 10)


def matrix(rows: list[list[Fraction]]) -> Matrix:
    return tuple(tuple(row) for row in rows)


def times(rows: Any, vector: Any) -> list[arb]:
    return [sum((ball(e) * v for e, v in zip(row, vector, strict=True)), arb(0)) for row in rows]


def cross(a: Any, b: Any) -> list[arb]:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


@pytest.mark.parametrize("seed", range(8))
def test_x_and_y_of_a_screw_do_not_change(seed: int) -> None:
    """Put into 48 (3), (4) the rates enclose zero in narrow balls; |x| and Omega are as asked."""
    body, turn = drawn(seed)
    all_screws = screws(body, F2, turn)
    assert len(all_screws) == 3
    with ctx.workprec(128):
        for screw in all_screws:
            both = times(body.energy_matrix, [*screw.x, *screw.y])
            U, Omega = both[:3], both[3:]
            torque = zip(cross(screw.y, Omega), cross(screw.x, U), strict=True)
            for rate in (*cross(screw.x, Omega), *(p + q for p, q in torque)):
                assert rate.contains(0)
                assert rate.rad() < 1e-25
            assert all(
                (w - ball(turn) * x).contains(0) for w, x in zip(Omega, screw.x, strict=True)
            )
            assert (dot(screw.x, screw.x) - ball(F2)).contains(0)
            assert (screw.speed * ball(F2).sqrt() - dot(U, screw.x)).contains(0)


def dot(a: Any, b: Any) -> arb:
    return sum((p * q for p, q in zip(a, b, strict=True)), arb(0))


@pytest.mark.parametrize("seed", range(8))
def test_three_axes_across_each_other(seed: int) -> None:
    """One body, one lambda: the three x are orthogonal; with lambda = 0 the body only advances."""
    body, turn = drawn(seed)
    with ctx.workprec(128):
        one, two, three = screws(body, F2, turn)
        for a, b in ((one, two), (two, three), (three, one)):
            assert dot(a.x, b.x).contains(0)
            assert dot(a.x, b.x).rad() < 1e-25
        assert one.mu < two.mu < three.mu
        for screw in screws(body, F2, Fraction(0)):
            both = times(body.energy_matrix, [*screw.x, *screw.y])
            assert all(w.contains(0) for w in both[3:])
            assert all(w.contains(0) for w in cross(both[:3], screw.x))


@pytest.mark.parametrize("seed", range(8))
def test_only_the_least_mu_makes_the_energy_least(seed: int) -> None:
    """T - lambda x.y - m x.x/2 is positive for m just below the least mu, and for none above it."""
    body, turn = drawn(seed)
    for screw in screws(body, F2, turn):
        middle, little = exact_value(midpoint(screw.mu)), Fraction(1, 2**60)
        least = screw.stability is Stability.STABLE
        assert tensors.is_positive_definite(less(body, turn, middle - little)) is least
        assert not tensors.is_positive_definite(less(body, turn, middle + little))


def less(body: ImmersedBody, turn: Fraction, m: Fraction) -> Matrix:
    """The matrix of 2 T - 2 turn x.y - m x.x."""
    rows = [list(row) for row in body.energy_matrix]
    for n in range(3):
        rows[n][n] -= m
        rows[n][n + 3] -= turn
        rows[n + 3][n] -= turn
    return matrix(rows)


def jacobian(body: ImmersedBody, screw: Screw) -> Any:
    """By central differences of the rates, which are exact for products of two: in doubles."""
    energy = np.array([[float(e) for e in row] for row in body.energy_matrix])
    state = np.array([float(e.mid()) for e in (*screw.x, *screw.y)])

    def rates(s: Any) -> Any:
        both = energy @ s
        x, y, U, Omega = s[:3], s[3:], both[:3], both[3:]
        return np.concatenate([np.cross(x, Omega), np.cross(y, Omega) + np.cross(x, U)])

    return np.stack([(rates(state + e) - rates(state - e)) / 2 for e in np.eye(6)], axis=1)


@pytest.mark.parametrize("seed", range(12))
def test_the_spectrum_is_that_of_the_linearised_equations(seed: int) -> None:
    """Growth and swings against eigenvalues in doubles, and the statement that goes with them."""
    body, turn = drawn(seed)
    for screw in screws(body, F2, turn):
        exponents = np.linalg.eigvals(jacobian(body, screw))
        # A double eigenvalue 0 is found to the root of a rounding: 10^-7 or so of the matrix.
        rest = sorted(exponents, key=abs)[2:]
        if screw.stability is Stability.UNSTABLE:
            growth = float(screw.growth().mid())
            assert growth > 0
            assert abs(max(s.real for s in rest) - growth) <= 1e-6
        else:
            assert max(abs(s.real) for s in rest) <= 1e-6
            slow, fast = (float(rate.mid()) for rate in screw.swings())
            rates = sorted(abs(s.imag) for s in rest)
            assert np.allclose(rates, [slow, slow, fast, fast], atol=1e-6, rtol=0)


def test_a_disturbance_of_an_unstable_screw_grows_at_the_rate_stated() -> None:
    """The Taylor motion from 10^-25 beside it, between t = 30 and t = 60."""
    scene = load("kirchhoff/general-body")
    assert isinstance(scene.body, ImmersedBody)
    screw = screws_beside(scene)[1]
    assert screw.stability is Stability.UNSTABLE
    assert screw.c0 < 0  # one exponent grows, one decays, two swing
    x, y = ([exact_value(midpoint(e)) for e in v] for v in (screw.x, screw.y))
    beside = Impulse((x[0] + Fraction(1, 10**25), *x[1:]), tuple(y))
    times_ = [Fraction(30), Fraction(60)]
    motion = TaylorSolution(replace(scene, initial=beside)).motion(times_, 45)
    with mp.workdps(50):
        at = [
            mp.norm([a - mp.convert(b) for a, b in zip(row, x, strict=True)])
            for row in motion["linear_impulse"]
        ]
        # What swings beside it is e^{-0.4 30} of it: some 10^-5 of the logarithm.
        assert abs(mp.log(at[1] / at[0]) / 30 - midpoint(screw.growth())) <= mpf(10) ** -6


@pytest.mark.parametrize("step", LADDER)
def test_the_shipped_screw_is_steady_on_every_rung(step: str) -> None:
    """Exactly, and it is the second of three: held by its turning, not by its energy."""
    given = pose(load("kirchhoff/steady-screw"), rung(step)).given
    body, start = given.body, given.initial
    assert isinstance(body, ImmersedBody)
    assert isinstance(start, Impulse)
    assert is_steady(body, start)
    assert turn_of(body, start) == -1
    second = screws_beside(given)[1]
    assert second.stability is Stability.TO_FIRST_ORDER
    assert second.mu.contains(ball(Fraction(-1, 8)))
    ratio = start.linear[0] / start.linear[2]
    assert (second.x[0] - ball(ratio) * second.x[2]).contains(0)


def test_what_is_no_screw_is_not_called_one() -> None:
    """A start beside the screw is not steady, and bodies without three screws have none listed."""
    scene = load("kirchhoff/steady-screw")
    assert isinstance(scene.body, ImmersedBody)
    assert isinstance(scene.initial, Impulse)
    x = scene.initial.linear
    beside = replace(scene.initial, linear=(x[0] + Fraction(1, 2**80), *x[1:]))
    assert not is_steady(scene.body, beside)
    assert screws_beside(load("kirchhoff/four-real-roots")) == ()  # of revolution
    assert screws_beside(load("kirchhoff/constant-loads")) == ()
    assert screws_beside(load("kirchhoff/remus-100")) == ()  # two mu are equal
    assert screws_beside(load("euler/generic")) == ()


def test_explain_says_which_screws_are_stable() -> None:
    """One sentence for each of the three, with the word that was proven."""
    sentences = elements(load("kirchhoff/steady-screw")).sentences
    assert "The start is itself a steady screw." in sentences
    lines = [line for line in sentences if line.startswith("Screw ")]
    words = [s.stability.value for s in screws_beside(load("kirchhoff/steady-screw"))]
    assert len(lines) == 3
    assert all(word in line for word, line in zip(words, lines, strict=True))
    assert not any("itself" in line for line in elements(load("kirchhoff/general-body")).sentences)
