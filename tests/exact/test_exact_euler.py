"""Torque-free Euler in closed form: put back into the equation, and against two other routes."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from operator import mul

import pytest
from builders.free_spins import OBLIQUE, ON_SEPARATRIX, near_separatrix, rotation, spinning, turned
from builders.numbers import rational
from builders.scenes import vector
from builders.turns import by_turns
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from taylor_verify.exact.elements import elements
from taylor_verify.exact.euler.closed import closed_form
from taylor_verify.exact.euler.jacobi import free_rotation
from taylor_verify.exact.euler.orbit import Orbit, principal_frame
from taylor_verify.exact.euler.regime import FreeSpin, Regime
from taylor_verify.exact.euler.rotations import decades
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Clock, Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import Matrix

DIGITS = 50
ELLIPTIC = (Regime.MAX_AXIS, Regime.MIN_AXIS)


# Bodies, exactly


def as_doubles(matrix: Matrix) -> Matrix:
    """A tensor as it comes out of double precision: every entry rounded, symmetry kept."""
    return tuple(tuple(Fraction(float(entry)) for entry in row) for row in matrix)


# J = 2, 2, 9 about an axis along (1, 2, 3), whose length is irrational.
IRRATIONAL_AXIS: Matrix = tuple(
    tuple(Fraction(2 * (i == j)) + Fraction((i + 1) * (j + 1), 2) for j in range(3))
    for i in range(3)
)

ORBITS = {
    "max-axis": spinning(vector(1, 2, 3), vector("0.3", "0.2", -1)),
    "max-axis, w_a < 0": spinning(vector(3, 2, 1), vector("-1.3", "0.2", "-0.4")),
    "min-axis": spinning(vector(1, 3, 2), vector("0.9", "0.1", "-0.5")),
    "min-axis, oblique": turned(OBLIQUE, spinning(vector(5, 3, 2), vector("0.2", "-0.3", "-0.9"))),
    "max-axis, full tensor": FreeSpin(
        (vector(3, "0.1", "0.2"), vector("0.1", 2, "-1/3"), vector("0.2", "-1/3", 4)),
        vector("0.3", "0.1", "-0.7"),
    ),
    "separatrix": ON_SEPARATRIX,
    "separatrix, oblique": turned(OBLIQUE, ON_SEPARATRIX),
    "axisymmetric, oblate": spinning(vector(2, 5, 2), vector(1, "-0.4", "0.2")),
    "axisymmetric, prolate oblique": turned(
        OBLIQUE, spinning(vector(1, 4, 4), vector(1, "0.3", "0.2"))
    ),
    "axisymmetric, irrational axis": FreeSpin(IRRATIONAL_AXIS, vector("0.1", "0.7", "-0.4")),
    "spherical": spinning(vector(2, 2, 2), vector(1, 2, 3)),
    "steady": spinning(vector(1, 2, 3), vector(0, 1, 0)),
    "rest": spinning(vector(1, 2, 3), vector(0, 0, 0)),
}

# On symmetric planes in the principal axes (w_b = 0, w_c = 0), with either sign of the others, both
# with the axes exact and with axes that must be found.
PLANES = {
    f"{name} {omega}{', oblique' if oblique else ''}": (
        turned(OBLIQUE, spinning(vector(3, 2, 1), omega))
        if oblique
        else spinning(vector(3, 2, 1), omega)
    )
    for name, omegas in {
        "w_b = 0": (vector(1, 0, "0.5"), vector(-1, 0, "-0.5"), vector("0.2", 0, "-1")),
        "w_c = 0": (vector(1, "0.7", 0), vector(1, "-0.7", 0), vector(0, "0.7", -1)),
    }.items()
    for omega in omegas
    for oblique in (False, True)
}


LONG = Fraction(10) ** 12
EXTREMES = {
    "m' ~ 1e-24": (near_separatrix(Fraction(1, 10**24)), LONG),
    "m' ~ 1e-60": (near_separatrix(Fraction(-1, 10**60)), LONG),
    "m' ~ 1e-60, oblique": (turned(OBLIQUE, near_separatrix(Fraction(1, 10**60))), -LONG),
    "beside the unstable axis": (
        spinning(vector(3, 2, 1), vector("1e-30", 1, "2e-30")),
        Fraction(500),
    ),
    "beside the stable axis": (
        turned(OBLIQUE, spinning(vector(3, 2, 1), vector(1, "1e-25", "-3e-25"))),
        LONG,
    ),
    "inertia ratio 1e12": (
        spinning(vector("1e-12", "0.4", 1), vector("0.1", "1e-7", "1e-7")),
        LONG,
    ),
    "inertia ratio 1e12, oblique": (
        turned(OBLIQUE, spinning(vector("1e12", 3, 1), vector("1e-6", 2, "0.3"))),
        Fraction(10**6),
    ),
    "gap 1e-14": (spinning(vector(2, "2.00000000000001", 1), vector("0.6", "-1", "0.3")), LONG),
    "gap 1e-14, oblique": (
        turned(OBLIQUE, spinning(vector(2, "2.00000000000001", 3), vector(1, "-0.2", "0.3"))),
        LONG,
    ),
    "equal moments rounded to doubles": (
        FreeSpin(
            as_doubles(turned(OBLIQUE, spinning(vector(2, 2, 1), vector(0, 0, 0))).inertia),
            vector("0.3", 1, "-0.4"),
        ),
        LONG,
    ),
    # One each for what costs guard digits, so far out that no other guard could cover for it.
    "time 1e60": (ORBITS["max-axis"], Fraction(10**60)),
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
    "axisymmetric, long": (ORBITS["axisymmetric, irrational axis"], LONG),
    "max-axis, long": (ORBITS["max-axis, full tensor"], -LONG),
}


# Bodies drawn at random

SMALL = st.integers(-20, 20)
QUATERNIONS = st.tuples(SMALL, SMALL, SMALL, SMALL).filter(any)
MOMENTS = st.lists(st.integers(1, 60), min_size=3, max_size=3, unique=True)
OMEGAS = st.tuples(SMALL, SMALL, SMALL).filter(any)


@st.composite
def spins(draw: st.DrawFn) -> FreeSpin:
    """A body with three different moments in any orientation, spinning anyhow at a rate up to 2."""
    omega = tuple(Fraction(entry, 10) for entry in draw(OMEGAS))
    return turned(rotation(*draw(QUATERNIONS)), spinning(vector(*draw(MOMENTS)), omega))


# Measures


def omega_at(spin: FreeSpin, *times: Fraction | int, digits: int = DIGITS) -> list[list[mpf]]:
    """One evaluation of the closed form, with no second one to confirm it."""
    elapsed = [Fraction(t) for t in times]
    return [list(row) for row in free_rotation(spin).evaluate(elapsed, digits)["omega"]]


def numbers(entries: Sequence[Fraction]) -> list[mpf]:
    return [mp.convert(entry) for entry in entries]


def distance(p: Sequence[mpf], q: Sequence[mpf]) -> mpf:
    """|p - q| / |q|, or |p| where q is zero."""
    size = mp.norm(list(q))
    return mp.norm([x - y for x, y in zip(p, q, strict=True)]) / (size if size > 0 else 1)


def one_ulp(digits: int) -> mpf:
    """A unit in the last of so many significant digits: what two rounded answers may differ by."""
    return mpf(10) ** (1 - digits)


def pace(spin: FreeSpin) -> Fraction:
    """A rate rho with |d^n w/dt^n| <= n! rho^n |w|: |H| |I^-1| majorises the quadratic equation."""
    inverse = tensors.inverse(spin.inertia)
    return sum(map(abs, spin.momentum), Fraction(0)) * sum(
        (inverse[i][i] for i in range(3)), Fraction(0)
    )


# The independent routes


def theta_route(spin: FreeSpin, t: Fraction, digits: int = 220) -> list[mpf]:
    """omega(t) of a triaxial orbit by the textbook, with nothing taken from taylor_verify.exact.

    Moments and axes come from mpmath's symmetric eigenvalue routine, the functions from its theta
    functions, the start from the addition theorem; m' is 1 - m, so that ``digits`` must be lavish.
    """
    with mp.workdps(digits):
        ascending, columns = mp.eigsy(mp.matrix([numbers(row) for row in spin.inertia]))
        w0, H0 = numbers(spin.omega), numbers(spin.momentum)
        T2, H2 = mp.fdot(w0, H0), mp.fdot(H0, H0)
        order = (0, 1, 2) if H2 < T2 * ascending[1] else (2, 1, 0)  # the encircled axis first
        J1, J2, J3 = (ascending[k] for k in order)
        e1, e2, e3 = (list(columns[:, k]) for k in order)
        if mp.det(mp.matrix([e1, e2, e3])) < 0:
            e2 = [-entry for entry in e2]
        w1, w2, w3 = (mp.fdot(axis, w0) for axis in (e1, e2, e3))
        # J2 w2' = (J3 - J1) w3 w1 decides the sign with which sn enters.
        p1 = mp.sqrt((H2 - T2 * J3) / (J1 * (J1 - J3))) * (-1 if w1 < 0 else 1)
        p3 = mp.sqrt((T2 * J1 - H2) / (J3 * (J1 - J3)))
        p2 = mp.sqrt((T2 * J1 - H2) / (J2 * (J1 - J2))) * mp.sign((J3 - J1) * p1)
        lam = mp.sqrt((J1 - J2) * (H2 - T2 * J3) / (J1 * J2 * J3))
        m = (J2 - J3) * (T2 * J1 - H2) / ((J1 - J2) * (H2 - T2 * J3))
        s, c, d = w2 / p2, w3 / p3, w1 / p1
        S, C, N = (mp.ellipfun(name, lam * mp.convert(t), m=m) for name in ("sn", "cn", "dn"))
        den = 1 - m * (s * S) ** 2
        w1 = p1 * (d * N - m * s * S * c * C) / den
        w2 = p2 * (s * C * N + S * c * d) / den
        w3 = p3 * (c * C - s * S * d * N) / den
        return [w1 * x + w2 * y + w3 * z for x, y, z in zip(e1, e2, e3, strict=True)]


def taylor_route(spin: FreeSpin, t: Fraction, order: int = 60, bits: int = 240) -> list[mpf]:
    """omega(t) by steps of a Taylor series of the momentum, H' = H x K H, in fixed-point integers.

    The coefficients are below |H| rho^n (see pace): with steps h = 1/(8 rho) the remainder of each
    is 8^-60 |H|, 1e-54; the integers carry 72 decimals.
    """

    def fixed(value: Fraction) -> int:
        return round(value * 2**bits)

    K = [[fixed(entry) for entry in row] for row in tensors.inverse(spin.inertia)]
    steps = int(abs(t) * pace(spin) * 8) + 1
    h = fixed(t / steps)
    H = [fixed(component) for component in spin.momentum]
    for _ in range(steps):
        # Coefficients times h^n, of H and of omega.
        series, omega = [[c] for c in H], [[c] for c in _apply_fixed(K, H, bits)]
        for n in range(order):
            following = [
                (_convolved(series[j], omega[k]) - _convolved(series[k], omega[j]) >> bits)
                * h
                // ((n + 1) << bits)
                for j, k in ((1, 2), (2, 0), (0, 1))
            ]
            for target, new in ((series, following), (omega, _apply_fixed(K, following, bits))):
                for component, coefficient in zip(target, new, strict=True):
                    component.append(coefficient)
        H = [sum(component) for component in series]
    return [mp.ldexp(component, -bits) for component in _apply_fixed(K, H, bits)]


def _apply_fixed(matrix: list[list[int]], entries: list[int], bits: int) -> list[int]:
    return [sum(map(mul, row, entries)) >> bits for row in matrix]


def _convolved(p: list[int], q: list[int]) -> int:
    return sum(map(mul, p, reversed(q)))


# The regime


@pytest.mark.parametrize("name", ORBITS)
def test_regime_is_decided_exactly(name):
    """Each orbit is of the kind it was built to be, whatever axes it is described in."""
    word = name.split(",")[0]
    assert ORBITS[name].regime == word
    assert turned(OBLIQUE, ORBITS[name]).regime == word


@pytest.mark.parametrize("word", [kind.value for kind in Regime])
def test_every_regime_is_among_the_orbits_tested(word):
    """No word of the documented list is without an orbit."""
    assert word in {spin.regime for spin in ORBITS.values()}


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


@given(spins())
@settings(max_examples=50, deadline=None)
def test_invariants_do_not_depend_on_the_axes(spin):
    """The turned motion has the same trace, minors, determinant, discriminant, separation and T."""
    other = turned(OBLIQUE, spin)
    for name in ("trace", "minors", "determinant", "discriminant", "separation", "twice_energy"):
        assert getattr(other, name) == getattr(spin, name)


@given(MOMENTS)
@settings(max_examples=50, deadline=None)
def test_discriminant_is_the_product_of_the_squared_gaps(moments):
    """Written out in the moments, the two formulas for the discriminant are one polynomial."""
    x, y, z = moments
    spin = turned(OBLIQUE, spinning(vector(*moments), vector(0, 0, 0)))
    assert spin.discriminant == ((x - y) * (y - z) * (z - x)) ** 2


# The equation of motion


def residual(spin: FreeSpin, t: Fraction) -> mpf:
    """|w' - K (H x w)| / (rho |w|) at t, with w' from five values at steps of 1e-15/rho."""
    h = 1 / (pace(spin) * 10**15)
    around = omega_at(spin, *(t + k * h for k in (-2, -1, 0, 1, 2)), digits=80)
    far_back, back, w, ahead, far_ahead = around
    with mp.workdps(80):
        twelve_h = 12 * mp.convert(h)
        derivative = [
            (p - 8 * q + 8 * r - s) / twelve_h
            for p, q, r, s in zip(far_back, back, ahead, far_ahead, strict=True)
        ]
        H = [mp.fdot(numbers(row), w) for row in spin.inertia]
        torque = [H[1] * w[2] - H[2] * w[1], H[2] * w[0] - H[0] * w[2], H[0] * w[1] - H[1] * w[0]]
        expected = [mp.fdot(numbers(row), torque) for row in tensors.inverse(spin.inertia)]
        defect = [p - q for p, q in zip(derivative, expected, strict=True)]
        return mp.norm(defect) / (mp.norm(w) * mp.convert(pace(spin)))


# The five-point rule errs by h^4 |w^(5)|/30 <= 4 (h rho)^4 rho |w| = 4e-60 rho |w|. The rounding of
# 80 digits is multiplied by 18/(12 h rho), to 2e-65, in the derivative, and by |I| |w|/|H|, at most
# 1e20 among the extremes, in the momentum.
DIFFERENTIATION = mpf(10) ** -51


@pytest.mark.parametrize("t", [Fraction(1, 3), Fraction(-25, 2)])
@pytest.mark.parametrize("name", [name for name in ORBITS if name != "rest"])
def test_solution_satisfies_the_equation(name, t):
    """I w' = (I w) x w in every regime, before and after the start."""
    assert residual(ORBITS[name], t) <= DIFFERENTIATION


