"""Comparison of an answer with the exact motion at shifted times, and the first-order effect of shifts.

c            shift of time: answer(t) ~ exact(t - c), positive for an answer that is late
e            answer(t) - exact(t - c), relative to the scale of its error
v, a         velocity and acceleration of exact(t - c), relative to the same scale
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from itertools import accumulate, pairwise
from math import frexp, inf, isfinite
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.exact.rates import Rates, rates
from taylor_verify.exact.solution import Solution, Unsettled
from taylor_verify.judge.causes.quick_motion import MOST_ARCS, QuickMotion
from taylor_verify.judge.errors.state import Errors
from taylor_verify.judge.velocities import exact_matrix, velocity, velocity_forms
from taylor_verify.numbers.precision import power_of_two
from taylor_verify.records.quantities import QUANTITIES, Measure
from taylor_verify.scenes.instants import evenly
from taylor_verify.scenes.motion import Clock, Motion
from taylor_verify.scenes.scene import Scene

Floats = np.ndarray[Any, np.dtype[np.float64]]
Shifts = tuple[Fraction, ...]

# A sum of a dozen products of float64 has a rounding error of up to this part of its terms.
_FLOAT_NOISE: Final = 2.0**-48
# Many shifts are tested on a few samples, to a few digits.
_SEARCH_SAMPLES: Final = 16
_SEARCH_DIGITS: Final = 15
# So many arcs in float64 one behind the other take less time than a closed form.
_FEW_ARCS: Final = 32
# Two times nearby, in the unit of time in which the motion is of size one, tell its rates.
_ASIDE: Final = 2.0**-7
# A verdict has no numbers below 2^-1000; above 2^-960 a double keeps all 53 bits.
_LEAST_EXPONENT: Final = -1000
_LEAST: Final = 2.0**-960


@dataclass(frozen=True)
class Shifted:
    """The comparison of the answer with exact(t - shifts), in flattened float64 rows, one for each sample.

    ``error`` is relative to the scale of the error and in multiples of ``size``, a power of two near the
    largest error. ``velocity`` and ``acceleration`` are relative to the same scale, per ``unit`` of time.
    ``more`` is a further shift, in unit x size, that was subtracted from ``error`` by first order.
    """

    shifts: Shifts
    error: Floats
    velocity: Floats
    acceleration: Floats
    size: float
    unit: Fraction
    more: Floats

    @property
    def shift(self) -> Floats:
        """Whole shift of every sample, in the scene's unit of time."""
        evaluated = np.array([float(c) for c in self.shifts]) if any(self.shifts) else 0.0
        return evaluated + self.more * (float(self.unit) * self.size)

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

    def moved(self, step: Floats) -> Shifts:
        """Return the shifts with a further shift added, exactly."""
        unit = self.unit * Fraction(self.size)
        return tuple(
            c + Fraction(s) * unit for c, s in zip(self.shifts, step.tolist(), strict=True)
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
    def rates(self) -> Rates:
        return rates(self.scene, self.truth)

    @cached_property
    def elapsed(self) -> Sequence[Fraction]:
        return self.scene.clock.elapsed

    @cached_property
    def instants(self) -> tuple[float, ...]:
        return tuple(float(t) for t in self.scene.clock.instants)

    @cached_property
    def span(self) -> float:
        return float(self.elapsed[-1] - self.elapsed[0])

    @cached_property
    def times(self) -> Floats:
        """Times of the samples as fractions of the span, the first 0 and the last 1."""
        elapsed = np.array([float(t) for t in self.elapsed])
        shares: Floats = (elapsed - elapsed[0]) / (self.span or 1.0)
        return shares

    @property
    def unshifted(self) -> Shifts:
        return (Fraction(0),) * len(self.elapsed)

    def near(self, elapsed: Sequence[Fraction]) -> Mapping[str, Any] | None:
        """Return the motion to the few digits of a search; None if it cannot be computed."""
        quick = self.along(_floats(elapsed))
        if quick is not None:
            return quick
        motion = self.motion(elapsed, _SEARCH_DIGITS)
        return None if motion is None else motion.quantities

    @cached_property
    def quick(self) -> QuickMotion | None:
        """The motion in float64; None if it has loads."""
        if not QuickMotion.is_possible(self.scene, self.truth.quantities):
            return None
        most = MOST_ARCS if self.exact.route == "taylor" else _FEW_ARCS
        return QuickMotion(self.scene, self.truth.quantities, _floats(self.elapsed), most)

    def along(self, times: Floats) -> Mapping[str, Any] | None:
        """Return the motion in float64 at times since the start.

        None if it has loads, or a closed form that takes less time.
        """
        return None if self.quick is None else self.quick.at(times)

    def motion(self, elapsed: Sequence[Fraction], digits: int) -> Motion | None:
        """Return the exact motion; None if it cannot be computed."""
        try:
            return self.exact.motion(elapsed, digits)
        except Unsettled:
            return None


@dataclass(frozen=True)
class Compared:
    """A quantity of an answer, compared with the exact motion at any shifts.

    If it ``is_quick``, the motion at other times than the samples is taken in float64, and shifts that it
    does not follow are not tried.
    """

    run: Run
    errors: Errors
    is_quick: bool = False

    def without(self, strays: Collection[int]) -> Compared:
        """Return the comparison without these samples."""
        run = self.run
        places = [k for k in range(len(run.elapsed)) if k not in strays]
        clock = Clock(run.scene.clock.start, tuple(run.scene.clock.instants[k] for k in places))
        scene = replace(run.scene, clock=clock)
        rows = replace(run, scene=scene, truth=run.truth.at(places), answer=run.answer.at(places))
        return replace(self, run=rows)

    @cached_property
    def reach(self) -> float:
        """Largest distance of the answer from its first sample, in the unit of the error."""
        parts = []
        for part, scale in self._scales.items():
            rows = self.run.answer[part].reshape(len(self.run.elapsed), -1)
            apart = ((rows - rows[:1]) / scale).astype(float)
            parts.append(np.max(np.linalg.norm(apart, axis=1)))
        return float(max(parts))

    @cached_property
    def doubt(self) -> float:
        """Width of the truth: a smaller remaining error cannot be resolved."""
        return float(max(self.errors.truth_radius))

    def evaluated(self, shifts: Shifts) -> Shifted | None:
        """Return the comparison with the exact motion at t - shifts; None if it cannot be computed."""
        run = self.run
        elapsed = [t - c for t, c in zip(run.elapsed, shifts, strict=True)]
        if self.is_quick:
            return self._quickly(_floats(elapsed), shifts)
        motion = run.motion(elapsed, run.digits)
        if motion is None:
            return None
        fit = self.fit(motion, rates(run.scene, motion), shifts)
        return fit if fit.is_finite else None

    def _quickly(self, times: Floats, shifts: Shifts) -> Shifted | None:
        """Return the comparison with the motion in float64; its rates are those of two times nearby."""
        run = self.run
        unit = power_of_two(run.rates.time)
        aside = _ASIDE * float(unit)
        motions = [run.along(times + side * aside) for side in (-1, 0, 1)]
        if any(motion is None for motion in motions):
            return None
        before, here, after = (self.over_scales(motion) for motion in motions if motion)
        error = self.over_scales(run.answer.quantities) - here
        size = 2.0 ** frexp(float(np.max(np.abs(error))))[1]
        velocity = (after - before) / (2 * _ASIDE)
        acceleration = (after - 2 * here + before) / _ASIDE**2
        return Shifted(
            shifts, error / size, velocity, acceleration, size, unit, np.zeros(len(shifts))
        )

    def fit(self, truth: Motion, derivatives: Rates, shifts: Shifts) -> Shifted:
        error, size = self._relative(truth.quantities)
        velocity, acceleration = (
            np.concatenate(
                [self._rate(rows, derivatives.units, part) for part in self._scales], axis=1
            )
            for rows in (derivatives.velocity, derivatives.acceleration)
        )
        return Shifted(
            shifts=shifts,
            error=error,
            velocity=velocity,
            acceleration=acceleration,
            size=size,
            unit=power_of_two(derivatives.time),
            more=np.zeros(len(shifts)),
        )

    def _rate(self, rows: Mapping[str, Floats], units: Mapping[str, int], part: str) -> Floats:
        """Return the rate of a part over its scale, from those of the momenta where it is a velocity."""
        scale = self._scales[part]
        if part in rows:
            factor = float(mp.ldexp(1, units[part]) / scale)
            return factor * rows[part].reshape(len(rows[part]), -1)
        forms = velocity_forms(self.run.scene.body)[part]
        parts = [
            rows[name] @ (exact_matrix(matrix).T * (mp.ldexp(1, units[name]) / scale)).astype(float)
            for name, matrix in forms.items()
        ]
        total: Floats = np.sum(parts, axis=0)
        return total

    def left_by(self, steps: Sequence[Fraction], shape: Floats) -> list[float] | None:
        """Return the mean square error of a few samples after shifts by each of the steps x ``shape``."""
        run = self.run
        rows = evenly(len(run.elapsed), _SEARCH_SAMPLES)
        shares = [Fraction(shape[k]) for k in rows]
        elapsed = [
            run.elapsed[k] - step * share
            for step in steps
            for k, share in zip(rows, shares, strict=True)
        ]
        motion = run.along(_floats(elapsed)) if self.is_quick else run.near(elapsed)
        if motion is None:
            return None
        answer = self.over_scales({part: run.answer[part][rows] for part in self._scales})
        with np.errstate(all="ignore"):
            errors = self.over_scales(motion).reshape(len(steps), *answer.shape) - answer
            left = np.mean(np.sum(errors**2, axis=2), axis=1)
        return [error if isfinite(error) else inf for error in left.tolist()]

    def over_scales(self, motion: Mapping[str, Any]) -> Floats:
        """Return the rows of a motion over the scales of the errors, flattened, in float64."""
        parts = [
            rows.reshape(len(rows), -1).astype(float) * float(1 / self._scales[part])
            for part, rows in self._parts(motion).items()
        ]
        return np.concatenate(parts, axis=1)

    def _parts(self, motion: Mapping[str, Any]) -> dict[str, Any]:
        """Return the compared quantities of a motion, of which velocities are made of the momenta."""
        body = self.run.scene.body
        return {p: motion[p] if p in motion else velocity(p, body, motion) for p in self._scales}

    def largest(self, fit: Shifted) -> float:
        """Return the largest remaining error, in the unit of the error."""
        ends = accumulate((self.run.answer[part][0].size for part in self._scales), initial=0)
        parts = [fit.error[:, left:right] for left, right in pairwise(ends)]
        left = float(max(np.max(np.linalg.norm(part, axis=1)) for part in parts)) * fit.size
        if self._is_angle:
            return float(2 * np.arcsin(min(left / 2, 1.0)))
        return left

    @property
    def _is_angle(self) -> bool:
        return QUANTITIES[self.errors.quantity].measure is Measure.ANGLE

    @cached_property
    def _scales(self) -> dict[str, Any]:
        """Scales of the parts. A small turn changes a frame by sqrt 2 times the angle (Frobenius norm)."""
        if self._is_angle:
            return {self.errors.quantity: mp.sqrt(2)}
        return self.errors.parts

    def _relative(self, truth: Mapping[str, Any]) -> tuple[Floats, float]:
        """Return the error of the answer, in units of a power of two near the largest."""
        parts = self._scales
        errors = {p: self.run.answer[p] - exact for p, exact in self._parts(truth).items()}
        errors = {p: error.reshape(len(error), -1) for p, error in errors.items()}
        with np.errstate(all="ignore"):  # overflow and underflow are handled below
            relative = np.concatenate(
                [e.astype(float) * float(1 / parts[p]) for p, e in errors.items()], axis=1
            )
        largest = float(np.max(np.abs(relative)))
        if _LEAST <= largest < inf:
            size = 2.0 ** frexp(largest)[1]
            return relative / size, size
        # Too small for a double, or zero: scaled by a power of two before conversion.
        exact = np.concatenate([e / parts[p] for p, e in errors.items()], axis=1)
        largest = max(abs(value) for value in exact.flat)
        exponent = max(int(mp.mag(largest)), _LEAST_EXPONENT) if largest else 0
        return (exact * mp.ldexp(1, -exponent)).astype(float), 2.0**exponent


def _floats(times: Sequence[Fraction]) -> Floats:
    return np.array([float(t) for t in times])
