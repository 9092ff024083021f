"""The shifts of time that explain small errors of many bodies at once: judge.errors.shift, in arrays.

The errors are roundings, so that first order suffices. Where it does not suffice, the shift is not known
here.

e  error, relative to its scale     v, a  velocity and acceleration, likewise     c  shift of time
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any, Final

import numpy as np

from taylor_verify.judge.errors.compared import FLOAT_NOISE
from taylor_verify.judge.errors.courses import AT_REST, FAR, NEGLIGIBLE
from taylor_verify.judge.errors.shift import FEWEST, LEAVES, MOST_PAIRED, STRAYS, UNUSUAL
from taylor_verify.records.reason import Kind
from taylor_verify.scenes.instants import evenly

Floats = np.ndarray[Any, np.dtype[np.float64]]

_KINDS: Final = (Kind.CONSTANT, Kind.DRIFTING, Kind.WANDERING, Kind.NONE)
# The length of a vector is at most this many times its largest component.
_COMPONENTS: Final = 3**0.5
_CONSTANT, _DRIFTING, _WANDERING, _NONE = range(4)


@dataclass(frozen=True)
class Shifts:
    """The shifts of n bodies: arrays (n) of the fields of a Shift.

    ``is_first_order`` (n) is True for the bodies whose shift is known by first order.
    """

    time_shift: Floats
    residual: Floats
    kinds: Any
    remains: Floats
    trend: Floats
    is_first_order: Any

    def numbers(self, place: int, unit: float) -> dict[str, Any]:
        """Return the numbers of a verdict on one body, by field name; times are multiples of ``unit``."""
        kind = _KINDS[self.kinds[place]]
        return {
            "time_shift": float(self.time_shift[place] * unit),
            "residual": float(self.residual[place]),
            "shift": kind.value,
            "trend": float(self.trend[place]) if kind is Kind.DRIFTING else None,
            "remains": None if kind is Kind.NONE else float(self.remains[place]),
        }

    def put(self, places: Any, others: Shifts) -> None:
        """Replace the shifts of some bodies by others."""
        for field in fields(self):
            getattr(self, field.name)[places] = getattr(others, field.name)


@dataclass(frozen=True)
class Errors:
    """The errors (3, n, m) of n answers at these ``times`` (n, m), with the velocity of the motion.

    ``acceleration`` (n, m) is the length of the second derivative.
    ``moved`` (n, m) is the distance of each answer from its first sample, over the scale of the error.
    """

    error: Floats
    velocity: Floats
    acceleration: Floats
    moved: Floats
    times: Floats

    def at(self, places: Any) -> Errors:
        """Return the errors of some answers."""
        return Errors(
            self.error[:, places],
            self.velocity[:, places],
            self.acceleration[places],
            self.moved[places],
            self.times[places],
        )

    @cached_property
    def weight(self) -> Floats:
        """Squared speed: the weight of every sample in the least squares for a shift."""
        squared_speed: Floats = np.sum(self.velocity**2, axis=0)
        return squared_speed

    @cached_property
    def wanted(self) -> Floats:
        """Shift that would remove the error of each single sample, times its weight."""
        weighted_shift: Floats = -np.sum(self.error * self.velocity, axis=0)
        return weighted_shift

    def left_by(self, course: Floats) -> Floats:
        """Return the errors (n, m) that remain after a shift."""
        return _lengths(self.error + course * self.velocity)

    def is_first_order(self, course: Floats, left: Floats, included: Any) -> Any:
        """Return True for the answers (n) whose shift (n, m) is so small that first order suffices."""
        neglected = self.acceleration * course**2 / 2
        neglected += FLOAT_NOISE * _lengths(self.velocity) * abs(course)
        return _largest(neglected, included) <= NEGLIGIBLE / _COMPONENTS * _largest(left, included)


def shifts(errors: Errors) -> Shifts:
    """Return the shifts that explain errors, in the unit of ``errors.times``."""
    everything = np.ones_like(errors.times, dtype=bool)
    with np.errstate(all="ignore"):
        result, linear = _shared(errors, everything)
        alone = np.flatnonzero(result.kinds == _NONE)
        if alone.size:
            result.put(alone, _unshared(errors.at(alone), result, alone, linear[alone]))
    return result


def _shared(errors: Errors, included: Any) -> tuple[Shifts, Floats]:
    """Return the constant and drifting shifts of the included samples, and the drifting course (n, m)."""
    weight, wanted, t = errors.weight * included, errors.wanted * included, errors.times
    span = t[:, -1:] - t[:, :1]
    share = (t - t[:, :1]) / np.where(span != 0, span, 1.0)
    # Sums over the samples, for the least squares along 1 and along the elapsed share of the time.
    w, wt, wtt = (np.sum(weight * share**k, axis=1, keepdims=True) for k in range(3))
    b, bt = (np.sum(wanted * share**k, axis=1, keepdims=True) for k in range(2))
    constant = np.broadcast_to(b / w, weight.shape)
    slope = (w * bt - wt * b) / (w * wtt - wt * wt)
    linear = (b - slope * wt) / w + slope * share
    whole = _lengths(errors.error)
    largest = _largest(whole, included)
    remains, explains, is_small = [], [], largest <= FAR
    for course in (constant, linear):
        left = errors.left_by(course)
        remains.append(_largest(left, included))
        explains.append(_explained(errors, remains[-1], largest, included))
        is_small &= errors.is_first_order(course, left, included)
    kinds = np.select(explains, (_CONSTANT, _DRIFTING), _NONE)
    result = Shifts(
        time_shift=constant[:, 0].copy(),
        residual=remains[0],
        kinds=kinds,
        remains=np.select(explains, remains, largest),
        trend=slope[:, 0] / span[:, 0],
        is_first_order=is_small,
    )
    return result, linear


def _explained(errors: Errors, left: Floats, largest: Floats, included: Any) -> Any:
    some = np.minimum(largest, _largest(errors.moved, included))
    return (some > 0) & (left <= LEAVES * some)


def _unshared(errors: Errors, all_samples: Shifts, places: Any, linear: Floats) -> Shifts:
    """Return the shifts of bodies whose samples share none: without strays, or of single samples."""
    parts = (getattr(all_samples, field.name)[places].copy() for field in fields(Shifts))
    result = Shifts(*parts)
    everything = np.ones_like(errors.times, dtype=bool)
    weight = errors.weight
    is_moving = weight > AT_REST**2 * np.max(weight, axis=1, keepdims=True)
    single = np.where(is_moving, errors.wanted / weight, linear)
    across = errors.left_by(single)
    for course in _robust(single, errors.times):
        included = ~_strays(single, course, np.sqrt(weight), across)
        asked = np.flatnonzero((result.kinds == _NONE) & ~included.all(axis=1))
        without, _ = _shared(errors.at(asked), included[asked])
        better = without.kinds != _NONE
        # The fit without strays must also be of first order, even if it is not taken.
        result.is_first_order[asked] &= without.is_first_order
        parts = (getattr(without, field.name)[better] for field in fields(Shifts))
        result.put(asked[better], Shifts(*parts))
    remains = _largest(across, everything)
    largest = _largest(_lengths(errors.error), everything)
    explains = _explained(errors, remains, largest, everything)
    wanders = (result.kinds == _NONE) & explains
    result.kinds[wanders], result.remains[wanders] = _WANDERING, remains[wanders]
    is_small = errors.is_first_order(single, across, everything) & is_moving.all(axis=1)
    result.is_first_order[:] &= is_small
    return result


def _robust(single: Floats, times: Floats) -> Iterator[Floats]:
    """Yield the median of the shifts of single samples, and their Theil-Sen line."""
    yield np.broadcast_to(np.median(single, axis=1, keepdims=True), single.shape)
    t = times - times[:, :1]
    chosen = np.array(evenly(times.shape[1], MOST_PAIRED))
    first, second = (chosen[places] for places in np.triu_indices(len(chosen), 1))
    slopes = (single[:, second] - single[:, first]) / (t[:, second] - t[:, first])
    line = np.median(slopes, axis=1, keepdims=True) * t
    yield np.median(single - line, axis=1, keepdims=True) + line


def _strays(single: Floats, course: Floats, speed: Floats, across: Floats) -> Any:
    """Return the samples (n, m) that lie unusually far from a course; none where they are many."""
    samples = single.shape[1]
    off = np.hypot((single - course) * speed, across)
    are_strays = off > UNUSUAL * np.median(off, axis=1, keepdims=True)
    are_strays &= off > LEAVES * abs(course) * speed
    few = min(max(1, int(STRAYS * samples)), samples - FEWEST)
    return are_strays & (np.sum(are_strays, axis=1, keepdims=True) <= few)


def _largest(values: Floats, included: Any) -> Floats:
    largest: Floats = np.max(np.where(included, values, 0.0), axis=1)
    return largest


def _lengths(vectors: Floats) -> Floats:
    lengths: Floats = np.sqrt(np.sum(vectors * vectors, axis=0))
    return lengths
