"""The free body: its kind, decided exactly, and its motion in balls, against mpmath and Taylor series.

Bodies drawn at random are compared in test_two_routes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest
from builders.free_spins import EXTREMES, OBLIQUE, SPINS, near_separatrix, spinning, turned
from builders.numbers import overlap
from builders.scenes import one_instant, vector
from builders.turns import by_turns
from flint import arb
from mpmath import mp, mpf

from taylor_verify.exact import balls
from taylor_verify.exact.balls import Enclosed, Enclosure
from taylor_verify.exact.euler import closed, jacobi
from taylor_verify.exact.euler.closed import enclosed
from taylor_verify.exact.euler.regime import FreeSpin
from taylor_verify.exact.euler.rotations import Moving, RotationBalls
from taylor_verify.exact.gyrostat import sigma
from taylor_verify.exact.gyrostat.sigma import top_rotation
from taylor_verify.exact.lattice import Lattice
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.numbers.irrational import ball
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import IDENTITY, Quaternion, Spin
from taylor_verify.scenes.scene import Scene

DIGITS = 50
LONG = Fraction(10) ** 12
# Neither of unit length nor with a rational norm.
TILTED: Quaternion = (Fraction(1), Fraction(2), Fraction(-1), Fraction(3))


# Measures


def scene(spin: FreeSpin) -> Scene:
    return one_instant(RigidBody(spin.inertia), Spin(spin.omega, TILTED), "attitude")


def agrees_with_mpmath(spin: FreeSpin, at: Sequence[Fraction]) -> None:
    """The proven balls meet the other closed form, and are as narrow as was asked."""
    motion = enclosed(scene(spin)).motion(at, DIGITS)
    other = closed.closed_form(scene(spin)).motion(at, DIGITS)
    assert set(motion.quantities) == set(other.quantities) == {"omega", "attitude"}
    assert all(r <= mpf(10) ** -DIGITS for r in motion.radius)
    assert overlap(motion, other)
    alone = closed.closed_form(replace(scene(spin), track=frozenset())).motion(at, DIGITS)
    assert overlap(alone, replace(other, quantities={"omega": other["omega"]}))


# Against the other routes


@pytest.mark.parametrize("name", SPINS)
def test_agrees_with_mpmath(name: str) -> None:
    """Weierstrass's functions in the time itself, and AGM with R_J, lead to the same motion."""
    agrees_with_mpmath(SPINS[name], vector(0, "7/3", "-5/2", 31, LONG))


# An orbit and its times, which are far out.
FAR = {
    **{name: (spin, "7/3", -LONG) for name, spin in EXTREMES.items()},
    # One each for what costs guard digits, so far out that no other guard could cover for it.
    "time 1e60": (SPINS["max-axis"], Fraction(10**60)),
    "inertia ratio 1e40": (
        turned(OBLIQUE, spinning(vector("1e40", 3, 1), vector("1e-20", 2, "0.3"))),
        Fraction(1),
    ),
    "least moment 1e-40": (
        turned(OBLIQUE, spinning(vector("1e-40", "1.5", 1), vector(1, 1, 1))),
        Fraction(1, 10**30),
    ),
    "gap 1e-60": (
        turned(OBLIQUE, spinning(vector(2, Fraction(2 * 10**60 + 1, 10**60), 1), vector(1, 2, -1))),
        Fraction(10),
    ),
    "1e-60 beside the unstable axis": (
        turned(OBLIQUE, spinning(vector(3, 2, 1), vector("1e-60", 1, "1e-60"))),
        Fraction(300),
    ),
}


@pytest.mark.parametrize("name", FAR)
def test_extremes_agree_with_mpmath(name: str) -> None:
    """So they do next to the separatrix, the axes and symmetric bodies, for thin rods and long times."""
    spin, *at = FAR[name]
    agrees_with_mpmath(spin, vector(*at))


@pytest.mark.parametrize("name", by_turns(SPINS, 8))
def test_agrees_with_taylor(name: str) -> None:
    """The Taylor route, which knows no elliptic function, finds the same motion."""
    at = vector("7/3", "-5/2", 11)
    motion = enclosed(scene(SPINS[name])).motion(at, 40)
    assert overlap(motion, TaylorSolution(scene(SPINS[name])).motion(at, 40))


# The radius


class Coarse(Enclosed):
    """One quantity at times that are known only to ``spread``: its balls must hold all of them."""

    def __init__(self, rotation: RotationBalls, name: str, spread: Fraction) -> None:
        self.regime = rotation.regime
        self._rotation, self._name, self._spread = rotation, name, spread

    def enclose(self, elapsed: Sequence[Fraction], bits: int) -> Enclosure:
        blurred = [ball(t) + arb(0, ball(self._spread)) for t in elapsed]
        return {self._name: self._rotation.enclose(blurred, bits)[self._name]}


