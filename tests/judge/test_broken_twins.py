"""The sign of the phase of a solid in a fluid, turned on purpose in every regime, and by what it is seen.

Other faults of the closed forms stand beside their tests, in tests/exact. The witness is the Taylor route,
which knows nothing but the equations of motion. Both routes are broken alike wherever they decide a thing
in common: two wrong routes would agree with each other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cache
from typing import Any

import pytest
from builders.numbers import closed_routes
from builders.scenes import tracking_all
from builders.turns import by_turns
from mpmath import mp, mpf

from taylor_verify.exact.kirchhoff.plane import Plane
from taylor_verify.exact.kirchhoff.quartic import Nutation
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Unsettled
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

DIGITS = 20
# Both promise 20 digits of every vector and matrix.
AGREEMENT = 2 * mpf(10) ** -DIGITS
# What is wrong in kind, and no matter of digits, is wrong by more than this.
GROSS = mpf(10) ** -3

Patch = pytest.MonkeyPatch

# One shipped scene of every regime in which something moves, everything tracked.
REGIMES = {
    "steady": "kirchhoff/steady-precession",
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


def turn_back(patch: Patch) -> None:
    """x3 starts the other way, or x and y turn the other way where x3 rests; both routes ask this."""
    right, turn, rate = Nutation.of, Nutation.turn_rate.func, Plane.rate.fget
    patch.setattr(Nutation, "of", lambda *a: replace(right(*a), speed=-right(*a).speed))
    patch.setattr(Nutation, "turn_rate", property(lambda self: -turn(self)))
    patch.setattr(Plane, "rate", property(lambda self: -rate(self)))


@pytest.mark.parametrize(
    ("regime", "route"),
    by_turns((regime, route) for regime in REGIMES for route in closed_routes(scene(regime))),
)
def test_the_sign_of_the_phase_is_seen_in_every_regime(
    regime: str, route: str, monkeypatch: Patch
) -> None:
    """A motion that sets out in the other sense agrees with Taylor nowhere, and the right one does."""
    asked, times = scene(regime), [Fraction(1, 2), Fraction(3)]
    assert solution(asked, route).regime == regime
    assert off_taylor(asked, route, times) <= AGREEMENT
    turn_back(monkeypatch)
    assert off_taylor(asked, route, times) > GROSS
