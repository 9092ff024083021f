"""The functions that many free bodies are made of lie in their balls: against mpmath, with small radii."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf

from taylor_verify.exact.euler.series import (
    carlson,
    exponential,
    mean,
    nome_of,
    powers,
    sine_cosine,
    thetas,
)
from taylor_verify.exact.euler.tops import Tops
from taylor_verify.exact.route import solution
from taylor_verify.models.problem import pose
from taylor_verify.scenes.pairs import Pairs
from taylor_verify.scenes.precision import exact_value, rung
from taylor_verify.scenes.scene import Scene
from tests.builders.satellites import bodies_of, near_the_separatrix, satellites

# The other numbers have 40 digits, of which the last may be wrong.
ROOM = Fraction(1, 10**38)
MODULI = (0.02, 0.3, 0.7, 0.99)
NOMES = (1e-9, 0.01, 0.2, 0.44)
ANGLES = tuple((k + 0.499) * np.pi / 32 for k in range(-40, 80, 7))


@pytest.fixture(autouse=True)
def forty_digits() -> Iterator[None]:
    with mp.workdps(40):
        yield


def _excess(balls: Pairs, place: Any, exact: Fraction | mpf, largest: float = 1e-18) -> Fraction:
    """How far a number is outside of its ball, which has to be a small one."""
    radius = Fraction(float(balls.radius()[place]))
    assert radius <= largest
    middle, value = Fraction(float(balls.hi[place])) + Fraction(float(balls.lo[place])), exact
    if not isinstance(value, Fraction):
        value = exact_value(value)
    return abs(middle - value) - radius - ROOM * max(1, abs(value))


def _hold(
    balls: Pairs, exact: Callable[[mpf], mpf], arguments: Any, largest: float = 1e-18
) -> None:
    for place, argument in enumerate(arguments):
        assert _excess(balls, place, exact(mpf(float(argument))), largest) <= 0


def test_means_lie_in_their_balls() -> None:
    """The means of 1 and numbers are those of mpmath."""
    _hold(mean(Pairs(np.array(MODULI))), lambda k: mp.agm(1, k), MODULI)


@pytest.mark.parametrize("side", [-1, 1])
def test_the_mean_of_a_wide_ball_is_wide(side: int) -> None:
    """The mean of what is known to 10^-10 holds those of both ends."""
    wide = mean(Pairs(np.array([0.3]), 0.0, np.array([1e-10])))
    assert _excess(wide, 0, mp.agm(1, mpf(0.3) + side * mpf(1e-10)), 1e-7) <= 0


def test_nomes_lie_in_their_balls() -> None:
    """The nome of m and k' is exp(-pi K(m')/K(m))."""
    modulus = Pairs(np.array([1e-3, 0.01, *MODULI]))
    nome = nome_of(1.0 - modulus * modulus, modulus)
    _hold(nome, lambda k: mp.qfrom(m=1 - k * k).real, modulus.hi)


def test_sines_and_cosines_lie_in_their_balls() -> None:
    """Sine and cosine are those of mpmath, also half way between the angles of the table."""
    sine, cosine = sine_cosine(Pairs(np.array(ANGLES)))
    _hold(sine, mp.sin, ANGLES)
    _hold(cosine, mp.cos, ANGLES)


def test_exponentials_lie_in_their_balls() -> None:
    """The exponentials of numbers to 16 are those of mpmath."""
    arguments = (0.0, 0.3, 2.0, 15.9)
    _hold(exponential(Pairs(np.array(arguments))), mp.exp, arguments, 1e-15)


def test_integrals_of_carlson_lie_in_their_balls() -> None:
    """R_F is that of mpmath."""
    arguments = np.array([1 / 64, 0.5, 1.0, 3.0])
    values = carlson(Pairs(arguments), Pairs(arguments + 0.5), Pairs(np.ones(4)))
    _hold(values, lambda x: mp.elliprf(x, x + 0.5, 1), arguments)


@pytest.mark.parametrize("nome", NOMES)
def test_theta_functions_lie_in_their_balls(nome: float) -> None:
    """The four theta functions are those of mpmath, the first two over 2 q^(1/4)."""
    ones = np.ones(len(ANGLES))
    functions = thetas(powers(Pairs(nome * ones)), *sine_cosine(Pairs(np.array(ANGLES))))
    size = 2 * mpf(nome) ** 0.25
    for n, balls, unit in zip((1, 2, 3, 4), functions, (size, size, 1, 1), strict=True):
        _hold(balls, lambda w, n=n, unit=unit: mp.jtheta(n, w, nome) / unit, ANGLES)  # type: ignore[misc]


@pytest.mark.parametrize(
    "scenes",
    [
        satellites(6, 9, tracks_attitude=True),
        satellites(6, 10, tracks_attitude=True),
        near_the_separatrix(),
    ],
    ids=["some", "others", "near the separatrix"],
)
def test_exact_motions_lie_in_their_balls(scenes: list[Scene]) -> None:
    """The exact motions of many bodies are those of one body, to within the radii."""
    bodies = bodies_of(scenes)
    assert bodies.quaternion is not None
    states = Tops(bodies.inverse, Pairs(bodies.momentum), bodies.quaternion).states(bodies.times)
    assert states.quaternion is not None
    places = [0, 1, 20, 40]
    for k, scene in enumerate(scenes):
        given = pose(scene, rung("f64")).given
        times = [given.clock.elapsed[place] for place in places]
        # The grid holds the elapsed times as doubles, as the problem does.
        assert [float(t) for t in times] == bodies.times[k, places].tolist()
        omega = solution(given).motion(times, 40)["omega"]
        q = solution(given).quaternion(times, 40).quantities["quaternion"]  # type: ignore[attr-defined]
        for row, place in enumerate(places):
            for i in range(3):
                exact = exact_value(omega[row][i]) / Fraction(bodies.inverse[i, k])
                assert _excess(states.momentum, (i, k, place), exact, 1e-17) <= 0
            same = q[row][0] * states.quaternion.hi[0, k, place] > 0
            for i in range(4):
                exact = exact_value(q[row][i]) * (1 if same else -1)
                assert _excess(states.quaternion, (i, k, place), exact, 1e-17) <= 0
