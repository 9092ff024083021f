"""Errors of one lane at its instants: signed drifts, the error of its phase, and that of its state.

c       the shift of time for which answer(t) and exact(t - c) differ least; the phase is 2 pi c / period
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
from taylor_verify.numbers.precision import power_of_two
from taylor_verify.scenes.motion import Clock, Motion
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.trajectory import Outcome, Trajectory, from_scaled
from taylor_verify_reports.studies.growth.fit import Floats, Law

PHASE: Final = "phase"
# Quantities that determine the shift of time; attitude and centre follow them.
_STATES: Final = ("omega", "linear_impulse", "angular_impulse")

# Digits and bits beyond the rung's own, far more than the sums of errors lose.
_MORE_DIGITS: Final = 12
_MORE_BITS: Final = 64
# Gauss-Newton converges quadratically, because the first shift is small beside a period.
_EVALUATIONS: Final = 12
_SETTLED: Final = 1e-6
# A shift is known only up to a whole period. It is certain if the shift before was so small that no law
# lets it grow beyond a quarter of a period in between.
_QUARTER: Final = 0.25
_FASTEST_GROWTH: Final = 2
# A motion whose speed falls below this part of its largest does not determine the time.
_AT_REST: Final = 1e-3


@dataclass(frozen=True)
class Measured:
    """Errors of a quantity (instants), NaN where missing, and the law that they are compared with.

    Drifts are relative to the quantity's scale, the phase is in radians, the state is relative to its
    largest size. ``signed`` is True for drifts and the phase; the error of the state is a norm.
    """

    quantity: str
    law: Law
    values: Floats
    signed: bool = True


def lane_errors(
    problem: Problem, states: Sequence[tuple[Fraction, ...] | None], period: float
) -> list[Measured]:
    """Return the errors of one lane from states in the problem's own form and units.

    ``states`` has the state at each instant, None for an instant that the lane did not reach; the errors
    there are NaN. Without a closed form the exact state is not known after so long a time, and there are
    only drifts. ``period`` is in the scene's unit of time.
    """
    reached = [state for state in states if state is not None]
    rows = [problem.initial_momenta, *reached]
    trajectory = Trajectory(Outcome.FINISHED, from_scaled(problem, rows))
    # In this precision the product of two numbers is exact, and a sum nearly so.
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
    """Return the drift of each conserved quantity since the first row; of a vector, each component's."""
    drifts: list[Measured] = []
    for invariant in invariants(scene):
        values, scale = invariant.value(motion), invariant.scale(motion)
        drift = (values[1:] - values[0]) / scale
        names = [invariant.name]
        if drift.ndim > 1:
            names = [f"{invariant.name}.{i}" for i in range(1, drift.shape[1] + 1)]
        columns = drift.reshape(len(drift), len(names)).T.astype(float)
        drifts += [
            Measured(name, Law.WALK, column) for name, column in zip(names, columns, strict=True)
        ]
    return drifts


def _state_and_phase(
    problem: Problem, exact: Solution, answer: Motion, period: float
) -> list[Measured]:
    """Return the error of the state, and that of the phase if the motion determines the time."""
    digits = truth_digits(problem.rung.bits, _MORE_DIGITS)
    clock = problem.given.clock
    elapsed = clock.elapsed[: len(answer.radius)]
    reached = Clock(clock.start, clock.instants[: len(elapsed)])
    given = replace(problem.given, clock=reached, track=frozenset())
    (state,) = state_errors(given, exact.motion(elapsed, digits), answer)
    measured = [Measured(state.quantity, Law.INTEGRATED, state.values, signed=False)]
    shifts = _shifts(problem.given, exact, answer, elapsed, digits)
    if shifts is not None:
        phases = 2 * pi * certain_shifts(elapsed, shifts, period) / period
        measured.append(Measured(PHASE, Law.INTEGRATED, phases))
    return measured


def _shifts(
    scene: Scene, exact: Solution, answer: Motion, elapsed: Sequence[Fraction], digits: int
) -> Floats | None:
    """Return for each instant the shift of time c for which |e| is least; NaN if the search fails.

    The result is None for a body at rest, and for a motion that slows down so much that it does not
    determine the time.
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
        # Written so that NaN counts as not settled.
        settled = np.abs(steps) * float(unit) <= _SETTLED * np.abs(numbers)
        if np.all(settled):
            break
    return np.where(settled, numbers, nan)


def _scaled(rows: np.ndarray[Any, Any], exponent: int) -> Floats:
    """Return numbers of mpmath in units of 2^exponent, as float64."""
    each = np.frompyfunc(lambda value: float(mp.ldexp(value, -exponent)), 1, 1)
    scaled: Floats = each(rows).astype(float)
    return scaled


def certain_shifts(elapsed: Sequence[Fraction], shifts: Floats, period: float) -> Floats:
    """Return the shifts, with NaN from the first one on that may be wrong by a whole period.

    Each search starts at zero. Its result is right if the shift before, which grows no faster than t^2,
    cannot have reached a quarter of a period. ``elapsed``, ``shifts`` and ``period`` have one unit of time.
    """
    times, sizes = np.abs(np.array(elapsed, dtype=float)), np.abs(shifts)
    reach = np.append(0.0, sizes[:-1] * (times[1:] / times[:-1]) ** _FASTEST_GROWTH)
    # Written so that NaN counts as not certain.
    certain = (reach <= _QUARTER * period) & (sizes <= _QUARTER * period)
    return np.where(np.logical_and.accumulate(certain), shifts, nan)
