"""Errors of one lane at its instants: signed drifts, the shift of its phase, and its state.

c       shift of time, answer(t) = exact(t - c) but for a remainder; the phase is 2 pi c over the period
e, v    answer(t) - exact(t - c), and the velocity of exact(t - c), each component in its own unit
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import nan, pi
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.exact.invariants import invariants
from taylor_verify.exact.rates import rates
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import NO_CLOSED_FORM, Solution
from taylor_verify.judge.errors.state import state_errors
from taylor_verify.judge.floor.arithmetic import truth_digits
from taylor_verify.models.problem import Problem
from taylor_verify.scenes.motion import Clock, Motion
from taylor_verify.scenes.precision import power_of_two
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.trajectory import Outcome, Trajectory, from_scaled
from taylor_verify.studies.growth.fit import Floats, Law

PHASE: Final = "phase"
# Quantities that determine the shift of time; attitude and centre follow them.
_STATES: Final = ("omega", "linear_impulse", "angular_impulse")

# Digits of errors below the rung's own, far more than their sums lose.
_MORE_DIGITS: Final = 12
_MORE_BITS: Final = 64
# Gauss-Newton converges quadratically, because the first shift is small beside a period.
_EVALUATIONS: Final = 12
_SETTLED: Final = 1e-6
# A shift is unique up to a whole period if the one before is so small that no law lets it grow beyond
# a quarter of a period in between.
_QUARTER: Final = 0.25
_FASTEST_GROWTH: Final = 2
# A motion slower than this part of its fastest does not determine the time.
_AT_REST: Final = 1e-3


@dataclass(frozen=True)
class Measured:
    """Errors of a quantity at the instants, NaN if missing, and the law that they are compared with.

    Drifts are relative to the quantity's scale, the phase is in radians, the state is relative to its
    largest size. ``signed`` is true for drifts and the phase; the error of the state is a norm.
    """

    quantity: str
    law: Law
    values: Floats
    signed: bool = True


def lane_errors(
    problem: Problem, states: Sequence[tuple[Fraction, ...] | None], period: float
) -> list[Measured]:
    """Return the errors of one lane from states in the problem's own form and units.

    Errors after a missing state are missing too. Without a closed form there is no exact state at such
    times, so that there are drifts alone.
    """
    reached = [state for state in states if state is not None]
    rows = [problem.initial_momenta, *reached]
    trajectory = Trajectory(Outcome.FINISHED, from_scaled(problem, rows))
    # A precision in which products of two numbers are exact, and sums nearly so.
    with mp.workprec(2 * problem.rung.bits + _MORE_BITS):
        motion = trajectory.motion(mp.prec)
        measured = _drifts(problem.given, motion)
        exact = solution(problem.given)
        if exact.regime != NO_CLOSED_FORM and reached:
            quantities = {name: values[1:] for name, values in motion.quantities.items()}
            answer = Motion(quantities, motion.radius[1:])
            measured += _state_and_phase(problem, exact, answer, period)
    missing = [nan] * (len(states) - len(reached))
    return [replace(errors, values=np.append(errors.values, missing)) for errors in measured]


def _drifts(scene: Scene, motion: Motion) -> list[Measured]:
    """Return the drifts since the first row, of vectors in space component by component."""
    drifts: list[Measured] = []
    for invariant in invariants(scene):
        values, scale = invariant.value(motion), invariant.scale(motion)
        drift = (values[1:] - values[0]) / scale
        names = [invariant.name]
        if drift.ndim > 1:
            names = [f"{invariant.name}.{i}" for i in range(1, drift.shape[1] + 1)]
        columns = drift.reshape(len(drift), len(names)).T.astype(float)
        drifts += [Measured(n, Law.WALK, column) for n, column in zip(names, columns, strict=True)]
    return drifts


def _state_and_phase(
    problem: Problem, exact: Solution, answer: Motion, period: float
) -> list[Measured]:
    digits = truth_digits(problem.rung.bits, _MORE_DIGITS)
    clock = problem.given.clock
    elapsed = clock.elapsed[: len(answer.radius)]
    reached = Clock(clock.start, clock.instants[: len(elapsed)])
    given = replace(problem.given, clock=reached, track=frozenset())
    (state,) = state_errors(given, exact.motion(elapsed, digits), answer)
    measured = [Measured(state.quantity, Law.INTEGRATED, state.values.astype(float), signed=False)]
    shifts = _shifts(problem.given, exact, answer, elapsed, digits)
    if shifts is not None:
        phases = 2 * pi * sure_shifts(elapsed, shifts, period) / period
        measured.append(Measured(PHASE, Law.INTEGRATED, phases))
    return measured


def _shifts(
    scene: Scene, exact: Solution, answer: Motion, elapsed: Sequence[Fraction], digits: int
) -> Floats | None:
    """Return for each instant the c with the least e, or NaN if the search fails.

    The result is None for a motion that rests, or slows down so much that it determines no time.
    """
    names = [name for name in _STATES if name in answer.quantities]
    shifts = [Fraction(0)] * len(elapsed)
    for _ in range(_EVALUATIONS):
        there = exact.motion([t - c for t, c in zip(elapsed, shifts, strict=True)], digits)
        flow = rates(scene, there)
        e = np.hstack([_scaled(answer[n] - there[n], flow.units[n]) for n in names])
        v = np.hstack([flow.velocity[n] for n in names])
        speeds = np.linalg.norm(v, axis=1)
        if not np.all(speeds > _AT_REST * np.max(speeds)):
            return None
        steps = -np.sum(e * v, axis=1) / speeds**2
        unit = power_of_two(flow.time)
        shifts = [c + Fraction(s) * unit for c, s in zip(shifts, steps.tolist(), strict=True)]
        numbers = np.array([float(c) for c in shifts])
        # Written so that a NaN has not settled.
        settled = np.abs(steps) * float(unit) <= _SETTLED * np.abs(numbers)
        if np.all(settled):
            break
    return np.where(settled, numbers, nan)


def _scaled(rows: np.ndarray[Any, Any], exponent: int) -> Floats:
    """Return numbers of mpmath in units of 2^exponent, as float64."""
    each = np.frompyfunc(lambda value: float(mp.ldexp(value, -exponent)), 1, 1)
    scaled: Floats = each(rows).astype(float)
    return scaled


def sure_shifts(elapsed: Sequence[Fraction], shifts: Floats, period: float) -> Floats:
    """Return the shifts, with NaN from the first one on that may be off by a whole period.

    Each search starts at zero. Its result is right if the shift before, which grows as t^2 at most,
    cannot have reached a quarter of a period.
    """
    times, sizes = np.abs(np.array(elapsed, dtype=float)), np.abs(shifts)
    reach = np.append(0.0, sizes[:-1] * (times[1:] / times[:-1]) ** _FASTEST_GROWTH)
    # Written so that a NaN is not sure.
    sure = (reach <= _QUARTER * period) & (sizes <= _QUARTER * period)
    return np.where(np.logical_and.accumulate(sure), shifts, nan)
