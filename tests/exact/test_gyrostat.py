"""The free gyrostat: its closed form by two routes, against Taylor series and the equations themselves."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import pytest
from builders.free_spins import rotation
from builders.gyrostats import (
    MOTIONS,
    OMEGA,
    ROTOR,
    TILTED,
    TRIAXIAL,
    homoclinic,
    scene_of,
    turned,
)
from builders.numbers import apart
from builders.scenes import MOMENT, vector
from flint import arb, arb_mat, ctx
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from taylor_verify.exact.balls import ball
from taylor_verify.exact.elements import elements
from taylor_verify.exact.euler import theta
from taylor_verify.exact.euler.regime import FreeSpin
from taylor_verify.exact.gyrostat.closed import closed_form, enclosed
from taylor_verify.exact.gyrostat.pencil import FreeGyrostat, Regime
from taylor_verify.exact.gyrostat.sigma import GyrostatBalls
from taylor_verify.exact.gyrostat.spins import steady_spins
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import NoClosedForm
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.scenes import tensors
from taylor_verify.scenes.gyrostat import Gyrostat
from taylor_verify.scenes.motion import Clock, Spin
from taylor_verify.scenes.scene import Scene

DIGITS = 30
TINY = Fraction(1, 10**30)
INSTANTS = (Fraction(0), Fraction(7, 10), Fraction(-2), Fraction(5))

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
    "nearly equal moments": FreeGyrostat(
        tensors.diagonal((Fraction(1), 1 + TINY, Fraction(3))), ROTOR, OMEGA
    ),
    "weak wheels": FreeGyrostat(TRIAXIAL, tensors.scaled(TINY, ROTOR), OMEGA),
    "strong wheels": FreeGyrostat(TRIAXIAL, tensors.scaled(1 / TINY, ROTOR), OMEGA),
    "slow body": FreeGyrostat(TRIAXIAL, ROTOR, tensors.scaled(TINY, OMEGA)),
}

SMALL = st.integers(-20, 20)


@st.composite
def gyrostats(draw: st.DrawFn) -> FreeGyrostat:
    """Any free gyrostat; often beside a separatrix, with equal moments or with weak wheels."""
    moments = [Fraction(draw(st.integers(1, 30))) for _ in range(3)]
    if draw(st.booleans()):
        moments[1] = moments[0] * (
            1 + Fraction(draw(st.integers(0, 1)), 10 ** draw(st.integers(1, 30)))
        )
    vectors = st.tuples(SMALL, SMALL, SMALL).map(lambda v: tuple(map(Fraction, v)))
    body = tensors.diagonal(tuple(moments))
    if draw(st.booleans()):
        free = homoclinic(body, draw(vectors.filter(any)), draw(vectors.filter(any)))
        shift = Fraction(draw(st.integers(-1, 1)), 10 ** draw(st.integers(1, 60)))
        free = FreeGyrostat(body, free.rotor, (free.omega[0] + shift, *free.omega[1:]))
    else:
        rotor = tensors.scaled(Fraction(10) ** draw(st.integers(-30, 10)), draw(vectors))
        free = FreeGyrostat(body, rotor, draw(vectors))
    turn = rotation(*draw(st.tuples(SMALL, SMALL, SMALL, SMALL).filter(any)))
    return turned(free, turn) if draw(st.booleans()) else free


def slow(free: FreeGyrostat, instants: Sequence[Fraction]) -> list[Fraction]:
    """Return the instants in units of the time in which the motion turns by a radian or so."""
    rates = [*free.omega, *free.g, *tensors.apply(free.K, free.momentum)]
    pace = max(abs(rate) for rate in rates)
    return [t / pace for t in instants] if pace else list(instants)


def agree(free: FreeGyrostat, instants: Sequence[Fraction], digits: int = DIGITS) -> None:
    """Both closed forms are the same motion, to the digits asked for."""
    scene = scene_of(free)
    balls, other = (route(scene).motion(instants, digits) for route in (enclosed, closed_form))
    assert set(balls.quantities) == {"omega", "attitude"}
    with mp.workdps(2 * digits):
        assert apart(balls, other) <= 3 * mpf(10) ** -digits


@pytest.mark.parametrize("name", REGIMES)
def test_the_kind_of_motion_is_decided_in_rationals(name: str) -> None:
    """Each start has the kind that it was made for, in its own axes and in turned ones."""
    assert MOTIONS[name].regime is REGIMES[name]
    assert turned(MOTIONS[name], rotation(2, 1, -3, 5)).regime is REGIMES[name]


@pytest.mark.parametrize("name", MOTIONS)
def test_both_routes_agree(name: str) -> None:
    """Sigma quotients in balls, and Jacobi's functions with Carlson's integrals, are one motion."""
    agree(MOTIONS[name], INSTANTS)


@pytest.mark.parametrize("name", EXTREMES)
def test_both_routes_agree_at_the_borders(name: str) -> None:
    """So they are 1e-30 beside a separatrix, a cusp and a steady spin, and for h of any size."""
    agree(EXTREMES[name], slow(EXTREMES[name], INSTANTS))


@given(gyrostats())
@settings(max_examples=25)
def test_both_routes_agree_for_any_gyrostat(free: FreeGyrostat) -> None:
    """Whatever the body, the wheels and the start, the two closed forms differ by no more than asked."""
    agree(free, slow(free, (Fraction(3, 2), Fraction(-40))), 20)


@pytest.mark.parametrize("name", MOTIONS)
def test_taylor_series_agree(name: str) -> None:
    """Enclosed Taylor series, which know no elliptic function, find the same motion."""
    scene, instants = scene_of(MOTIONS[name]), INSTANTS[:3]
    balls, series = enclosed(scene).motion(instants, 20), TaylorSolution(scene).motion(instants, 20)
    with mp.workdps(40):
        assert apart(balls, series) <= 2 * mpf(10) ** -20


@pytest.mark.parametrize("name", MOTIONS)
def test_the_equations_are_obeyed(name: str) -> None:
    """Put back into (I w)' = (I w + h) x w and R' = R [w]x, the balls leave zero.

    A central difference of step s errs by s^2/6 |f'''|, and f''' is below 6 r^3 times the size of f, where
    r bounds every rate; the numbers are doubled for the motion within s of the instant.
    """
    free, t, step, bits = MOTIONS[name], Fraction(37, 11), Fraction(1, 10**40), 900
    with ctx.workprec(bits):
        found = GyrostatBalls(free, TILTED).enclose([t - step, t, t + step], bits)
        omega, rows = found["omega"], [arb_mat(R) for R in found["attitude"]]
        sizes = [sum(map(abs, v), Fraction(0)) for v in (free.momentum, free.g)]
        K_size = sum((free.K[i][i] for i in range(3)), Fraction(0))
        rate = ball(2 * (sizes[0] * K_size + sizes[1]) + 1)
        error = 2 * ball(step) ** 2 * 6 * rate**3 * arb(0, 1)
        slope = [
            (p - q) / ball(2 * step) + error * rate for p, q in zip(omega[2], omega[0], strict=True)
        ]
        inertia = arb_mat([[ball(c) for c in row] for row in free.inertia])
        whole = inertia * arb_mat(3, 1, omega[1]) + arb_mat(3, 1, [ball(c) for c in free.rotor])
        torque = inertia * arb_mat(3, 1, slope) - arb_mat(3, 1, _cross(whole.entries(), omega[1]))
        assert all(0 in entry for entry in torque.entries())
        x, y, z = omega[1]
        spun = rows[1] * arb_mat([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        turning = (rows[2] - rows[0]) / ball(2 * step)
        assert all(0 in entry + error for entry in (turning - spun).entries())
        # The statement has content: the balls are narrow beside the terms that cancel.
        assert all(entry.rad() <= arb(10) ** -30 for entry in [*torque.entries(), *spun.entries()])


def _cross(a: Sequence[Any], b: Sequence[Any]) -> list[Any]:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


@given(st.tuples(*[st.integers(1, 20)] * 3), st.tuples(SMALL, SMALL, SMALL).filter(any))
@settings(max_examples=30)
def test_without_wheels_it_is_eulers_top(moments: tuple[int, ...], spin: tuple[int, ...]) -> None:
    """Weierstrass's formula, without regimes, finds what theta functions find for a body without wheels."""
    inertia = tensors.diagonal(tuple(map(Fraction, moments)))
    omega = tuple(map(Fraction, spin))
    none = FreeGyrostat(inertia, vector(0, 0, 0), omega)
    instants = slow(none, (Fraction(3, 2), Fraction(-40)))
    found = GyrostatBalls(none, TILTED).motion(instants, 20)
    top = theta.free_rotation(FreeSpin(inertia, omega), TILTED).motion(instants, 20)
    with mp.workdps(40):
        assert apart(found, top) <= 2 * mpf(10) ** -20


