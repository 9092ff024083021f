"""Comparison of an answer with the exact motion at shifted times, and the first-order effect of shifts.

c            shift of time: answer(t) ~ exact(t - c), positive for an answer that is late
e            answer(t) - exact(t - c), relative to the scale of its error
v, a         velocity and acceleration of exact(t - c), relative to the same scale
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from itertools import accumulate, pairwise
from math import frexp, inf
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.exact.rates import FloatFlow, float_flow
from taylor_verify.exact.solution import Solution, Unsettled
from taylor_verify.judge.errors.quick_motion import Places, QuickMotion
from taylor_verify.judge.errors.state import Errors
from taylor_verify.judge.velocities import exact_matrix, velocity, velocity_forms
from taylor_verify.numbers.precision import power_of_two
from taylor_verify.records.quantities import QUANTITIES, Measure
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.instants import evenly
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.scene import Scene

Floats = np.ndarray[Any, np.dtype[np.float64]]

# A sum of a dozen products of float64 has a rounding error of up to this part of its terms.
_FLOAT_NOISE: Final = 2.0**-48
# Many shifts are tested on a few samples.
_SEARCH_SAMPLES: Final = 16
# A smaller motion of the answer is not seen in its rows as doubles.
_SEEN: Final = 2.0**-20
# A verdict has no numbers below 2^-1000; above 2^-960 a double keeps all 53 bits.
_LEAST_EXPONENT: Final = -1000
_LEAST: Final = 2.0**-960


@dataclass(frozen=True)
class Shifted:
    """The comparison of the answer with exact(t - c), in flattened float64 rows, one for each sample.

    ``error`` is relative to the scale of the error and in multiples of ``size``, a power of two near the
    largest error. ``velocity`` and ``acceleration`` are relative to the same scale, per ``unit`` of time.
    c is ``moved``, in units, and the exact motion was taken there; ``more``, in unit x size, is a further
    shift that was subtracted from ``error`` by first order.
    """

    moved: Floats
    error: Floats
    velocity: Floats
    acceleration: Floats
    size: float
    unit: Fraction
    more: Floats

    @property
    def shift(self) -> Floats:
        """Whole shift of every sample, in the scene's unit of time."""
        return self.moved * float(self.unit) + self.more * (float(self.unit) * self.size)

    @property
    def is_finite(self) -> bool:
        """True if all values are finite in float64."""
        with np.errstate(all="ignore"):
            total = np.sum(self.error**2) + np.sum(self.velocity**2) + np.sum(self.acceleration**2)
        return bool(np.isfinite(total))

    @cached_property
    def weight(self) -> Floats:
        """Squared speed |v|^2: the weight of every sample in the least squares for a shift."""
        squared_speed: Floats = np.sum(self.velocity**2, axis=1)
        return squared_speed

    @cached_property
    def wanted(self) -> Floats:
        """Shift that would remove the error of each single sample, times its weight."""
        weighted_shift: Floats = -np.sum(self.error * self.velocity, axis=1)
        return weighted_shift

    @property
    def left(self) -> float:
        """Root mean square of the error."""
        return float(np.sqrt(np.mean(np.sum(self.error**2, axis=1)))) * self.size

    @property
    def rate(self) -> float:
        """Fastest rate of the motion, per unit."""
        fastest = float(np.max(np.linalg.norm(self.velocity, axis=1)))
        bend = float(np.max(np.linalg.norm(self.acceleration, axis=1)))
        return bend / fastest if fastest else 0.0

    def neglects(self, step: Floats) -> float:
        """Return the effect of a further shift that first order neglects, in ``size``."""
        bend = np.linalg.norm(self.acceleration, axis=1) * step**2 * self.size / 2
        noise = _FLOAT_NOISE * np.linalg.norm(self.velocity, axis=1) * np.abs(step)
        return float(np.max(bend + noise))

    def at(self, places: Places) -> Shifted:
        """Return the comparison of some of the samples."""
        return replace(
            self,
            moved=self.moved[places],
            error=self.error[places],
            velocity=self.velocity[places],
            acceleration=self.acceleration[places],
            more=self.more[places],
        )

    def with_first_order(self, step: Floats) -> Shifted:
        """Return the comparison after a further shift, to first order."""
        error = self.error + step[:, None] * self.velocity
        return replace(self, error=error, more=self.more + step)


