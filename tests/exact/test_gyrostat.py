"""The free gyrostat: its closed form against the enclosure and the equations themselves."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import pytest
from builders.free_spins import rotation
from builders.gyrostats import MOTIONS, OMEGA, ROTOR, TRIAXIAL, paced, scene_of, turned
from builders.hostile_gyrostats import KINDS, hostile
from builders.numbers import apart
from builders.scenes import vector
from builders.turns import by_turns
from hypothesis import example, given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from taylor_verify.exact.elements import elements
from taylor_verify.exact.euler.closed import enclosed
from taylor_verify.exact.gyrostat.pencil import FreeGyrostat, Regime
from taylor_verify.exact.gyrostat.spins import steady_spins
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.numbers import tensors

DIGITS = 30
TINY = Fraction(1, 10**30)
INSTANTS = (Fraction(0), Fraction(7, 10), Fraction(-1), Fraction(5))

REGIMES = {
    "one real root": Regime.PERIODIC,
    "three real roots": Regime.PERIODIC,
    "wheels along axis 2": Regime.PERIODIC,
    "two equal moments, wheels across": Regime.PERIODIC,
    "two equal moments, wheels along": Regime.AXISYMMETRIC,
    "the same, oblique": Regime.AXISYMMETRIC,
    "three equal moments": Regime.SPHERICAL,
    "steady": Regime.STEADY,
    "rest": Regime.REST,
    "separatrix": Regime.SEPARATRIX,
    "separatrix, oblique": Regime.SEPARATRIX,
    "trigonometric": Regime.TRIGONOMETRIC,
    "cusp": Regime.CUSP,
    "circle": Regime.SEPARATRIX,
    "circle, no wheels": Regime.SEPARATRIX,
}
# Beside a border between two kinds of motion, and of sizes far apart.
EXTREMES = {
    "beside the separatrix": FreeGyrostat(
        *(lambda f: (f.inertia, f.rotor, (f.omega[0] + TINY, *f.omega[1:])))(MOTIONS["separatrix"])
    ),
    "beside the cusp": FreeGyrostat(
        *(lambda f: (f.inertia, f.rotor, (f.omega[0], f.omega[1] + TINY, f.omega[2])))(
            MOTIONS["cusp"]
        )
    ),
    "beside a steady spin": FreeGyrostat(TRIAXIAL, vector(0, 0, 2), (TINY, 2 * TINY, Fraction(1))),
    "beside a circle": FreeGyrostat(
        *(lambda f: (f.inertia, tensors.plus(f.rotor, (TINY, TINY, TINY)), f.omega))(
            MOTIONS["circle"]
        )
    ),
    "wheels all but along the axis": FreeGyrostat(
        tensors.diagonal(vector(10, 6, 10)), (TINY**2, Fraction(18), TINY**2), vector(6, 1, 4)
    ),
    "nearly equal moments": FreeGyrostat(
        tensors.diagonal((Fraction(1), 1 + TINY, Fraction(3))), ROTOR, OMEGA
    ),
    "weak wheels": FreeGyrostat(TRIAXIAL, tensors.scaled(TINY, ROTOR), OMEGA),
    "strong wheels": FreeGyrostat(TRIAXIAL, tensors.scaled(1 / TINY, ROTOR), OMEGA),
    "slow body": FreeGyrostat(TRIAXIAL, ROTOR, tensors.scaled(TINY, OMEGA)),
}

of_each_regime = pytest.mark.parametrize("name", by_turns(MOTIONS, 12, REGIMES.get))

# Of every kind that is hard, in its own axes or in turned ones.
gyrostats = st.builds(hostile, st.sampled_from(list(KINDS)), st.integers(0, 10**6))


def agrees_with_series(free: FreeGyrostat, instants: Sequence[Fraction]) -> None:
    scene = scene_of(free)
    balls, series = (make.motion(instants, 20) for make in (enclosed(scene), TaylorSolution(scene)))
    assert set(balls.quantities) == {"omega", "attitude"}
    with mp.workdps(40):
        assert apart(balls, series) <= 2 * mpf(10) ** -20


@pytest.mark.parametrize("name", REGIMES)
def test_the_kind_of_motion_is_decided_in_rationals(name: str) -> None:
    """Each start has the kind that it was made for, in its own axes and in turned ones."""
    assert MOTIONS[name].regime is REGIMES[name]
    assert turned(MOTIONS[name], rotation(2, 1, -3, 5)).regime is REGIMES[name]


# A pole at no finite place chooses no frame, nor is one beside three equal roots put on a root.
@given(gyrostats)
@example(hostile("double point", 62))
@example(hostile("beside a double point", 96))
@settings(max_examples=5)
def test_taylor_series_agree_for_any_gyrostat(free: FreeGyrostat) -> None:
    """Whatever the body, the wheels and the start, the closed form is the enclosed motion."""
    agrees_with_series(free, paced(free, (Fraction(3, 2), Fraction(-2))))


@pytest.mark.parametrize("name", EXTREMES)
def test_taylor_series_agree_at_the_borders(name: str) -> None:
    """Series know no pole of phi', which too few digits put on the double point at any precision."""
    agrees_with_series(EXTREMES[name], paced(EXTREMES[name], INSTANTS[:3]))