@given(gyrostats())
@settings(max_examples=40)
def test_stable_spins_are_two_more_than_unstable_ones(free: FreeGyrostat) -> None:
    """The energy on the sphere |H| = const has two more extrema than saddles (Poincare and Hopf)."""
    if not any(free.momentum):
        return
    with mp.workdps(DIGITS):
        spins = steady_spins(free)
    if not free.has_equal_moments and all(spin.square for spin in spins):
        unstable = sum(spin.square > 0 for spin in spins)
        assert len(spins) - unstable == unstable + 2


def test_a_spin_of_the_middle_axis_is_made_stable_by_a_wheel() -> None:
    """A wheel along the middle axis, fast enough, makes the spin about it stable."""
    squares = []
    for rotor in (0, 5):
        free = FreeGyrostat(TRIAXIAL, vector(0, rotor, 0), vector(0, 1, 0))
        with mp.workdps(DIGITS):
            own = [spin for spin in steady_spins(free) if abs(spin.rate - 1) < mpf(10) ** -20]
        squares.append([mp.sign(spin.square) for spin in own])
    assert squares == [[1, 1], [-1]]


def test_the_precession_is_the_turn_of_a_period() -> None:
    """After a period omega recurs, and R has turned about H by the precession of the elements."""
    scene = scene_of(MOTIONS["three real roots"])
    numbers = elements(scene, 40)
    with mp.workdps(60):
        period = Fraction(mp.nstr(numbers["period"].value, 40))
        motion = closed_form(scene).motion([Fraction(0), period], 35)
        start, end = motion["attitude"]
        turn = end @ start.T
        angle = mp.acos((turn[0, 0] + turn[1, 1] + turn[2, 2] - 1) / 2)
        precession = numbers["precession"].value
        assert abs(min(precession, 2 * mp.pi - precession) - angle) < mpf(10) ** -30
        assert apart_rows(motion["omega"]) < mpf(10) ** -30


def apart_rows(rows: Any) -> mpf:
    """The distance of two vectors."""
    return mp.norm(list(rows[1] - rows[0]))


def test_a_moment_goes_to_the_enclosure() -> None:
    """Wheels together with a moment have no closed form; enclosed Taylor series answer."""
    body, start = Gyrostat(TRIAXIAL, ROTOR, MOMENT), Spin(OMEGA, TILTED)
    clock = Clock(Fraction(0), (Fraction(1),))
    scene = Scene("loaded", "loaded", "euler", frozenset({"attitude"}), body, start, clock)
    with pytest.raises(NoClosedForm, match="a moment acts on a body with wheels"):
        enclosed(scene)
    assert solution(scene).route == "taylor"
    assert elements(scene).regime == "no closed form"