@dataclass(frozen=True)
class Run:
    """An answer and the exact motion, for all quantities of a scene."""

    scene: Scene
    exact: Solution
    truth: Motion
    answer: Motion
    digits: int

    @cached_property
    def flow(self) -> FloatFlow:
        return float_flow(self.scene)

    @cached_property
    def unit(self) -> Fraction:
        """The unit of time of the flow, in the scene's."""
        return power_of_two(self.flow.time)

    @cached_property
    def quick(self) -> QuickMotion:
        """The exact motion in float64."""
        return QuickMotion(self.flow, self.truth.quantities, self.flow.times(self.elapsed))

    @cached_property
    def elapsed(self) -> Sequence[Fraction]:
        return self.scene.clock.elapsed

    @cached_property
    def since(self) -> Floats:
        """The times of the samples since the start."""
        return np.array([float(t) for t in self.elapsed])


@dataclass(frozen=True)
class Compared:
    """A quantity of an answer, compared with the exact motion at any shifts.

    ``places`` are the samples that are compared, ``forms`` the compared parts over their scales as linear
    forms of a state, and ``unshifted`` is the comparison without a shift. At other times than the samples
    the motion is taken in float64, unless ``is_exact``.
    """

    run: Run
    errors: Errors
    places: Places
    forms: Floats
    unshifted: Shifted
    is_exact: bool = False

    @classmethod
    def of(cls, run: Run, errors: Errors) -> Compared:
        """Return the comparison of all samples."""
        places, scales = np.arange(len(run.elapsed)), _scales(errors)
        error, size = _relative(run.scene.body, run.answer, run.truth, scales)
        states = run.quick.rows
        forms = _forms(run, scales)
        start = _shifted(run, forms, np.zeros(len(error)), error, size, states)
        return cls(run, errors, places, forms, start)

    def without(self, strays: Sequence[int]) -> Compared:
        """Return the comparison without these samples."""
        places = np.delete(np.arange(len(self.places)), strays)
        return replace(self, places=self.places[places], unshifted=self.unshifted.at(places))

    @cached_property
    def since(self) -> Floats:
        """Times of the samples since the first of them."""
        since = self.run.since[self.places]
        return np.asarray(since - since[0])

    @cached_property
    def times(self) -> Floats:
        """Times of the samples as fractions of the span, the first 0 and the last 1."""
        shares: Floats = self.since / (self.since[-1] or 1.0)
        return shares

    @cached_property
    def reach(self) -> float:
        """Largest distance of the answer from its first sample, in the unit of the error."""
        parts = []
        for part, scale in self._scales.items():
            rows = self.run.answer[part][self.places].reshape(len(self.places), -1)
            near = rows.astype(float) * float(1 / scale)
            apart = near - near[:1]
            if np.max(np.abs(apart)) < _SEEN * np.max(np.abs(near)):
                apart = ((rows - rows[:1]) / scale).astype(float)
            parts.append(np.max(np.linalg.norm(apart, axis=1)))
        return float(max(parts))

    @cached_property
    def doubt(self) -> float:
        """Width of the truth: a smaller remaining error cannot be resolved."""
        return float(max(self.errors.truth_radius))

    def evaluated(self, shift: Floats) -> Shifted | None:
        """Return the comparison at a shift of each sample, in units; None if it cannot be computed."""
        if self.is_exact:
            return self._exactly(shift)
        beyond, start = self.run.quick.beyond(self.places, -shift), self.unshifted
        if beyond is None:
            return None
        error = start.error - beyond @ self.forms.T / start.size
        factor = 2.0 ** frexp(float(np.max(np.abs(error))))[1]
        states = self.run.quick.rows[self.places] + beyond
        size = start.size * factor
        fit = _shifted(self.run, self.forms, shift, error / factor, size, states)
        return fit if fit.is_finite else None

    def _exactly(self, shift: Floats) -> Shifted | None:
        run = self.run
        elapsed = [
            run.elapsed[k] - Fraction(c) * run.unit
            for k, c in zip(self.places, shift.tolist(), strict=True)
        ]
        try:
            motion = run.exact.motion(elapsed, run.digits)
        except Unsettled:
            return None
        answer = run.answer.at(self.places.tolist())
        error, size = _relative(run.scene.body, answer, motion, self._scales)
        states = run.flow.states(motion.quantities)
        fit = _shifted(run, self.forms, shift, error, size, states)
        return fit if fit.is_finite else None

    def left_by(self, steps: Floats, shape: Floats) -> Floats | None:
        """Return the mean square error of a few samples after shifts by each of the steps x ``shape``."""
        rows = np.array(evenly(len(self.places), _SEARCH_SAMPLES))
        some, start = np.tile(rows, len(steps)), self.unshifted
        beyond = self.run.quick.beyond(self.places[some], -np.outer(steps, shape[rows]).ravel())
        if beyond is None:
            return None
        with np.errstate(all="ignore"):
            errors = start.error[some] * start.size - beyond @ self.forms.T
            left = np.mean(np.sum(errors**2, axis=1).reshape(len(steps), -1), axis=1)
        return np.where(np.isfinite(left), left, inf)

    def largest(self, fit: Shifted) -> float:
        """Return the largest remaining error, in the unit of the error."""
        ends = accumulate((self.run.answer[part][0].size for part in self._scales), initial=0)
        parts = [fit.error[:, left:right] for left, right in pairwise(ends)]
        left = float(max(np.max(np.linalg.norm(part, axis=1)) for part in parts)) * fit.size
        if QUANTITIES[self.errors.quantity].measure is Measure.ANGLE:
            return float(2 * np.arcsin(min(left / 2, 1.0)))
        return left

    @cached_property
    def _scales(self) -> dict[str, Any]:
        return _scales(self.errors)