@pytest.mark.parametrize("name", EXTREMES)
def test_extreme_solution_satisfies_the_equation(name):
    """The equation holds to the same accuracy at times like 1e12, and on the most uneven bodies."""
    spin, t = EXTREMES[name]
    assert residual(spin, t) <= DIFFERENTIATION


@given(spins(), st.integers(-300, 300))
@settings(max_examples=25, deadline=None)
def test_any_body_satisfies_the_equation(spin, tenths):
    """The equation holds for tensors with three different moments in any orientation."""
    assume(any(spin.omega))
    assert residual(spin, Fraction(tenths, 10)) <= DIFFERENTIATION


ALL_ORBITS = {**ORBITS, **PLANES, **{name: spin for name, (spin, _) in EXTREMES.items()}}


@pytest.mark.parametrize("name", ALL_ORBITS)
def test_motion_starts_where_it_should(name):
    """At elapsed time zero omega is the initial omega: the phase is on the right branch."""
    spin = ALL_ORBITS[name]
    with mp.workdps(DIGITS + 10):
        assert distance(omega_at(spin, 0)[0], numbers(spin.omega)) <= one_ulp(DIGITS)


@pytest.mark.parametrize("name", ALL_ORBITS)
def test_energy_and_momentum_are_constant(name):
    """T and |H|^2 keep their exact initial values."""
    spin = ALL_ORBITS[name]
    for w in omega_at(spin, 1, Fraction(-77, 3), 10**6):
        with mp.workdps(DIGITS + 20):
            H = [mp.fdot(numbers(row), w) for row in spin.inertia]
            T2, H2 = mp.convert(spin.twice_energy), mp.convert(spin.momentum_squared)
            # An error d of omega changes 2T by 2 H.d, and |H|^2 by 2 (I H).d; |d| <= ulp |w|.
            reach = 2 * mp.norm(w) * one_ulp(DIGITS)
            assert abs(mp.fdot(H, w) - T2) <= reach * mp.norm(H)
            assert abs(mp.fdot(H, H) - H2) <= reach * mp.norm(H) * mp.convert(spin.trace)


