"""The shift of time that explains the error of U = A x + B y or Omega = B^T x + C y.

U and Omega are not states. For states judge.errors.shift gives more; here the shift is one constant c with
answer(t) ~ Omega(t - c), by least squares over the samples that share it. The velocity of Omega is a
difference quotient of the exact motion.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Solution
from taylor_verify.judge.errors.shift import LEAVES, strays_from
from taylor_verify.judge.errors.state import largest, norms
from taylor_verify.judge.velocities import velocity
from taylor_verify.records.reason import Kind
from taylor_verify.scenes.precision import exact_value, power_of_two
from taylor_verify.scenes.scene import Scene

Array = np.ndarray[Any, Any]

# A difference over this part of the span gives the velocity to ten digits; one digit would suffice.
_DIFFERENCE: Final = power_of_two(-35)
_MORE_DIGITS: Final = 12
_EVALUATIONS: Final = 8
# The iteration ends when a step moves Omega by less than this part of the remaining error.
_NEGLIGIBLE: Final = 1e-3


@dataclass(frozen=True)
class AngularShift:
    """A constant ``time_shift`` and the largest error ``residual`` after it, in the unit of Omega.

    Samples that do not share the shift are left out of both numbers.
    """

    time_shift: Fraction
    residual: float
    kind: Kind


@dataclass(frozen=True)
class _Fit:
    """Omega of the answer at some samples, and the exact Omega at t - shift."""

    shift: Fraction
    answer: Array
    error: Array
    velocity: Array

    @property
    def left(self) -> Any:
        return mp.sqrt(np.sum(self.error**2))

    @property
    def largest(self) -> Any:
        return largest(norms(self.error))

    def step(self) -> Any:
        """Return the further shift that leaves the least error, to first order."""
        weight = np.sum(self.velocity**2)
        return -np.sum(self.velocity * self.error) / weight if weight else mp.zero

    def strays(self) -> tuple[int, ...]:
        """Return the samples that do not share the median of all shifts; none if there are many."""
        error, velocity = self.error.astype(float), self.velocity.astype(float)
        speed = np.linalg.norm(velocity, axis=1)
        if not np.all(speed > 0):
            return ()
        further = -np.sum(error * velocity, axis=1) / speed**2
        across = np.linalg.norm(error + further[:, None] * velocity, axis=1)
        shifts = float(self.shift) + further
        return strays_from(np.full(len(shifts), np.median(shifts)), shifts, speed, across)


def angular_shift(
    given: Scene, answer: Array, digits: int, group: str = "omega"
) -> AngularShift | None:
    """Return the constant shift, at the ambient precision; None if the answer is not finite.

    ``answer`` is Omega, or the velocity of another ``group`` of columns, at the instants of ``given``.
    """
    if not all(mp.isfinite(value) for value in answer.flat):
        return None
    compared = _Compared(given, solution(given), answer, digits, group)
    whole, best = compared.shift(range(len(answer)))
    if whole.kind is Kind.NONE and (strays := best.strays()):
        shared, _ = compared.shift([k for k in range(len(answer)) if k not in strays])
        return whole if shared.kind is Kind.NONE else shared
    return whole


@dataclass(frozen=True)
class _Compared:
    given: Scene
    exact: Solution
    answer: Array
    digits: int
    group: str

    def shift(self, rows: Sequence[int]) -> tuple[AngularShift, _Fit]:
        """Return the shift of some samples and their least-squares fit."""
        fit = first = self.fit(Fraction(0), rows)
        for _ in range(_EVALUATIONS):
            step = fit.step()
            further = self.fit(fit.shift + exact_value(step), rows)
            if not further.left < fit.left:
                break
            fit = further
            if abs(step) * mp.sqrt(np.sum(fit.velocity**2)) <= _NEGLIGIBLE * fit.left:
                break
        # An answer without motion shows no time.
        reach = largest(norms(first.answer - first.answer[:1]))
        explains = fit.shift != 0 and fit.largest <= LEAVES * min(first.largest, reach)
        kind = Kind.CONSTANT if explains else Kind.NONE
        return AngularShift(fit.shift, float(fit.largest), kind), fit

    def fit(self, shift: Fraction, samples: Sequence[int]) -> _Fit:
        """Return the fit that compares the answer at some samples with the exact motion at t - shift."""
        elapsed = [self.given.clock.elapsed[k] - shift for k in samples]
        h = _DIFFERENCE * (max(abs(t) for t in elapsed) or 1)
        both = [*elapsed, *(t + h for t in elapsed)]
        motion = self.exact.evaluate(both, self.digits + _MORE_DIGITS)
        here, ahead = np.split(velocity(self.group, self.given.body, motion), 2)
        own = self.answer[list(samples)]
        return _Fit(shift, own, own - here, (ahead - here) / mp.convert(h))
