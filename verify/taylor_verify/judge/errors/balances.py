"""The drift of a manufactured motion's balances that the rounding of the solver's clock causes.

z*, N  the motion that the loads are made for, and the rates of the free body: the load is z*' - N(z*)
a      error of the clock, cosine and sine of a wave of frequency nu, in axes that turn with the clock
zeta   change of z* by an offset of one in either of these axes; J the derivative of N
Q, u   the quantity of a balance; the unit roundoff

A solver carries the clock as states, and the rounding of a step there stays for ever: a is the sum of all
roundings so far. The state follows the clock and stays near the motion. But the loads of the run differ
from the given loads by zeta' - J(z*) zeta for each unit of a. So the balance of Q moves at a rate p a. With
P the integral of p, all N steps of a span T together leave by the time t

    p = dQ(z) . (zeta' - J(z*) zeta),     u r [ N/T int_0^t |P(t) - P(s)|^2 ds ]^(1/2),

where r^2 = (1 + h nu)^2 / 2 is the mean square of the rounding of one step of length h in either axis. This
drift and the drift by rounding the momenta are added as independent errors. If p has a nonzero mean, the
drift grows as the power 3/2 of time and finally dominates.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache
from math import ceil, pi
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.exact.invariants import Invariant, invariants
from taylor_verify.exact.rates import rates
from taylor_verify.exact.route import solution
from taylor_verify.records.quantities import MOMENTA
from taylor_verify.scenes.manufactured import Manufactured
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.mpfr import in_mpfr, precision, to_mpf, to_mpfr
from taylor_verify.scenes.scene import Scene

Floats = np.ndarray[Any, np.dtype[np.float64]]
Column = np.ndarray[Any, Any]

# The rate p is made of products of four waves at most.
_PRODUCTS: Final = 4
# Nodes per period of the fastest product: the midpoint rule is then correct to some percent.
_NODES_A_PERIOD: Final = 6
_LEAST_NODES, _MOST_NODES = 64, 2000
# Digits of the motion at the nodes: norms are needed to one or two digits.
_DIGITS: Final = 12


@dataclass(frozen=True)
class ClockWork:
    """The work of a clock offset on one quantity, accumulated at the ends of equal parts of a span.

    ``done`` (n + 1, m) is P over ``scale``, one column for an axis of a wave and a component of Q;
    ``turns`` (m) is nu T of its wave. ``span`` is T.
    """

    span: float
    scale: Any
    turns: Floats
    done: Floats

    def drift(self, unit_roundoff: Fraction, steps: int, times: Floats, scale: Any) -> Floats:
        """Return the drift by the roundings of the clock at these times, over ``scale``."""
        parts, count = len(self.done) - 1, max(steps, 1)
        rounding = (1 + np.minimum(self.turns / count, 1.0)) ** 2 / 2
        P = self.done
        middle = (P[1:] + P[:-1]) / 2
        first = np.vstack([np.zeros_like(P[:1]), np.cumsum(middle, axis=0)]) / parts
        second = np.vstack([np.zeros_like(P[:1]), np.cumsum(middle**2, axis=0)]) / parts
        share = np.arange(parts + 1)[:, None] / parts
        # int |P(t) - P(s)|^2 ds, multiplied out; cancellation may make it slightly negative.
        squares = np.maximum(share * P**2 - 2 * P * first + second, 0.0)
        left = np.sqrt(count * np.sum(rounding * squares, axis=1))
        # The later end of each part counts.
        places = np.minimum(np.ceil(times / self.span * parts).astype(int), parts)
        over_scale: Floats = float(unit_roundoff) * float(self.scale / scale) * left[places]
        return over_scale


@lru_cache(maxsize=16)
def clock_work(scene: Scene) -> Mapping[str, ClockWork]:
    """Return the work on every quantity that has a balance, by name; empty without waves.

    Raises Unsettled if the motion cannot be computed.
    """
    motion = scene.body.manufactured
    if motion is None or not motion.waves or not scene.clock.elapsed[-1]:
        return {}
    span = scene.clock.elapsed[-1]
    times = _middles(span, motion)
    # Enough digits for the difference of two motions if one is as small as a float64 can be.
    with mp.workdps(2 * _DIGITS):
        truth = in_mpfr(solution(scene).motion(times, _DIGITS))
        pushes = [
            (float(wave.frequency * abs(span)), push * (mp.convert(span) / len(times)))
            for wave, push in _pushes(scene, motion, times)
        ]
        with precision():
            return {
                invariant.name: _work(scene, invariant, truth, pushes, abs(float(span)))
                for invariant in invariants(scene)
            }


def _middles(span: Fraction, motion: Manufactured) -> list[Fraction]:
    """Return the midpoints of equal parts of the span, short beside the waves where that is affordable."""
    periods = _PRODUCTS * float(motion.highest * abs(span)) / (2 * pi)
    count = min(max(ceil(_NODES_A_PERIOD * periods), _LEAST_NODES), _MOST_NODES)
    return [span * Fraction(2 * k + 1, 2 * count) for k in range(count)]


def _work(
    scene: Scene,
    invariant: Invariant,
    truth: Motion,
    pushes: Sequence[tuple[float, Column]],
    span: float,
) -> ClockWork:
    scale = invariant.scale(truth)
    turns, columns = [], []
    for turn, push in pushes:
        # Q has at most degree two in the momenta, so the central difference is the exact derivative.
        there, back = (
            invariant.value(_displaced(scene, truth, sign * to_mpfr(push))) for sign in (1, -1)
        )
        increment = ((there - back) / 2 / scale).astype(float).reshape(len(push), -1)
        turns += [turn] * increment.shape[1]
        columns.append(increment)
    increments = np.hstack(columns)
    done = np.vstack([np.zeros_like(increments[:1]), np.cumsum(increments, axis=0)])
    return ClockWork(span, to_mpf(np.array([scale], dtype=object))[0], np.array(turns), done)


def _displaced(scene: Scene, motion: Motion, by: Column) -> Motion:
    """Return the motion with displaced momenta and the same frame."""
    moved = {name: motion[name] + part for name, part in _parts(scene, by).items()}
    return Motion({**motion.quantities, **moved}, motion.radius)


# The loads that a wrong clock gives.


def _pushes(scene: Scene, motion: Manufactured, times: Sequence[Fraction]) -> list[Any]:
    """Return, for both axes of each wave, the wave and zeta' - J(z*) zeta at every time, (n, d)."""
    angles = [[mp.cos_sin(mp.convert(w.frequency * t)) for t in times] for w in motion.waves]
    there = np.array([[mp.convert(z) for z in motion.constant]] * len(times), dtype=object)
    offsets = []
    for wave, pairs in zip(motion.waves, angles, strict=True):
        c, s = (np.array(column, dtype=object)[:, None] for column in zip(*pairs, strict=True))
        a, b = (
            np.array([[mp.convert(z) for z in row]], dtype=object)
            for row in (wave.cosine, wave.sine)
        )
        along, across = a * c + b * s, b * c - a * s
        there = there + along
        # An offset along the clock enlarges the wave, an offset across it delays the wave.
        nu = mp.convert(wave.frequency)
        offsets += [(wave, along, nu * across), (wave, across, -nu * along)]
    return [
        (wave, rate - (_free(scene, there + zeta) - _free(scene, there - zeta)) / 2)
        for wave, zeta, rate in offsets
    ]


def _free(scene: Scene, rows: Column) -> Column:
    """Return the rates of the body without loads; they have degree two, so differences are derivatives."""
    free = replace(scene, body=scene.body.with_motion(None), track=frozenset())
    zeros = np.array([mp.zero] * len(rows), dtype=object)
    derivative = rates(free, Motion(_parts(scene, rows), zeros))
    columns = [
        derivative.velocity[name]
        * np.array([mp.ldexp(1, derivative.units[name] - derivative.time)], dtype=object)
        for name in MOMENTA[scene.model]
    ]
    return np.concatenate(columns, axis=1)


def _parts(scene: Scene, rows: Column) -> dict[str, Column]:
    names = MOMENTA[scene.model]
    return {name: rows[:, 3 * k : 3 * k + 3] for k, name in enumerate(names)}
