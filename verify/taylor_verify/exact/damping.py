"""Isotropic linear damping: z' = Q(z) - c z, where Q, the rates without damping, are quadratic.

With Z the motion of the body without damping from the same start,

    z(t) = e^{-ct} Z(tau),    tau = (1 - e^{-ct})/c,

while attitude and centre are those of Z at tau, without any factor: R' = R [w]x with the angular
velocity w(t) = e^{-ct} W(tau) = W dtau/dt, and likewise the velocity of the centre. So every regime is that
of the body without damping. For c > 0 all of the motion is that before tau = 1/c, for ever; for c < 0 tau
grows as e^{|c|t}, and as many digits are lost as it has.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import log
from typing import Any, Final, final

import numpy as np
from mpmath import mp, mpf

from taylor_verify.exact.carried import carried
from taylor_verify.exact.invariant import Array
from taylor_verify.exact.registry import kind_of
from taylor_verify.exact.solution import (
    Number,
    Quantities,
    Solution,
    Time,
    Unsettled,
)
from taylor_verify.numbers.irrational import ball
from taylor_verify.numbers.precision import floor_log2
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.mpfr import alike
from taylor_verify.scenes.scene import Scene

# If the phase has more digits than this before its point, an instant takes seconds.
_MOST_DIGITS: Final = 2000
# A motion that has decayed further has no digits that anybody reads.
_MOST_DECAY: Final = 1_000_000
NOT_QUADRATIC: Final = "damping together with a constant load or with wheels"


def is_solved(scene: Scene) -> bool:
    """Return True if the rates of the body without damping are quadratic: no loads and no wheels act."""
    free = scene.body.undamped
    equations = kind_of(free).equations(free)
    quadratic = not equations.constant.any() and not equations.linear.any()
    return quadratic


def decayed(exponent: Fraction, number: Number) -> Any:
    """Return e^{-x} for a rational x, as a ball or in mpmath."""
    if number is ball:
        return ball(-exponent).exp()
    with mp.extraprec(_bits_before_point(exponent)):
        return mp.exp(mp.convert(-exponent))


def elapsed_without(damping: Fraction, t: Fraction, number: Number) -> Time:
    """Return tau, the time of the undamped motion that corresponds to the time t of the damped one."""
    exponent = damping * t
    if not exponent:
        return t
    if number is ball:
        return ball(-exponent).expm1() / ball(-damping)
    with mp.extraprec(_bits_before_point(exponent)):
        tau: mpf = mp.expm1(mp.convert(-exponent)) / mp.convert(-damping)
    return tau


def growths(scene: Scene, elapsed: Sequence[Fraction]) -> Array | None:
    """Return e^{ct} for every time, in mpmath, where T e^{2ct} and the like are conserved; else None.

    These factors make the momenta of a damped motion those of the motion without damping.
    """
    body = scene.body
    if not body.damping or not body.is_conservative:
        return None
    return np.array([decayed(-body.damping * t, mp.convert) for t in elapsed], dtype=object)


def without_damping(scene: Scene, motion: Motion, elapsed: Sequence[Fraction]) -> Motion:
    """Return a motion with the momenta of each row times e^{ct}, where that makes them conserved."""
    factors = growths(scene, elapsed)
    if factors is None:
        return motion
    grown = dict(motion.quantities)
    for name in kind_of(scene.body).moving:
        grown[name] = motion[name] * alike(factors, motion[name])[:, None]
    return Motion(grown, motion.radius, motion.radii)


def _bits_before_point(exponent: Fraction) -> int:
    return max(0, floor_log2(exponent) + 1) if exponent else 0


@final
class Damped(Solution):
    """The motion of a damped body, by the closed form of the same body without damping."""

    def __init__(self, scene: Scene, free: Solution) -> None:
        self.regime, self.route = free.regime, free.route
        self._damping = damping = scene.body.damping
        moving = kind_of(scene.body).moving

        def slowed(rows: dict[str, Any], elapsed: Sequence[Time], number: Number) -> None:
            for k, t in enumerate(elapsed):
                factor = decayed(damping * t, number)
                for name in moving:
                    rows[name][k] = rows[name][k] * factor

        def clock(t: Time, number: Number) -> Time:
            return elapsed_without(damping, t, number)

        self._motion = carried(free, slowed, clock=clock)

    def motion(self, elapsed: Sequence[Fraction], digits: int) -> Motion:
        """The motion; Unsettled, with the rows of the other times, where tau has too many digits."""
        near = [k for k, t in enumerate(elapsed) if self._is_within_reach(t)]
        if len(near) == len(elapsed):
            return self._motion.motion(elapsed, digits)
        because = (
            "in the time of the motion without damping, instants lie at e^(|c| t)/|c|, which has more than "
            f"{_MOST_DIGITS} digits before its point"
        )
        if self._damping * elapsed[-1] > 0:
            because = f"less than e^-{_MOST_DECAY} of the momenta is left"
        if not near:
            raise Unsettled(because)
        raise Unsettled(because, self._motion.motion([elapsed[k] for k in near], digits), near)

    def evaluate(self, elapsed: Sequence[Fraction], digits: int) -> Quantities:
        if not all(map(self._is_within_reach, elapsed)):
            return self.motion(elapsed, digits).quantities
        return self._motion.evaluate(elapsed, digits)

    def _is_within_reach(self, t: Fraction) -> bool:
        return -Fraction(_MOST_DIGITS * log(10)) <= self._damping * t <= _MOST_DECAY
