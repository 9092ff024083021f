"""Torque-free Euler in mpmath: regimes, digits and limits.

test_exact_euler_balls compares the motion with that in balls.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

import pytest
from builders.free_spins import (
    EXTREMES,
    OBLIQUE,
    ON_SEPARATRIX,
    SPINS,
    near_separatrix,
    spinning,
    turned,
)
from builders.scenes import vector
from mpmath import mp, mpf

from taylor_verify.exact.euler.jacobi import free_rotation
from taylor_verify.exact.euler.regime import FreeSpin, Regime

DIGITS = 50


# Bodies, exactly


LONG = Fraction(10) ** 12
FAR = {
    **{name: (spin, -LONG) for name, spin in EXTREMES.items()},
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
    "axisymmetric, long": (SPINS["axisymmetric, irrational axis"], LONG),
    "max-axis, long": (SPINS["max-axis, full tensor"], -LONG),
}


# Measures


def omega_at(spin: FreeSpin, *times: Fraction | int, digits: int = DIGITS) -> list[list[mpf]]:
    """One evaluation of the closed form, with no second one to confirm it."""
    elapsed = [Fraction(t) for t in times]
    return [list(row) for row in free_rotation(spin).evaluate(elapsed, digits)["omega"]]


def distance(p: Sequence[mpf], q: Sequence[mpf]) -> mpf:
    """|p - q| / |q|, or |p| where q is zero."""
    size = mp.norm(list(q))
    return mp.norm([x - y for x, y in zip(p, q, strict=True)]) / (size if size > 0 else 1)


def one_ulp(digits: int) -> mpf:
    """A unit in the last of so many significant digits: what two rounded answers may differ by."""
    return mpf(10) ** (1 - digits)


# The regime


@pytest.mark.parametrize("name", SPINS)
def test_regime_is_decided_exactly(name):
    """Each orbit is of the kind it was built to be, whatever axes it is described in."""
    word = name.split(",")[0]
    assert SPINS[name].regime == word
    assert turned(OBLIQUE, SPINS[name]).regime == word


@pytest.mark.parametrize("word", [kind.value for kind in Regime])
def test_every_regime_is_among_the_orbits_tested(word):
    """No word of the documented list is without an orbit."""
    assert word in {spin.regime for spin in SPINS.values()}


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


@pytest.mark.parametrize("name", FAR)
def test_every_digit_asked_for_is_right(name):
    """An evaluation at 20, 40 or 60 digits agrees so far with one at 150: the guards suffice."""
    spin, t = FAR[name]
    best = omega_at(spin, t, digits=150)[0]
    for digits in (20, 40, 60):
        with mp.workdps(150):
            assert distance(omega_at(spin, t, digits=digits)[0], best) <= one_ulp(digits)


@pytest.mark.parametrize("side", [1, -1])
def test_separatrix_ends_on_the_intermediate_axis(side):
    """On the separatrix omega tends to opposite rotations about the intermediate axis."""
    a, b, c = ON_SEPARATRIX.omega
    spin = FreeSpin(ON_SEPARATRIX.inertia, (side * a, b, c))
    before, after = omega_at(spin, -(10**4), 10**4)
    with mp.workdps(DIGITS):
        # J2 w2' = (J3 - J1) w3 w1 never changes sign, and 2T = J2 w2^2 at both ends.
        limit = side * mp.sqrt(mp.convert(spin.twice_energy) * 2 / 5)
        for w, end in ((before, limit), (after, -limit)):
            # lam = 3/4 |limit|, where limit^2 > 1/2: e^-5000 is left of the other two components.
            assert max(abs(w[0]), abs(w[2])) <= mp.exp(-5000)
            assert distance([w[1]], [end]) <= one_ulp(DIGITS)
