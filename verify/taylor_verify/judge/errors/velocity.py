"""The error of U = A x + B y or Omega = B^T x + C y, and the shift of time that explains it.

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

from taylor_verify.exact.solution import Solution
from taylor_verify.judge.errors.shift import LEAVES, Shift, strays_from
from taylor_verify.judge.errors.state import (
    Distances,
    Errors,
    Floats,
    Series,
    States,
    largest,
    norms,
    or_one,
)
from taylor_verify.judge.velocities import velocity
from taylor_verify.numbers.precision import exact_value, power_of_two
from taylor_verify.records.quantities import GROUPS, QUANTITIES
from taylor_verify.records.reason import Kind
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.scene import Scene

Array = np.ndarray[Any, Any]

# A difference over this part of the span gives the velocity to ten digits; one digit would suffice.
_DIFFERENCE: Final = power_of_two(-35)
_MORE_DIGITS: Final = 12
_EVALUATIONS: Final = 8
# The iteration ends when a step moves Omega by less than this part of the remaining error.
_NEGLIGIBLE: Final = 1e-3
# So do steps that gain less than a tenth: no constant explains such an error.
_GAIN: Final = 0.9


class VelocityErrors:
    """Errors of a velocity whose rows come in blocks; ``group`` is the name of its columns."""

    def __init__(self, group: str) -> None:
        self.group = group
        self._states, self._sizes = States(), Series()

    def add(self, body: Body, truth: Motion, answer: Any) -> None:
        """Add the next rows of the exact motion and of the ``answer`` (n, 3)."""
        rows = velocity(self.group, body, truth.quantities)
        about, sizes = QUANTITIES[GROUPS[self.group].quantity], norms(rows)
        most = largest(sizes)
        distances = {self.group: norms(answer - rows)}
        widths = {self.group: truth.radius * or_one(most)}
        block = Distances(about.name, about.unit, distances, widths, {self.group: most})
        self._sizes.add(sizes, self._states.add(block)[self.group])

    def joined(self) -> tuple[Errors, Floats]:
        """Return the errors of all rows, and the size of the velocity there over its largest."""
        (errors,) = self._states.errors()
        return errors, self._sizes.joined()[0]


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


def velocity_shift(
    given: Scene, exact: Solution, answer: Array, digits: int, errors: Errors
) -> Shift | None:
    """Return the constant shift, at the ambient precision; None if the answer is not finite.

    ``answer`` (n, 3) is the velocity at the instants of ``given``, and ``errors`` are its errors.
    """
    if not all(mp.isfinite(value) for value in answer.flat):
        return None
    ((group, scale),) = errors.parts.items()
    compared = _Compared(given, exact, answer, digits, group)
    fit, kind = compared.shift(range(len(answer)))
    if kind is Kind.NONE and (strays := fit.strays()):
        shared = compared.shift([k for k in range(len(answer)) if k not in strays])
        fit, kind = (fit, kind) if shared[1] is Kind.NONE else shared
    shift, remains = float(fit.shift), float(fit.largest) / float(scale)
    return Shift(
        shift, remains, kind, remains, 0.0, tuple(map(float, given.clock.instants)), (), ()
    )


@dataclass(frozen=True)
class _Compared:
    given: Scene
    exact: Solution
    answer: Array
    digits: int
    group: str

    def shift(self, rows: Sequence[int]) -> tuple[_Fit, Kind]:
        """Return the least-squares fit of some samples, and whether its shift explains their error."""
        fit = first = self.fit(Fraction(0), rows)
        for _ in range(_EVALUATIONS):
            step = fit.step()
            further = self.fit(fit.shift + exact_value(step), rows)
            is_better = further.left < fit.left
            is_hopeless = not further.left < _GAIN * fit.left
            fit = further if is_better else fit
            if (
                is_hopeless
                or abs(step) * mp.sqrt(np.sum(fit.velocity**2)) <= _NEGLIGIBLE * fit.left
            ):
                break
        # An answer without motion shows no time.
        reach = largest(norms(first.answer - first.answer[:1]))
        explains = fit.shift != 0 and fit.largest <= LEAVES * min(first.largest, reach)
        return fit, Kind.CONSTANT if explains else Kind.NONE

    def fit(self, shift: Fraction, samples: Sequence[int]) -> _Fit:
        """Return the fit that compares the answer at some samples with the exact motion at t - shift."""
        elapsed = [self.given.clock.elapsed[k] - shift for k in samples]
        h = _DIFFERENCE * (max(abs(t) for t in elapsed) or 1)
        both = [*elapsed, *(t + h for t in elapsed)]
        motion = self.exact.evaluate(both, self.digits + _MORE_DIGITS)
        here, ahead = np.split(velocity(self.group, self.given.body, motion), 2)
        own = self.answer[list(samples)]
        return _Fit(shift, own, own - here, (ahead - here) / mp.convert(h))
