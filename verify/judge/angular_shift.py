"""The shift of time behind the error of Omega = B^T x + C y, which is no state of its own.

For states judge.shift says more; here it is one constant c with answer(t) ~ Omega(t - c), by least
squares. The velocity of Omega is a difference of the exact motion.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Final

import numpy as np
from mpmath import mp

from verify.exact.route import solution
from verify.exact.solution import Solution
from verify.judge.errors import largest, norms
from verify.judge.inputs import angular_velocity
from verify.judge.shift import Kind
from verify.scenes.bodies import ImmersedBody
from verify.scenes.precision import exact_value, power_of_two
from verify.scenes.scene import Scene

Array = np.ndarray[Any, Any]

# A difference over this part of the span has a velocity to ten digits, where one would do.
_DIFFERENCE: Final = power_of_two(-35)
_MORE_DIGITS: Final = 12
_EVALUATIONS: Final = 8
# A step that moves Omega by so much less than what is left needs no further one.
_NEGLIGIBLE: Final = 1e-3
# As judge.shift has it: what leaves less than a tenth is the explanation.
_SETTLES: Final = 0.1


@dataclass(frozen=True)
class AngularShift:
    """``time_shift`` leaves ``residual`` of the error ``before``, both the largest, as Omega has them."""

    time_shift: Fraction
    before: float
    residual: float
    kind: Kind


@dataclass(frozen=True)
class _Fit:
    shift: Fraction
    error: Array
    velocity: Array

    @property
    def left(self) -> Any:
        return mp.sqrt(np.sum(self.error**2))

    def step(self) -> Any:
        """The further shift that leaves least, to first order."""
        weight = np.sum(self.velocity**2)
        return -np.sum(self.velocity * self.error) / weight if weight else mp.zero


def angular_shift(given: Scene, answer: Array, digits: int) -> AngularShift | None:
    """The constant shift, at the ambient precision; None where the answer is not finite.

    ``answer`` holds Omega at the instants of ``given``.
    """
    if not all(mp.isfinite(value) for value in answer.flat):
        return None
    exact = solution(given)
    first = fit = _fit(given, exact, answer, Fraction(0), digits)
    for _ in range(_EVALUATIONS):
        step = fit.step()
        further = _fit(given, exact, answer, fit.shift + exact_value(step), digits)
        if not further.left < fit.left:
            break
        fit = further
        if abs(step) * mp.sqrt(np.sum(fit.velocity**2)) <= _NEGLIGIBLE * fit.left:
            break
    settled = bool(fit.left <= _SETTLES * first.left) and fit.shift != 0
    before, residual = (float(largest(norms(f.error))) for f in (first, fit))
    kind = Kind.CONSTANT if settled else Kind.NONE
    return AngularShift(fit.shift, before, residual, kind)


def _fit(given: Scene, exact: Solution, answer: Array, shift: Fraction, digits: int) -> _Fit:
    body = given.body
    assert isinstance(body, ImmersedBody)
    elapsed = [t - shift for t in given.clock.elapsed]
    h = _DIFFERENCE * (max(abs(t) for t in elapsed) or 1)
    both = exact.evaluate([*elapsed, *(t + h for t in elapsed)], digits + _MORE_DIGITS)
    rows = angular_velocity(body, both)
    here, ahead = rows[: len(elapsed)], rows[len(elapsed) :]
    return _Fit(shift, answer - here, (ahead - here) / mp.convert(h))
