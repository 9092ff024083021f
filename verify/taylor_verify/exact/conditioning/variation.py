"""Growth of errors along an orbit, by its variational equations in float64.

They are integrated from one time to the next along a motion that starts at the truth and must arrive at
the truth. If float64 cannot follow the orbit that far, there is no answer. A product of such steps leads
from any time to any later time; no matrix is inverted.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import reduce
from itertools import pairwise
from typing import Any, Final, NamedTuple

import numpy as np
from mpmath import mp

from taylor_verify.exact import clocks
from taylor_verify.exact.clocks import Floats
from taylor_verify.exact.conditioning.flow import (
    Flow,
    Steps,
    applied,
    products,
)
from taylor_verify.exact.registry import kind_of
from taylor_verify.exact.route import solution
from taylor_verify.exact.rows import cross_matrices
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.scene import Scene

# The classical Runge-Kutta step errs by (h rate)^5/120 of the state, 3e-6.
_STEP: Final = 0.2
_MOST_STEPS: Final = 100_000
# Norms are wanted to a digit or two: a motion that misses the truth by this part of its size, or a
# step that changes volume by it, is not what was asked about.
_TOLERANCE: Final = 1e-4
# Between two times the motion is set back to the truth this often, where once is not enough.
_PARTS: Final = 4
# A ten-thousandth of the tolerance. The better of the two evaluations that agree to these digits has
# some more, if the orbit leaves them, and so starts the motion with what float64 holds.
_TRUTH_DIGITS: Final = 8
_FLOAT_DIGITS: Final = 20


def integrated(
    scene: Scene, flow: Flow, elapsed: Sequence[Fraction], more_digits: int = 0
) -> Steps | None:
    """The derivative of the motion between these times, or None where float64 does not follow it.

    ``more_digits`` of the truth keep its small components. The motion is set back to the truth at these
    times, and where it misses it so, between them too.
    """
    for parts in (1, _PARTS):
        points = [elapsed[0]]
        for begin, end in pairwise(elapsed):
            points += [begin + (end - begin) * Fraction(k, parts) for k in range(1, parts + 1)]
        truth = solution(scene).motion(points, _TRUTH_DIGITS + more_digits)
        with np.errstate(all="ignore"):  # what overflows is not finite, and then there is no answer
            parts_of_steps = _steps(scene, flow, points, truth)
            if parts_of_steps is not None:
                short, momentum, centre = parts_of_steps
                # Products of so many steps each.
                steps = reduce(
                    lambda product, part: part @ product, (short[k::parts] for k in range(parts))
                )
                return Steps(steps, products(steps), momentum[::parts], centre[::parts])
    return None


def _steps(
    scene: Scene, flow: Flow, points: Sequence[Fraction], truth: Motion
) -> tuple[Floats, Floats, Floats] | None:
    """The steps on (z, theta, c) from point to point, and z and c there, counted in the flow's units.

    A turn of the body moves its later path too. The centre counts from its start, and has no rows where
    it is not tracked.
    """
    with mp.workdps(_FLOAT_DIGITS):
        units = np.array([mp.convert(unit) for unit in flow.components])
        z = (kind_of(scene.body).momentum_rows(scene.body, truth) / units).astype(float)
        path = truth.quantities.get("centre", np.empty((0, 3), dtype=object))
        centre = ((path - path[:1]) / mp.convert(flow.length)).astype(float)
    n, d = z.shape
    R = truth.quantities.get("attitude", np.tile(np.eye(3), (n, 1, 1))).astype(float)
    clock = clocks.floats(scene.body.manufactured, points)
    nothing, identity = np.zeros((n - 1, 3, d)), np.tile(np.eye(d), (n - 1, 1, 1))
    arcs = _Arcs(clock[:-1], z[:-1], R[:-1], identity, nothing, nothing)
    spans = np.diff([float(t / flow.time) for t in points])
    reached = _followed(flow, arcs, spans)
    if reached is None or not _arrive(reached, z[1:], np.exp(flow.expansion * spans)):
        return None
    steps = np.tile(np.eye(d + 6), (n - 1, 1, 1))
    steps[:, :, :d] = np.concatenate([reached.by_momentum, reached.turn, reached.shift], axis=1)
    if len(centre):
        steps[:, d + 3 :, d : d + 3] = -cross_matrices(np.diff(centre, axis=0))
    return steps, z, centre


def _arrive(reached: _Arcs, truth: Floats, volumes: Floats) -> bool:
    """Return True if the arcs came to the truth, and their steps change volume as the flow does."""
    missed = np.linalg.norm(reached.momentum - truth, axis=1)
    volume = np.linalg.det(reached.by_momentum)
    close = missed <= _TOLERANCE * np.linalg.norm(truth, axis=1)
    return bool((close & (abs(volume / volumes - 1) <= _TOLERANCE * 10)).all())


# Many arcs of one body at once, each in its own steps.


class _Arcs(NamedTuple):
    """The ends of n arcs: w (n, m), z (n, d), R (n, 3, 3), and what errors of z at their starts became.

    ``by_momentum`` (n, d, d) are the derivatives of z, ``turn`` and ``shift`` (n, 3, d) those of theta
    and c.
    """

    clock: Floats
    momentum: Floats
    attitude: Floats
    by_momentum: Floats
    turn: Floats
    shift: Floats

    def only(self, places: Any) -> _Arcs:
        """The arcs at these places, an array of indices: always a copy."""
        return _Arcs(*(part[places] for part in self))

    def moved(self, rates: _Arcs, h: Floats) -> _Arcs:
        """Return the arcs advanced by h times their rates."""
        pairs = zip(self, rates, strict=True)
        return _Arcs(*(part + h.reshape(-1, *[1] * (part.ndim - 1)) * rate for part, rate in pairs))


def _followed(flow: Flow, arcs: _Arcs, spans: Floats) -> _Arcs | None:
    """Return every arc after its time span (n), or None if an arc is lost.

    By the classical Runge-Kutta method, each in steps that resolve its own Jacobian.
    """
    left, active = spans.copy(), np.arange(len(spans))
    # A copy, because the loop below writes into it.
    reached = arcs.only(active)
    for _ in range(_MOST_STEPS):
        current = reached.only(active)
        rate = flow.rate(current.momentum)
        if not np.isfinite(rate).all():
            return None
        whole = abs(left[active]) * rate <= _STEP
        h = np.where(whole, left[active], np.copysign(_STEP / rate, left[active]))
        for part, moved in zip(reached, _step(flow, current, h), strict=True):
            part[active] = moved
        left[active] -= h
        active = active[~whole]
        if not active.size:
            return reached
    return None


def _step(flow: Flow, at: _Arcs, h: Floats) -> _Arcs:
    first = _rates(flow, at)
    second = _rates(flow, at.moved(first, h / 2))
    third = _rates(flow, at.moved(second, h / 2))
    fourth = _rates(flow, at.moved(third, h))
    slopes = zip(first, second, third, fourth, strict=True)
    return at.moved(_Arcs(*((a + 2 * b + 2 * c + d) / 6 for a, b, c, d in slopes)), h)


def _rates(flow: Flow, at: _Arcs) -> _Arcs:
    jacobian, R = flow.jacobian(at.momentum), at.attitude
    turn = R @ (flow.equations.spin @ at.by_momentum)
    if not len(flow.equations.velocity):
        shift = np.zeros_like(turn)
    else:
        speed = applied(R, at.momentum @ flow.equations.velocity.T)
        shift = R @ (flow.equations.velocity @ at.by_momentum) - cross_matrices(speed) @ at.turn
    return _Arcs(
        clock=at.clock @ flow.turning.T,
        momentum=flow.load(at.clock) + flow.free(at.momentum),
        attitude=R @ cross_matrices(at.momentum @ flow.equations.spin.T),
        by_momentum=jacobian @ at.by_momentum,
        turn=turn,
        shift=shift,
    )