# Independent routes


@pytest.mark.parametrize("name", by_turns([*ORBITS, *PLANES]))
def test_agrees_with_a_taylor_series(name):
    """Integrating H' = H x K H in integers gives the same omega, in every regime."""
    spin = ALL_ORBITS[name]
    t = Fraction(-3, 4)
    with mp.workdps(60):
        # At most a few hundred steps with remainders of 1e-54, hardly amplified in so short a time,
        # and the condition of K H.
        assert distance(omega_at(spin, t)[0], taylor_route(spin, t)) <= mpf(10) ** -49


TRIAXIAL = {
    name: (spin, t)
    for name, (spin, t) in {
        **{name: (spin, Fraction(-1234, 7)) for name, spin in {**ORBITS, **PLANES}.items()},
        **EXTREMES,
    }.items()
    if spin.regime in ELLIPTIC
}


@pytest.mark.parametrize("name", TRIAXIAL)
def test_agrees_with_theta_functions(name):
    """mpmath's eigenvectors and theta functions at lavish precision give the same omega."""
    spin, t = TRIAXIAL[name]
    with mp.workdps(DIGITS + 10):
        # 300 digits outlast 12 of time, 60 of 1 - m, 2 x 60 of the phase and the gaps, all at once.
        assert distance(omega_at(spin, t)[0], theta_route(spin, t, 300)) <= one_ulp(DIGITS)