def _scales(errors: Errors) -> dict[str, Any]:
    """Return the scales of the parts. A small turn changes a frame by sqrt 2 times the angle."""
    if QUANTITIES[errors.quantity].measure is Measure.ANGLE:
        return {errors.quantity: mp.sqrt(2)}
    return errors.parts


def _forms(run: Run, scales: Mapping[str, Any]) -> Floats:
    """Return the compared parts over their scales, as linear forms of a state."""
    flow, width = run.flow, run.quick.rows.shape[1]
    places = flow.by_quantity(np.arange(width)[None].astype(float))
    every = []
    for part, scale in scales.items():
        is_state = part in places
        of = {part: None} if is_state else velocity_forms(run.scene.body)[part]
        rows = np.zeros((places[part].size if is_state else 3, width))
        for name, matrix in of.items():
            factor = mp.ldexp(1, flow.units[name]) / scale
            entries = np.eye(len(rows)) if matrix is None else exact_matrix(matrix)
            rows[:, places[name].ravel().astype(int)] = (entries * factor).astype(float)
        every.append(rows)
    return np.vstack(every)


def _shifted(
    run: Run, forms: Floats, shift: Floats, error: Floats, size: float, states: Floats
) -> Shifted:
    with np.errstate(all="ignore"):
        first, second = (rows @ forms.T for rows in run.flow.two_rates(states))
    return Shifted(shift, error, first, second, size, run.unit, np.zeros(len(shift)))


def _relative(
    body: Body, answer: Motion, truth: Motion, scales: Mapping[str, Any]
) -> tuple[Floats, float]:
    """Return the error of the answer, in units of a power of two near the largest."""
    exact = truth.quantities
    known = {p: exact[p] if p in exact else velocity(p, body, exact) for p in scales}
    errors = {p: (answer[p] - rows).reshape(len(rows), -1) for p, rows in known.items()}
    with np.errstate(all="ignore"):  # overflow and underflow are handled below
        relative = np.concatenate(
            [e.astype(float) * float(1 / scales[p]) for p, e in errors.items()], axis=1
        )
    largest = float(np.max(np.abs(relative)))
    if _LEAST <= largest < inf:
        size = 2.0 ** frexp(largest)[1]
        return relative / size, size
    # Too small for a double, or zero: scaled by a power of two before conversion.
    over = np.concatenate([e / scales[p] for p, e in errors.items()], axis=1)
    most = max(abs(value) for value in over.flat)
    exponent = max(int(mp.mag(most)), _LEAST_EXPONENT) if most else 0
    return (over * mp.ldexp(1, -exponent)).astype(float), 2.0**exponent
