"""Defects of the answer: a sound trajectory with wrong times, wrong rows or a wrong report."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.models.problem import Problem
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.solvers.trajectory import Outcome, Trajectory
from taylor_verify_reports.controls.defect import BRICK, SCREW, Defect
from taylor_verify_reports.controls.limit import JustWithin, just_over

_CONSERVED: Final = frozenset({"T", "H2", "H_space"})

# In NASA's check case of this brick, one simulation differs from the others by half a millisecond.
_EARLY: Final = Fraction(1, 2000)
# The last point is interpolated between the ends of a step of this length, in units of time.
_STEP: Final = Fraction(1, 1000)

Rows = Any


def _early(problem: Problem) -> Problem:
    """Return the problem with all times half a millisecond later; its answer gets the times asked for."""
    ahead = _EARLY / problem.units.time
    times = tuple(problem.rung.round(t + ahead) for t in problem.times)
    return replace(problem, times=times)


def _one_sample_late(_: Problem, sound: Trajectory) -> Trajectory:
    """Put the state of row k - 1 into row k."""
    return _mapped(sound, lambda rows: np.concatenate([rows[:1], rows[:-1]]))


def _last_interpolated(problem: Problem, sound: Trajectory) -> Trajectory:
    """Replace the last row by the mean of the states half a step before and half a step after it."""
    half = _STEP / problem.units.time / 2
    end, rounded = problem.times[-1], problem.rung.round
    around = replace(problem, times=(rounded(end - half), rounded(end + half)))
    ends = Taylor().solve(around).quantities
    with mp.workprec(problem.rung.bits):
        means = {name: (rows[:1] + rows[1:]) / 2 for name, rows in ends.items()}
    rows = {n: np.concatenate([r[:-1], means[n]]) for n, r in sound.quantities.items()}
    return replace(sound, quantities=rows)


def _padded(problem: Problem, sound: Trajectory) -> Trajectory:
    """Repeat the state at half the time in every later row."""
    half = len(problem.times) // 2
    reached = np.minimum(np.arange(len(problem.times)), half)
    return _mapped(sound, lambda rows: rows[reached])


def _stopped(_: Problem, sound: Trajectory) -> Trajectory:
    """Return a trajectory that was interrupted and says so."""
    return replace(sound, outcome=Outcome.INTERRUPTED, quantities={})


def _one_nan(_: Problem, sound: Trajectory) -> Trajectory:
    """Replace the first number of the middle sample by NaN, in every quantity."""

    def spoil(rows: Rows) -> Rows:
        spoiled = rows.copy()
        spoiled[len(rows) // 2, 0] = mp.nan
        return spoiled

    return _mapped(sound, spoil)


def _conjugated(_: Problem, sound: Trajectory) -> Trajectory:
    """Return the answer with q0, -q1, -q2, -q3: the rotation from space to body."""
    signs = np.array([1, -1, -1, -1], dtype=object)
    return _with_quaternion(sound, sound.quantities["quaternion"] * signs)


def _scalar_rebuilt(problem: Problem, sound: Trajectory) -> Trajectory:
    """Return the answer with q0 = +sqrt(1 - q1^2 - q2^2 - q3^2)."""
    rows = sound.quantities["quaternion"].copy()
    with mp.workprec(problem.rung.bits):
        for row in rows:
            row[0] = mp.sqrt(max(1 - sum(q * q for q in row[1:]), mp.zero))
    return _with_quaternion(sound, rows)


def _with_quaternion(sound: Trajectory, rows: Rows) -> Trajectory:
    return replace(sound, quantities={**sound.quantities, "quaternion": rows})


def _mapped(sound: Trajectory, change: Callable[[Rows], Rows]) -> Trajectory:
    quantities = {name: change(rows) for name, rows in sound.quantities.items()}
    return replace(sound, quantities=quantities)


ANSWERS: Final = (
    Defect(
        name="half-a-millisecond-early",
        scene=BRICK,
        gate="omega",
        passes=_CONSERVED,
        what="every sample stamped 0.5 ms early",
        why="a true state of the same motion at another time: it has every conserved quantity to "
        "the last digit, and all of its error is a shift of time",
        recast=_early,
        wrong_start=True,
        is_common=True,
    ),
    Defect(
        name="one-sample-late",
        scene=BRICK,
        gate="omega",
        passes=_CONSERVED,
        what="the output written one sample late",
        why="true states all of them, each under the next one's time",
        spoil=_one_sample_late,
    ),
    Defect(
        name="one-sample-late-impulse",
        scene=SCREW,
        gate="impulse",
        passes=frozenset({"T", "F2", "FG", "y3", "x_space", "y_space"}),
        what="the same late output, for a solid in a fluid",
        why="six conserved quantities instead of three, and none of them has a clock",
        spoil=_one_sample_late,
    ),
    Defect(
        name="success-after-failure",
        scene=BRICK,
        gate="attitude",
        passes=_CONSERVED,
        what="stopped half way, padded with the last state, success reported",
        why="a body that is frozen loses nothing",
        spoil=_padded,
        is_common=True,
    ),
    Defect(
        name="stopped-and-said-so",
        scene=BRICK,
        gate="omega",
        what="stopped half way, and reported as stopped",
        why="what did not finish is not scored: it has the outcome for its error",
        spoil=_stopped,
        honest=True,
    ),
    Defect(
        name="last-point-interpolated",
        scene=BRICK,
        gate="omega",
        what="the last point interpolated between two steps of 1 ms",
        why="a chord runs inside the arc by h^2/8 of its curvature: one sample in a hundred is "
        "wrong, in everything",
        spoil=_last_interpolated,
        is_common=True,
    ),
    Defect(
        name="conjugate-quaternion",
        scene=BRICK,
        gate="attitude",
        passes=frozenset({"omega", "T", "H2"}),
        what="the quaternion from space to body in place of body to space",
        why="no quantity in body axes knows the attitude; in space the momentum wanders",
        spoil=_conjugated,
    ),
    Defect(
        name="scalar-part-rebuilt",
        scene=BRICK,
        gate="H_space",
        passes=frozenset({"omega", "T", "H2"}),
        what="q0 rebuilt as the positive root after each renormalisation",
        why="q and -q are one rotation, but the sign of q0 alone is not free: right until the body "
        "has turned by half a turn, then not",
        spoil=_scalar_rebuilt,
    ),
    Defect(
        name="one-nan",
        scene=BRICK,
        gate="omega",
        what="one number that is not a number",
        why="NaN is neither smaller nor larger than anything: a gate that asks whether error > bound "
        "passes it, one that asks whether error <= bound does not",
        spoil=_one_nan,
    ),
    Defect(
        name="one-ulp-over",
        scene="euler/generic",
        gate="omega",
        passes=frozenset({"T", "H2"}),
        what="one sample off by the bound and one ulp of it",
        why="the least error that must fail; its twin, an ulp within, must pass. It leads along the "
        "orbit, where nothing conserved changes",
        spoil=just_over,
        twin=JustWithin(),
    ),
)