def radius_covers_the_error(spin: FreeSpin) -> None:
    """A midpoint is off by its radius at most, where the true error is known and nearly as large."""
    rotation, spread = top_rotation(spin, TILTED), Fraction(1, 10**25)
    at = [Fraction(k, 3) for k in range(1, 40)]
    for name in ("omega", "attitude"):
        motion = Coarse(rotation, name, spread).motion(at, 20)
        for moved in (spread, -spread):
            true = rotation.motion([t + moved for t in at], DIGITS)
            assert overlap(motion, replace(true, quantities={name: true[name]}))


RADIUS_SPINS = ("max-axis", "min-axis", "separatrix", "axisymmetric, oblate", "steady")


@pytest.mark.parametrize("name", RADIUS_SPINS)
def test_radius_covers_the_error(name: str) -> None:
    """The radius of a row holds where the error is known: at times blurred on purpose."""
    radius_covers_the_error(SPINS[name])


# Broken twins


def _wrong_sign_of_the_phase(patch: pytest.MonkeyPatch) -> None:
    right = sigma.Azimuth.turn
    patch.setattr(sigma.Azimuth, "turn", lambda self, t: right(self, t).conjugate())


def _backward(patch: pytest.MonkeyPatch) -> None:
    right = Lattice.real

    def wrong(self: Lattice, u: arb) -> tuple[arb, arb]:
        p, slope = right(self, u)
        return p, -slope

    patch.setattr(Lattice, "real", wrong)


def _transposed(patch: pytest.MonkeyPatch) -> None:
    right = sigma.Tumbling.rows

    def wrong(self: sigma.Tumbling, *arguments: Any) -> Moving:
        omega, turns = right(self, *arguments)
        return omega, [[list(column) for column in zip(*turn, strict=True)] for turn in turns]

    patch.setattr(sigma.Tumbling, "rows", wrong)


def _no_integral_of_the_third_kind(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(jacobi.Triaxial, "_integral", lambda self, *at: mpf(0))


def _half_a_digit_too_narrow(patch: pytest.MonkeyPatch) -> None:
    right = balls.widths

    def narrow(rows: Sequence[arb], count: int) -> tuple[Any, Any]:
        radii, doubles = right(rows, count)
        return radii / mp.sqrt(10), doubles

    patch.setattr(balls, "widths", narrow)


def _agrees(spin: FreeSpin) -> None:
    agrees_with_mpmath(spin, [Fraction(7, 3)])


@pytest.mark.parametrize("name", ["max-axis", "min-axis, backward"])
@pytest.mark.parametrize(
    ("twin", "check"),
    [
        *((_wrong_sign_of_the_phase, _agrees), (_backward, _agrees), (_transposed, _agrees)),
        (_no_integral_of_the_third_kind, _agrees),
        (_half_a_digit_too_narrow, radius_covers_the_error),
    ],
)
def test_broken_twin_is_caught(
    twin: Callable[[pytest.MonkeyPatch], None],
    check: Callable[[FreeSpin], None],
    name: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Each deliberate mistake fails the check named beside it, which the right code passes."""
    check(SPINS[name])
    twin(monkeypatch)
    with pytest.raises(AssertionError):
        check(SPINS[name])


# Zeros, moduli and frames


def test_exact_zeros_survive() -> None:
    """A component that is zero at the start in exact rationals is an exact zero, not a small ball."""
    for moments, omega in (
        (vector(3, 2, 1), vector(1, 0, "0.5")),
        (vector(3, 2, 1), vector(1, "-0.7", 0)),
        (vector(1, 3, 2), vector("0.9", "0.1", 0)),
    ):
        enclosure = top_rotation(spinning(moments, omega), IDENTITY).enclose([Fraction(0)], 100)
        assert [w.is_zero() for w in enclosure["omega"][0]] == [w == 0 for w in omega]


# The kind of a motion


@pytest.mark.parametrize("name", SPINS)
def test_regime_is_decided_exactly(name):
    """Each orbit is of the kind it was built to be, whatever axes it is described in."""
    word = name.split(",")[0]
    assert SPINS[name].regime == word
    assert turned(OBLIQUE, SPINS[name]).regime == word


@pytest.mark.parametrize(
    ("moments", "omega", "word"),
    [
        ((2, 2, 2), (0, 0, 0), "rest"),
        ((2, 2, 2), (1, 0, 0), "spherical"),
        ((2, 2, 1), (0, 0, 0), "rest"),
        ((2, 2, 1), (3, 4, 0), "steady"),
        ((2, 2, 1), (0, 0, 1), "steady"),
        ((3, 2, 1), (0, 1, 0), "steady"),
    ],
)
def test_the_simplest_description_wins(moments, omega, word):
    """Rest comes before the shape of the body, and a permanent rotation before its symmetry."""
    assert spinning(vector(*moments), vector(*omega)).regime == word


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("exponent", [20, 60, 400])
def test_regime_beside_the_separatrix(sign, exponent):
    """One part in 1e400 more or less of one component decides which axis is encircled."""
    spin = near_separatrix(Fraction(sign, 10**exponent))
    assert spin.regime == ("max-axis" if sign > 0 else "min-axis")
