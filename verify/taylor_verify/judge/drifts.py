"""Drift of the conserved quantities, and for a loaded body the balances that take their place.

Both are one sum over the samples. With Q a quantity and flow the exact motion over the time between
two samples,

    drift(t_n) = | sum over k < n of Q(state_k+1) - Q(flow(state_k)) |.

Without loads Q(flow(state)) = Q(state) and the sum telescopes to Q(state_n) - Q(start). With loads
Q(flow(state)) - Q(state) is the work, or impulse, done along the arc, and the sum is the balance.

Of a manufactured motion it is likewise, and each arc takes up the loads of the time at which it begins.
A solver integrates the clock of these loads with the rest; what rounding does to it does work, which adds
up from step to step, and which the bound of the balance has to hold (judge.balances).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
from mpmath import mp

from taylor_verify.exact.invariants import Invariant, invariants
from taylor_verify.exact.taylor import arcs
from taylor_verify.judge.errors import Errors
from taylor_verify.scenes.motion import Motion, State
from taylor_verify.scenes.mpfr import in_mpfr, precision, sqrt, to_mpf, to_mpfr
from taylor_verify.scenes.precision import exact_value
from taylor_verify.scenes.scene import Scene

Column = np.ndarray[Any, Any]

_STATE_FIELDS = {
    "omega": "omega",
    "linear_impulse": "linear",
    "angular_impulse": "angular",
    "quaternion": "attitude",
    "centre": "centre",
}


def drifts(
    scene: Scene, start: Motion, answer: Motion, held: Mapping[str, Column], digits: int
) -> list[tuple[Invariant, Errors]]:
    """The drift of every conserved quantity, at the ambient precision of mpmath and in its numbers.

    ``start`` is the exact initial state as a Motion of one row; ``held`` are the answer's own exact
    numbers with its quaternions, from which arcs start; ``digits`` is the precision of the arcs. An
    answer that is not finite drifts by NaN.
    """
    found, quick = invariants(scene), in_mpfr(answer)
    if scene.body.is_free:
        begin = in_mpfr(start)
        with precision():
            return [(i, _errors(i, quick, _conserved(i, begin, quick))) for i in found]
    if not _is_finite(answer):
        lost = to_mpfr(np.array([mp.nan] * len(answer.radius), dtype=object))
        with precision():
            return [(i, _errors(i, quick, lost)) for i in found]
    ends = in_mpfr(_arc_ends(scene, held, digits))
    with precision():
        return [(i, _errors(i, quick, _balance(i, quick, ends))) for i in found]


# What follows is in MPFR's numbers.


def _errors(invariant: Invariant, answer: Motion, change: Column) -> Errors:
    scale = invariant.scale(answer)
    drift = _sizes(change)
    values, scales = to_mpf(drift / scale), to_mpf(np.array([scale], dtype=object))
    last = to_mpf(change[-1:] / scale)[0] if change.ndim == 1 else None
    radius = np.array([mp.zero] * len(drift), dtype=object)
    unit = f"scale of {invariant.name}"
    return Errors(invariant.name, unit, values, radius, {invariant.name: scales[0]}, change=last)


def _conserved(invariant: Invariant, start: Motion, answer: Motion) -> Column:
    change: Column = invariant.value(answer) - invariant.value(start)[0]
    return change


def _balance(invariant: Invariant, answer: Motion, ends: Motion) -> Column:
    increments = invariant.value(answer) - invariant.value(ends)
    change: Column = np.cumsum(increments, axis=0)
    return change


def _sizes(values: Column) -> Column:
    if values.ndim > 1:
        return sqrt(np.sum(values * values, axis=1))
    sizes: Column = abs(values)
    return sizes


# The arcs.


def _arc_ends(scene: Scene, held: Mapping[str, Column], digits: int) -> Motion:
    """Where the exact motion leads from each sample (the first from the start) to the next one."""
    elapsed = scene.clock.elapsed
    begins = (Fraction(0), *elapsed[:-1])
    spans = [b - a for a, b in zip(begins, elapsed, strict=True)]
    return arcs(scene, [scene.initial, *_states(scene, held)[:-1]], spans, digits, begins)


def _states(scene: Scene, held: Mapping[str, Column]) -> list[State]:
    """The answer's samples as exact initial states."""
    columns = {_STATE_FIELDS[name]: [_exact(row) for row in rows] for name, rows in held.items()}
    samples = zip(*columns.values(), strict=True)
    return [replace(scene.initial, **dict(zip(columns, row, strict=True))) for row in samples]


def _exact(row: Sequence[Any]) -> tuple[Fraction, ...]:
    return tuple(exact_value(value) for value in row)


def _is_finite(motion: Motion) -> bool:
    return all(
        not mp.isnan(sum(v - v for v in values.flat)) for values in motion.quantities.values()
    )