@given(spins(), st.integers(-(10**6), 10**6))
@settings(max_examples=40, deadline=None)
def test_any_body_agrees_with_theta_functions(spin, t):
    """The two routes agree for tensors with three different moments in any orientation."""
    assume(spin.regime in ELLIPTIC)
    with mp.workdps(DIGITS + 10):
        assert distance(omega_at(spin, t)[0], theta_route(spin, Fraction(t))) <= one_ulp(DIGITS)


@pytest.mark.parametrize("name", EXTREMES)
def test_every_digit_asked_for_is_right(name):
    """An evaluation at 20, 40 or 60 digits agrees so far with one at 150: the guards suffice."""
    spin, t = EXTREMES[name]
    best = omega_at(spin, t, digits=150)[0]
    for digits in (20, 40, 60):
        with mp.workdps(150):
            assert distance(omega_at(spin, t, digits=digits)[0], best) <= one_ulp(digits)


@pytest.mark.parametrize("name", EXTREMES)
def test_motion_is_confirmed_at_the_first_attempt(name):
    """Two evaluations at precisions that differ by a dozen digits agree to the forty asked for."""
    spin, t = EXTREMES[name]
    radius = free_rotation(spin).motion([t], 40).radius
    # The poorer evaluation was made with 43 digits; a second attempt would have left far less.
    assert mpf(10) ** -55 <= radius[0] <= one_ulp(42)


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("exponent", [12, 24, 60])
def test_complementary_parameter_is_accurate_relatively(sign, exponent):
    """m' beside the separatrix has every digit of the working precision, with no guard."""
    spin = near_separatrix(Fraction(sign, 10**exponent))
    with mp.workdps(30):
        m_prime = Orbit(spin).m_prime
    with mp.workdps(200):
        exact = Orbit(spin)
        assert abs(exact.m + exact.m_prime - 1) <= mpf(10) ** -198
        # Some thirty roundings of 30 digits.
        assert distance([m_prime], [exact.m_prime]) <= 3 * one_ulp(29)


