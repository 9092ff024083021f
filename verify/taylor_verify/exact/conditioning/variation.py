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
from math import prod
from typing import Final, NamedTuple

import numpy as np
from mpmath import mp

from taylor_verify.exact.conditioning.extrapolation import FINE, ROUGH, extrapolated
from taylor_verify.exact.conditioning.linearised import Flow, Steps, applied, products
from taylor_verify.exact.quadratic_forms import Floats
from taylor_verify.exact.registry import kind_of
from taylor_verify.exact.route import solution
from taylor_verify.exact.row_arithmetic import cross_matrices
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.scene import Scene

# Steps in radians of the fastest rate: one errs by less than 1e-6 of the state, and by its rounding.
_ROUGH_STEP: Final = 0.5
_FINE_STEP: Final = 0.75
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
    scene: Scene,
    elapsed: Sequence[Fraction],
    more_digits: int = 0,
    is_rough: bool = False,
) -> Steps | None:
    """The derivative of the motion between these times, or None where float64 does not follow it.

    ``more_digits`` of the truth keep its small components. The motion is set back to the truth at these
    times, and where it misses it so, between them too. If ``is_rough``, each step is right to about six
    digits, which is enough unless errors shrink again after they grew.
    """
    for parts in (1, _PARTS):
        points = _refined(elapsed, parts)
        truth = solution(scene).motion(points, _TRUTH_DIGITS + more_digits)
        with np.errstate(all="ignore"):  # what overflows is not finite, and then there is no answer
            parts_of_steps = _steps(scene, points, truth, is_rough)
            if parts_of_steps is not None:
                short, momentum, centre = parts_of_steps
                # Products of so many steps each.
                steps = reduce(
                    lambda product, part: part @ product, (short[k::parts] for k in range(parts))
                )
                return Steps(steps, products(steps), momentum[::parts], centre[::parts])
    return None


def _refined(elapsed: Sequence[Fraction], parts: int) -> list[Fraction]:
    """Return these times, and others that divide each span between them into so many equal parts."""
    points = [elapsed[0]]
    for begin, end in pairwise(elapsed):
        points += [begin + (end - begin) * Fraction(k, parts) for k in range(1, parts + 1)]
    return points


def _steps(
    scene: Scene, points: Sequence[Fraction], truth: Motion, is_rough: bool
) -> tuple[Floats, Floats, Floats] | None:
    """The steps on (z, theta, c) from point to point, and z and c there, counted in the flow's units.

    A turn of the body moves its later path too. The centre counts from its start, and has no rows where
    it is not tracked.
    """
    flow = Flow.of(scene)
    with mp.workdps(_FLOAT_DIGITS):
        units = np.array([mp.convert(unit) for unit in flow.components])
        z = (kind_of(scene.body).momentum_rows(scene.body, truth) / units).astype(float)
        path = truth.quantities.get("centre", np.empty((0, 3), dtype=object))
        centre = ((path - path[:1]) / mp.convert(flow.length)).astype(float)
    n, d = z.shape
    R = truth.quantities.get("attitude", np.empty((n, 0, 3))).astype(float)
    turn = np.zeros((n - 1, R.shape[1], d))
    shift = turn if len(flow.equations.velocity) else turn[:, :0]
    identity = np.tile(np.eye(d), (n - 1, 1, 1))
    arcs = _Arcs(z[:-1], R[:-1], identity, turn, shift)
    spans = np.diff([float(t / flow.time) for t in points])
    reached = _followed(flow, arcs, spans, is_rough)
    if reached is None or not _arrive(reached, z[1:], np.exp(flow.expansion * spans)):
        return None
    steps = np.tile(np.eye(d + 6), (n - 1, 1, 1))
    rows = np.concatenate([reached.by_momentum, reached.turn, reached.shift], axis=1)
    steps[:, : rows.shape[1], :d] = rows
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
    """The ends of n arcs: z (n, d), R (n, 3, 3), and what errors of z at their starts became.

    ``by_momentum`` (n, d, d) are the derivatives of z, ``turn`` and ``shift`` (n, 3, d) those of theta
    and c. Where no attitude is tracked, R, ``turn`` and ``shift`` have no rows, and for a rigid body
    ``shift`` has none.
    """

    momentum: Floats
    attitude: Floats
    by_momentum: Floats
    turn: Floats
    shift: Floats

    @property
    def whole(self) -> Floats:
        """All numbers of an arc in a row, (n, columns)."""
        return np.concatenate([part.reshape(len(part), prod(part.shape[1:])) for part in self], 1)

    def of(self, whole: Floats) -> _Arcs:
        """Return the arcs whose numbers, shaped as these, are in the rows of an array."""
        count, first, parts = len(whole), 0, list[Floats]()
        for part in self:
            shape = part.shape[1:]
            last = first + prod(shape)
            parts.append(whole[:, first:last].reshape(count, *shape))
            first = last
        return _Arcs(*parts)


def _followed(flow: Flow, arcs: _Arcs, spans: Floats, is_rough: bool) -> _Arcs | None:
    """Return every arc after its time span (n), or None if an arc is lost.

    Each is followed in steps that resolve its own Jacobian.
    """
    parts, longest = (ROUGH, _ROUGH_STEP) if is_rough else (FINE, _FINE_STEP)
    left, active, reached = spans.copy(), np.arange(len(spans)), arcs.whole

    def rates(whole: Floats) -> Floats:
        return _rates(flow, arcs.of(whole)).whole

    for _ in range(_MOST_STEPS):
        current = reached[active]
        rate = flow.rate(arcs.of(current).momentum)
        if not np.isfinite(rate).all():
            return None
        is_last = abs(left[active]) * rate <= longest
        h = np.where(is_last, left[active], np.copysign(longest / rate, left[active]))
        reached[active], _ = extrapolated(rates, current, h[:, None], parts)
        left[active] -= h
        active = active[~is_last]
        if not active.size:
            return arcs.of(reached)
    return None


def _rates(flow: Flow, at: _Arcs) -> _Arcs:
    jacobian, R = flow.jacobian(at.momentum), at.attitude
    turn = R @ (flow.equations.spin @ at.by_momentum)
    shift = at.shift
    if shift.shape[1]:
        speed = applied(R, at.momentum @ flow.equations.velocity.T)
        shift = R @ (flow.equations.velocity @ at.by_momentum) - cross_matrices(speed) @ at.turn
    return _Arcs(
        momentum=flow.rates(at.momentum, jacobian),
        attitude=R @ cross_matrices(at.momentum @ flow.equations.spin.T),
        by_momentum=jacobian @ at.by_momentum,
        turn=turn,
        shift=shift,
    )