@pytest.mark.parametrize("name", ["circle", "circle, wheels along axis 1", "separatrix", "cusp"])
def test_an_endless_approach_is_followed(name: str) -> None:
    """No digit is lost where the orbit has all but come to its double point, and 1e5 units on."""
    agrees_with_series(MOTIONS[name], paced(MOTIONS[name], (Fraction(8), Fraction(-8))))
    far = enclosed(scene_of(MOTIONS[name])).motion([Fraction(10**5)], DIGITS)
    assert far.radius[0] <= mpf(10) ** -DIGITS


@of_each_regime
def test_taylor_series_agree(name: str) -> None:
    """Enclosed Taylor series, which know no elliptic function, find the same motion."""
    agrees_with_series(MOTIONS[name], INSTANTS[:3])


@given(gyrostats)
@settings(max_examples=15)
def test_spins_are_steady_and_their_growth_is_an_eigenvalue(free: FreeGyrostat) -> None:
    """|G| of (K - mu) G = g, by elimination, is as given, and d' = d x w + G x K d has s^2.

    The matrix J of that equation has no trace and no determinant: its eigenvalues are 0, s and -s, and
    s^2 is half the trace of J^2.
    """
    with mp.workdps(200):
        spins, N = steady_spins(free), mp.sqrt(mp.convert(free.n))
        K, g = mp.matrix([[mp.convert(c) for c in row] for row in free.K]), mp.matrix(free.g)
        for spin in spins if any(free.momentum) else []:
            mu = spin.rate / N
            moved = K - mu * mp.eye(3)
            if abs(mp.det(moved)) <= mpf(10) ** -60 * mp.norm(K) ** 3:
                continue  # G is free along an axis, or all but so
            G = mp.lu_solve(moved, g)
            assert abs(mp.norm(G) - N) <= mpf(10) ** -60 * N
            J = _hat(G) * K - _hat(mu * G)
            square = J * J
            assert abs(sum(square[i, i] for i in range(3)) / 2 - spin.square) <= (
                mpf(10) ** -60 * mp.norm(J) ** 2
            )


def _hat(v: Any) -> Any:
    """The matrix of d -> v x d."""
    return mp.matrix([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def test_the_signs_of_all_growths_are_proven() -> None:
    """Two spins that a wheel 1e-60 off the axis splits grow and wobble at a rate of 1e-30."""
    with mp.workdps(15):
        spins = steady_spins(EXTREMES["wheels all but along the axis"])
    wobbling, growing = ([s.square for s in spins if s.square * sign > 0] for sign in (-1, 1))
    assert (len(wobbling), len(growing)) == (3, 1)
    assert mpf("1e-61") < growing[0] < mpf("1e-55")
    assert mpf("1e-61") < -max(wobbling) < mpf("1e-55")


@given(gyrostats)
@settings(max_examples=40)
def test_stable_spins_are_two_more_than_unstable_ones(free: FreeGyrostat) -> None:
    """The energy on the sphere |H| = const has two more extrema than saddles (Poincare and Hopf)."""
    if not any(free.momentum):
        return
    with mp.workdps(DIGITS):
        spins = steady_spins(free)
    if free.spin.discriminant and all(spin.square for spin in spins):
        unstable = sum(spin.square > 0 for spin in spins)
        assert len(spins) - unstable == unstable + 2


@pytest.mark.parametrize(
    "free",
    [
        MOTIONS["three real roots"],
        MOTIONS["one real root"],
        MOTIONS["trigonometric"],
        EXTREMES["beside the separatrix"],
        EXTREMES["wheels all but along the axis"],
    ],
)
def test_the_precession_is_the_turn_of_a_period(free: FreeGyrostat) -> None:
    """After a period omega recurs, and R has turned about H by the precession of the elements."""
    scene = scene_of(free)
    numbers = elements(scene, 40)
    with mp.workdps(60):
        period = Fraction(mp.nstr(numbers["period"].value, 40))
        motion = enclosed(scene).motion([Fraction(0), period], 35)
        start, end = motion["attitude"]
        turn = end @ start.T
        cosine = (turn[0, 0] + turn[1, 1] + turn[2, 2] - 1) / 2
        assert abs(cosine - mp.cos(numbers["precession"].value)) < mpf(10) ** -30
        # The axis of the turn tells the sign, where there is one.
        momentum = start @ [mp.convert(c) for c in free.momentum]
        axis = [turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]
        sine = mp.fdot(axis, momentum) / (2 * mp.norm(momentum))
        assert abs(sine - mp.sin(numbers["precession"].value)) < mpf(10) ** -30
        assert apart_rows(motion["omega"]) < mpf(10) ** -30


def apart_rows(rows: Any) -> mpf:
    """The distance of two vectors."""
    return mp.norm(list(rows[1] - rows[0]))