@pytest.mark.parametrize("gap", ["1e-10", "1e-40"])
@pytest.mark.parametrize("moment", [1, 3])
def test_gap_of_a_full_tensor_is_accurate_relatively(moment, gap):
    """The difference of two nearly equal moments comes from the discriminant to every digit."""
    moments = (Fraction(2), 2 + Fraction(gap), Fraction(moment))
    spin = turned(OBLIQUE, spinning(moments, vector(1, 1, 1)))
    with mp.workdps(30):
        frame = principal_frame(spin)
        frame_gap = frame.upper_gap if moment == 1 else frame.lower_gap
        # A dozen roundings of 30 digits.
        assert distance([frame_gap], [mp.convert(Fraction(gap))]) <= one_ulp(29)


def test_detest_b5_as_a_body():
    """J = (3, 2, 1) from (1, 0, q), q^2 = 1.53, is (dn, -q sn, q cn)(t | 0.51): DETEST B5."""
    with mp.workdps(100):
        root = mp.sqrt(mpf("1.53"))
        # Rounding the root at 100 digits moves the orbit by as much, times some powers of t = 20.
        spin = spinning(vector(3, 2, 1), (Fraction(1), Fraction(0), rational(root)))
        sn, cn, dn = (mp.ellipfun(name, 20, m=mpf("0.51")) for name in ("sn", "cn", "dn"))
        assert distance(omega_at(spin, 20)[0], [dn, -root * sn, root * cn]) <= one_ulp(DIGITS)


