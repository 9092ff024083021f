"""Faults put into the closed forms on purpose, one kind after the other, and by what each is seen.

The witness is the Taylor route, which knows nothing but the equations of motion. Both routes are
broken alike wherever they decide a thing in common: two wrong routes would agree with each other.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cache
from typing import Any

import pytest
from builders.routes import closed_routes
from builders.scenes import tracking_all
from builders.turns import by_turns
from mpmath import mp, mpf

from taylor_verify.exact.elliptic import Landen
from taylor_verify.exact.euler import fixed_axis, jacobi
from taylor_verify.exact.euler import orbit as euler_orbit
from taylor_verify.exact.euler.regime import FreeSpin
from taylor_verify.exact.gyrostat import sigma
from taylor_verify.exact.kirchhoff import wave
from taylor_verify.exact.kirchhoff.plane import Plane
from taylor_verify.exact.kirchhoff.quartic import Nutation
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Unsettled
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.numbers import rotation
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

DIGITS = 20
# Both promise 20 digits of every vector and matrix.
AGREEMENT = 2 * mpf(10) ** -DIGITS
# What is wrong in kind, and no matter of digits, is wrong by more than this.
GROSS = mpf(10) ** -3

Patch = pytest.MonkeyPatch
Twin = Callable[[Patch], None]


# One shipped scene of every regime in which something moves, everything tracked.

REGIMES = {
    "steady": "euler/steady-middle-axis",
    "spherical": "euler/spherical",
    "axisymmetric": "euler/oblique-symmetry",
    "max-axis": "euler/full-tensor",
    "min-axis": "euler/with-attitude",
    "separatrix": "euler/separatrix",
    "steady, in a fluid": "kirchhoff/steady-precession",
    "euler-top": "kirchhoff/euler-top",
    "four-roots": "kirchhoff/whole-motion",
    "two-roots": "kirchhoff/two-real-roots",
    "cubic": "kirchhoff/cubic",
    "trigonometric": "kirchhoff/trigonometric",
    "hyperbolic": "kirchhoff/falling-away",
    "algebraic": "kirchhoff/algebraic-path",
    "heteroclinic": "kirchhoff/half-turn-path",
    "planar-swing": "kirchhoff/pendulum",
    "planar-turn": "kirchhoff/pendulum-front",
    "planar-front": "kirchhoff/pendulum-front",
    # Begun where cn is negative.
    "min-axis, cn < 0": "euler/with-attitude",
    "two-roots, cn < 0": "kirchhoff/no-axial-impulse",
}
# Starts that are in the middle of a swing: from where it turns back, both senses are one motion. The
# last stays on the border: r (p3 - p2) x2^2 = (r y1)^2 with p3 - p2 = 1/4 and r = 1.
STARTS = {
    "planar-turn": ((0, "4/5", "3/5"), ("9/10", 0, 0)),
    "planar-front": ((0, "4/5", "3/5"), ("2/5", 0, 0)),
}


@cache
def scene(regime: str) -> Scene:
    """The shipped scene of a regime with all that its model can track."""
    shipped = load(REGIMES[regime])
    moving = shipped.initial.moving
    if regime == "min-axis, cn < 0":
        moving = (*moving[:2], -moving[2])
    if regime in STARTS:
        moving = tuple(Fraction(entry) for vector in STARTS[regime] for entry in vector)
    return tracking_all(replace(shipped, initial=shipped.initial.with_moving(moving)))


def off_taylor(asked: Scene, route: str, times: Sequence[Fraction]) -> mpf:
    """The largest relative distance of a vector or matrix; infinite where the route has no answer."""
    try:
        motion = solution(asked, route).motion(times, DIGITS)
    except Unsettled:
        return mp.inf
    true = truth(asked, tuple(times))
    with mp.workdps(2 * DIGITS):
        return max(
            norm(row - exact) / (norm(exact) or 1)
            for name in true.quantities
            for row, exact in zip(motion[name], true[name], strict=True)
        )


@cache
def truth(asked: Scene, times: tuple[Fraction, ...]) -> Motion:
    return TaylorSolution(asked).motion(times, DIGITS)


def norm(entries: Any) -> mpf:
    return mp.norm(list(entries.flat))


# The sign of the phase.


def _backward_kirchhoff(patch: Patch) -> None:
    """x3 starts the other way, or x and y turn the other way where x3 rests; both routes ask this."""
    right, turn, rate = Nutation.of, Nutation.turn_rate.func, Plane.rate.fget
    patch.setattr(Nutation, "of", lambda *a: replace(right(*a), speed=-right(*a).speed))
    patch.setattr(Nutation, "turn_rate", property(lambda self: -turn(self)))
    patch.setattr(Plane, "rate", property(lambda self: -rate(self)))


def _backward_balls(patch: Patch) -> None:
    """-t for t where the body tumbles, and a turn in the other sense."""
    times, turn = sigma.balls_of, rotation.turn
    patch.setattr(sigma, "balls_of", lambda elapsed: [-t for t in times(elapsed)])
    for module in (rotation, sigma):
        patch.setattr(module, "turn", lambda axis, half: turn(axis, -half))


def _backward_floats(patch: Patch) -> None:
    """The same in mpmath."""
    phase, turn = euler_orbit.Orbit._phase_of, fixed_axis.turn
    precession = jacobi.Precession.__init__

    def precessing(self: jacobi.Precession, spin: FreeSpin) -> None:
        precession(self, spin)
        self.rate = -self.rate

    patch.setattr(euler_orbit.Orbit, "_phase_of", lambda *a: -phase(*a))
    patch.setattr(jacobi.Precession, "__init__", precessing)
    patch.setattr(fixed_axis, "turn", lambda axis, angle: turn(axis, -angle))


@pytest.mark.parametrize(
    ("regime", "route"),
    by_turns((regime, route) for regime in REGIMES for route in closed_routes(scene(regime))),
)
def test_the_sign_of_the_phase_is_seen_in_every_regime(
    regime: str, route: str, monkeypatch: Patch
) -> None:
    """A motion that sets out in the other sense agrees with Taylor nowhere, and the right one does."""
    asked, times = scene(regime), [Fraction(1, 2), Fraction(3)]
    assert solution(asked, route).regime == regime.partition(",")[0]
    assert off_taylor(asked, route, times) <= AGREEMENT
    if asked.model == "kirchhoff":
        _backward_kirchhoff(monkeypatch)
    else:
        (_backward_balls if route == "arb" else _backward_floats)(monkeypatch)
    assert off_taylor(asked, route, times) > GROSS


# Other faults of Jacobi's functions, in mpmath; those of the balls are beside the tests of the balls.


def _modulus_for_parameter(patch: Patch) -> None:
    """k for m, in both models."""

    def wrong(m: mpf, m_prime: mpf) -> Landen:
        del m_prime
        return Landen(mp.sqrt(m), 1 - mp.sqrt(m))

    for module in (euler_orbit, wave):
        patch.setattr(module, "Landen", wrong)


def _axes_exchanged(patch: Patch) -> None:
    """The axis of dn for that of cn."""
    right = euler_orbit.Orbit.functions

    def wrong(self: euler_orbit.Orbit, t: mpf) -> tuple[mpf, mpf, mpf]:
        sn, cn, dn = right(self, t)
        return sn, dn, cn

    patch.setattr(euler_orbit.Orbit, "functions", wrong)


def _one_branch_of_the_start(patch: Patch) -> None:
    """u_0 as if cn were positive at the start, in both models."""
    spin, swing = euler_orbit.Orbit._phase_of, wave.CosineWave._argument

    def rotating(self: euler_orbit.Orbit, sn: mpf, cn: mpf, dn: mpf) -> mpf:
        return spin(self, sn, abs(cn), dn)

    def swinging(self: wave.CosineWave, risen: mpf, left: mpf, speed: Fraction) -> mpf:
        u = swing(self, risen, left, speed)
        acute = min(abs(u), 2 * self.quarter_period - abs(u))
        return acute if u > 0 else -acute

    patch.setattr(euler_orbit.Orbit, "_phase_of", rotating)
    patch.setattr(wave.CosineWave, "_argument", swinging)


def _transposed(patch: Patch) -> None:
    """Space to body for body to space; in a fluid test_exact_kirchhoff_attitude has its own."""
    right = jacobi.Triaxial.at

    def wrong(self: jacobi.Triaxial, t: Fraction, turned: bool) -> Any:
        omega, frame = right(self, t, turned)
        return omega, jacobi.transposed(frame)

    patch.setattr(jacobi.Triaxial, "at", wrong)


def _windings_lost(patch: Patch) -> None:
    """An integral of the third kind that forgets its whole periods; in a fluid as above."""
    right = jacobi.Triaxial.__init__

    def wrong(self: jacobi.Triaxial, *arguments: Any) -> None:
        right(self, *arguments)
        self._complete = mpf(0)

    patch.setattr(jacobi.Triaxial, "__init__", wrong)


@pytest.mark.parametrize(
    ("twin", "regime"),
    [
        (_modulus_for_parameter, "max-axis"),
        (_modulus_for_parameter, "min-axis"),
        (_modulus_for_parameter, "four-roots"),
        (_modulus_for_parameter, "two-roots"),
        (_modulus_for_parameter, "cubic"),
        (_axes_exchanged, "max-axis"),
        (_axes_exchanged, "min-axis"),
        (_one_branch_of_the_start, "min-axis, cn < 0"),
        (_one_branch_of_the_start, "two-roots, cn < 0"),
        (_transposed, "max-axis"),
        (_transposed, "min-axis"),
        (_transposed, "separatrix"),
    ],
)
def test_a_fault_of_the_second_route_is_seen(twin: Twin, regime: str, monkeypatch: Patch) -> None:
    """With k for m, exchanged axes, a wrong branch of u_0 or R transposed, mpmath leaves Taylor."""
    asked, times = scene(regime), [Fraction(3)]
    assert off_taylor(asked, "mpmath", times) <= AGREEMENT
    twin(monkeypatch)
    assert off_taylor(asked, "mpmath", times) > GROSS


@pytest.mark.parametrize("regime", ["max-axis", "min-axis"])
def test_a_lost_winding_is_seen_after_a_turn_alone(regime: str, monkeypatch: Patch) -> None:
    """Within half a period nothing is lost yet, and the attitude is right; later it is not."""
    asked = scene(regime)
    early, late = [Fraction(1, 10)], [Fraction(20)]
    _windings_lost(monkeypatch)
    assert off_taylor(asked, "mpmath", early) <= AGREEMENT
    assert off_taylor(asked, "mpmath", late) > GROSS