# Symmetries of the equation


@given(spins(), st.integers(-1000, 1000), st.integers(-1000, 1000))
@settings(max_examples=25, deadline=None)
def test_motion_may_be_resumed(spin, first, second):
    """Starting again from omega(t1), held exactly, and going on by t2 leads to omega(t1 + t2)."""
    assume(spin.regime in ELLIPTIC)
    t1, t2 = Fraction(first, 10), Fraction(second, 10)
    resumed = FreeSpin(spin.inertia, tuple(map(rational, omega_at(spin, t1, digits=120)[0])))
    with mp.workdps(120):
        # The rounding of the restart, 1e-120, grows like rho t/m'. Here 10^6 (2T)^3 p(r) is an
        # integer, A and C are below 43200, and m' >= D/A > 1e-20.
        assert distance(omega_at(resumed, t2)[0], omega_at(spin, t1 + t2)[0]) <= one_ulp(DIGITS)


@pytest.mark.parametrize("name", ["separatrix", "separatrix, oblique"])
def test_separatrix_may_be_resumed(name):
    """Started again one rounding off the separatrix, the elliptic orbit follows the hyperbolic."""
    spin, t = ORBITS[name], Fraction(5)
    w = omega_at(spin, t, digits=150)[0]
    resumed = FreeSpin(spin.inertia, tuple(map(rational, w)))
    with mp.workdps(150):
        # The rounding, 1e-150, grows by e^(10 lam) < e^10 in twice the time.
        assert distance(omega_at(resumed, t)[0], omega_at(spin, 2 * t)[0]) <= one_ulp(DIGITS)
        assert distance(omega_at(resumed, -t)[0], numbers(spin.omega)) <= one_ulp(DIGITS)


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


@pytest.mark.parametrize("name", [*ORBITS, *PLANES])
def test_reversing_the_spin_reverses_time(name):
    """From -omega(0) the body retraces its motion: -omega(-t)."""
    spin = ALL_ORBITS[name]
    reversed_spin = FreeSpin(spin.inertia, tensors.scaled(Fraction(-1), spin.omega))
    for t in (Fraction(7, 3), Fraction(-50)):
        with mp.workdps(DIGITS + 10):
            back = [-component for component in omega_at(spin, -t)[0]]
            assert distance(omega_at(reversed_spin, t)[0], back) <= one_ulp(DIGITS)


@pytest.mark.parametrize("name", ["max-axis", "min-axis", "separatrix", "axisymmetric, oblate"])
@pytest.mark.parametrize("order", list(itertools.permutations(range(3))))
def test_permuting_the_axes_permutes_the_solution(name, order):
    """The axes may be named in any order; an odd permutation is a reflection and reverses time."""
    spin, t = ORBITS[name], Fraction(29, 3)
    permutation = tuple(tuple(Fraction(int(order[i] == j)) for j in range(3)) for i in range(3))
    parity = tensors.dot(permutation[0], tensors.cross(permutation[1], permutation[2]))
    here, there = omega_at(spin, t * parity)[0], omega_at(turned(permutation, spin), t)[0]
    with mp.workdps(DIGITS + 10):
        assert distance(there, [here[k] for k in order]) <= one_ulp(DIGITS)


@given(spins(), QUATERNIONS)
@settings(max_examples=25, deadline=None)
def test_turning_the_axes_turns_the_solution(spin, quaternion):
    """In axes turned by an exact rotation Q the motion is Q omega(t)."""
    Q, t = rotation(*quaternion), Fraction(101, 7)
    here, there = omega_at(spin, t)[0], omega_at(turned(Q, spin), t)[0]
    with mp.workdps(DIGITS + 10):
        expected = [mp.fdot(numbers(row), here) for row in Q]
        assert distance(there, expected) <= 2 * one_ulp(DIGITS)


@given(spins(), st.integers(1, 50), st.integers(1, 50))
@settings(max_examples=25, deadline=None)
def test_scales_of_mass_and_time_are_free(spin, mass, speed):
    """Scaling the tensor changes nothing; omega(0) scaled by s gives s omega(s t)."""
    inertia = tuple(tensors.scaled(Fraction(mass), row) for row in spin.inertia)
    scaled = FreeSpin(inertia, tensors.scaled(Fraction(speed), spin.omega))
    t = Fraction(13, 3)
    slow, fast = omega_at(spin, t * speed)[0], omega_at(scaled, t)[0]
    with mp.workdps(DIGITS + 10):
        assert distance(fast, [speed * component for component in slow]) <= one_ulp(DIGITS)


# The interface


@dataclass(frozen=True)
class Question:
    """What of a scene the closed form depends on."""

    body: RigidBody
    initial: Spin
    track: frozenset[str] = frozenset({"omega"})

    def scene(self) -> Scene:
        clock = Clock(Fraction(0), (Fraction(0), Fraction(1)))
        return Scene("test", "test", "euler", self.track, self.body, self.initial, clock)


BODY = RigidBody(tensors.diagonal(vector(1, 2, 3)))
START = Spin(vector("0.3", 1, "0.2"))


def test_closed_form_of_a_scene():
    """A torque-free scene has a closed form that names its regime and its route."""
    solution = closed_form(Question(BODY, START).scene())
    # H^2 = 4.45 and 2T = 2.21: H^2/2T is a little more than the moment 2.
    assert (solution.regime, solution.route) == ("max-axis", "mpmath")
    motion = solution.motion([Fraction(0), Fraction(1)], 40)
    assert motion["omega"].shape == (2, 3)
    with mp.workdps(DIGITS):
        assert distance(motion["omega"][0], numbers(START.omega)) <= one_ulp(40)


def test_no_samples_are_no_rows():
    """An empty list of times gives an array of no rows and three columns."""
    assert free_rotation(ORBITS["max-axis"]).evaluate([], 30)["omega"].shape == (0, 3)


def test_evaluation_is_repeatable():
    """The same question has the same answer to the last bit, whatever was asked in between."""
    solution = free_rotation(ORBITS["max-axis, full tensor"])
    times = [Fraction(1, 3), Fraction(10)]
    first = solution.evaluate(times, 40)["omega"]
    solution.evaluate([LONG], 70)
    assert (first == solution.evaluate(times, 40)["omega"]).all()
    assert (
        first == free_rotation(ORBITS["max-axis, full tensor"]).evaluate(times, 40)["omega"]
    ).all()


@pytest.mark.parametrize("name", ["generic", "about-max-axis", "tennis-racket", "axisymmetric"])
def test_motion_recurs_after_the_period(name: str) -> None:
    """omega(t + P) = omega(t) for the period P among the elements, and m + m' = 1."""
    scene = load(f"euler/{name}")
    exact, numbers = closed_form(scene), elements(scene, 50)
    with mp.workdps(60):
        period = Fraction(*numbers["period"].value.as_integer_ratio())
        now, later = exact.motion([Fraction(3), Fraction(3) + period], 45)["omega"]
        # The period is known to 50 digits and omega changes by less than ten of itself in unit time.
        assert distance(later, now) <= mpf(10) ** -43
        if "m" in numbers:
            assert abs(numbers["m"].value + numbers["m_prime"].value - 1) <= mpf(10) ** -48


def test_separatrix_has_no_period() -> None:
    """On the separatrix m is 1 and there is a rate but no period."""
    orbit = elements(load("euler/separatrix"), 30)
    assert "period" not in orbit
    assert orbit["m_prime"].value == 0


@given(st.fractions(min_value=Fraction(1, 10**9), max_value=10**9))
def test_the_decades_of_a_ratio_are_a_close_upper_bound(ratio: Fraction) -> None:
    """Never too few, and at most those of one factor of two too many."""
    excess = decades(ratio) - math.log10(ratio)
    # Ten roundings of numbers below ten.
    assert -1e-13 <= excess <= math.log10(2) + 1e-13
