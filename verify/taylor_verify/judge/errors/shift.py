"""The shift of time that explains an error of the state: an answer that is correct but late or early.

With answer(t) ~ exact(t - c), c is positive if the answer is late. The shift is constant, or linear in t,
or different at every sample (judge.errors.courses).

A few samples may not share the course of the others, for example a first row that is the given start. Such
strays do not influence the median of the shifts of single samples, nor the Theil-Sen line for a drift. They
are left out and named, and the other samples are fitted again by least squares.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Final

import numpy as np

from taylor_verify.exact.solution import Solution
from taylor_verify.judge.errors import courses
from taylor_verify.judge.errors.shifted import Compared, Floats, Run, Shifted
from taylor_verify.judge.errors.state import Errors
from taylor_verify.records.reason import Kind, TimeShift
from taylor_verify.scenes.instants import evenly
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.scene import Scene

Places = np.ndarray[Any, np.dtype[np.bool_]]

# A shift is the cause of an error only if at most this part remains. A wrong equation also moves a body
# along its orbit, by about as much as across it, so removing a half or two thirds proves nothing.
LEAVES: Final = 0.1
# At most this part of the samples, and at least one, may be without the shift that the others share;
_STRAYS: Final = 0.1
# a shift explains nothing if fewer samples than this share it.
_FEWEST: Final = 3
# Float64 follows the motion to this part of an error; less is settled by the exact motion.
_FOLLOWED: Final = 1e-6
# A stray is this many times further off than the median sample.
_UNUSUAL: Final = 10.0
# The Theil-Sen line uses all pairs of at most this many samples.
_MOST_PAIRED: Final = 201
_COURSES: Final = {
    Kind.CONSTANT: courses.constant,
    Kind.DRIFTING: courses.linear,
    Kind.WANDERING: courses.single,
}
# The square of this is still a double. No shift of time causes larger errors or NaN.
_LARGEST_ERROR: Final = 2**500


@dataclass(frozen=True)
class Shift:
    """The shift of one quantity.

    ``kind`` is the simplest course of the shift that explains the error, and ``remains`` the largest
    error after this course, in the unit of the error. ``time_shift`` is the best constant c, in the scene's
    unit of time, and ``residual`` the error after it. ``trend`` is the shift per unit of time of the best
    course linear in t. ``strays`` are the times of samples that do not share the course; the numbers above
    do not include them. ``course`` is the shift of every sample on the course. ``at_samples`` is the shift
    of every sample by itself, or the shift of the course where the motion rests.
    """

    time_shift: float
    residual: float
    kind: Kind
    remains: float
    trend: float
    times: tuple[float, ...]
    at_samples: tuple[float, ...]
    course: tuple[float, ...]
    strays: tuple[float, ...] = ()

    def numbers(self) -> dict[str, Any]:
        """Return the numbers of a verdict on the quantity, by the names of its fields."""
        return {
            "time_shift": self.time_shift,
            "residual": self.residual,
            "shift": self.kind.value,
            "trend": self.trend if self.kind is Kind.DRIFTING else None,
            "remains": None if self.kind is Kind.NONE else self.remains,
        }

    def terms(self) -> TimeShift:
        """Return the terms of the shift for a reason, at the sample where the shift is largest."""
        if self.kind is Kind.NONE:
            return TimeShift(self.kind)
        shift = TimeShift(
            self.kind, self.time_shift, self.remains, rows=len(self.times), strays=self.strays
        )
        if self.kind is Kind.CONSTANT:
            return shift
        worst = int(np.argmax(np.abs(self.course)))
        first, largest = self.course[0], self.course[worst]
        shift = replace(shift, late=largest, at=self.times[worst], trend=self.trend)
        if abs(first) <= LEAVES * abs(largest):
            return shift
        return replace(shift, begins=first, begins_at=self.times[0])


def time_shifts(
    scene: Scene, exact: Solution, truth: Motion, answer: Motion, digits: int, of: Sequence[Errors]
) -> list[Shift | None]:
    """Return the shift that explains the errors of each state quantity, at the ambient precision of mpmath.

    ``truth`` is the exact motion of ``scene`` at its instants to ``digits`` digits. The shift is None if an
    error is not finite or a rate is beyond float64. If the motion rests, no shift explains anything.
    """
    run = Run(scene, exact, truth, answer, digits)
    return [_shift(run, errors) for errors in of]


def _shift(run: Run, errors: Errors) -> Shift | None:
    """Return the best shift; None if a number is beyond float64."""
    if not all(error <= _LARGEST_ERROR for error in errors.values):
        return None
    compared = Compared.of(run, errors)
    if not compared.unshifted.is_finite:
        return None
    shift = _searched(compared)
    is_clear = shift.remains > _FOLLOWED * compared.largest(compared.unshifted)
    if shift.kind is Kind.NONE or is_clear:
        return shift
    return _settled(replace(compared, is_exact=True), shift) or shift


def _searched(compared: Compared) -> Shift:
    instants = tuple(map(float, compared.run.scene.clock.instants))
    fits = best = _Fits.of(compared)
    nearest = min(fits.constant, fits.linear, key=lambda fit: fit.left)
    single = courses.fitted(compared, nearest, courses.single)
    if fits.kind is Kind.NONE and not _passes_too_far(compared, single):
        others = _without_strays(compared, single)
        best = next((other for other in others if other.kind is not Kind.NONE), fits)
    kind, remains, course = best.kind, best.remains, best.course(compared)
    if kind is Kind.NONE and best.explains(single):
        kind, remains, course = Kind.WANDERING, compared.largest(single), single.shift
    return Shift(
        time_shift=float(best.constant.shift[0]),
        residual=best.compared.largest(best.constant),
        kind=kind,
        remains=remains,
        trend=best.trend,
        times=instants,
        at_samples=tuple(single.shift.tolist()),
        course=tuple(course.tolist()),
        strays=tuple(instants[k] for k in best.strays),
    )


def _passes_too_far(compared: Compared, single: Shifted) -> bool:
    """Return True if the exact motion, at whatever time, is too far from more rows than may be strays."""
    off = np.linalg.norm(single.error, axis=1) * single.size
    within = LEAVES * compared.largest(compared.unshifted)
    most = max(1, int(_STRAYS * len(off)))
    return int(np.count_nonzero(off > within)) > most


def _settled(compared: Compared, quick: Shift) -> Shift | None:
    """Return a shift that float64 found with the numbers of the exact motion; None if it explains nothing.

    Numbers that do not belong to its course stay as they are.
    """
    strays = tuple(np.flatnonzero(np.isin(quick.times, quick.strays)).tolist())
    shared = compared.without(strays) if strays else compared
    near = courses.at(shared, np.delete(quick.course, strays))
    if near is None:
        return None
    fit = courses.fitted(shared, near, _COURSES[quick.kind])
    fits = _Fits(shared, fit, fit, strays)
    if not fits.explains(fit):
        return None
    course = fit.shift if quick.kind is Kind.WANDERING else fits.line(compared)
    settled = replace(quick, remains=shared.largest(fit), course=tuple(course.tolist()))
    match quick.kind:
        case Kind.CONSTANT:
            return replace(settled, time_shift=settled.course[0], residual=settled.remains)
        case Kind.DRIFTING:
            return replace(settled, trend=fits.trend)
    return replace(settled, at_samples=settled.course)


@dataclass(frozen=True)
class _Fits:
    """The constant and the drifting fit of some samples; ``strays`` are the indices of the others."""

    compared: Compared
    constant: Shifted
    linear: Shifted
    strays: tuple[int, ...] = ()

    @classmethod
    def of(
        cls, compared: Compared, line: Shifted | None = None, strays: tuple[int, ...] = ()
    ) -> _Fits:
        """Return the fits that begin without a shift; the drifting fit begins at ``line``.

        The constant fit must begin at a constant, because a fit contains the shift that it begins with.
        """
        begin = courses.best_start(compared, compared.unshifted, courses.constant)
        constant = courses.fitted(compared, begin, courses.constant)
        onward = line or courses.best_start(compared, constant, courses.linear)
        linear = courses.fitted(compared, onward, courses.linear)
        return cls(compared, constant, linear, strays)

    def explains(self, fit: Shifted) -> bool:
        """Return True if the remaining error is small beside the error and beside the answer's motion.

        An answer without motion equals the truth at a constant time, which does not explain its error.
        """
        some = min(self.compared.largest(self.compared.unshifted), self.compared.reach)
        return bool(some > 0 and self.compared.largest(fit) <= LEAVES * some)

    @cached_property
    def kind(self) -> Kind:
        if self.explains(self.constant):
            return Kind.CONSTANT
        return Kind.DRIFTING if self.explains(self.linear) else Kind.NONE

    @property
    def remains(self) -> float:
        fits = {Kind.CONSTANT: self.constant, Kind.DRIFTING: self.linear}
        return self.compared.largest(fits.get(self.kind, self.compared.unshifted))

    @property
    def trend(self) -> float:
        line, span = self.linear.shift, float(self.compared.since[-1])
        return float(line[-1] - line[0]) / span if span else 0.0

    def course(self, every: Compared) -> Floats:
        """Return the shift of all samples, including strays."""
        if self.kind is not Kind.DRIFTING:
            return np.full(len(every.places), float(self.constant.shift[0]))
        return self.line(every)

    def line(self, every: Compared) -> Floats:
        """Return the drifting shift of all samples."""
        since: Floats = every.since - every.since[self.compared.places[0]]
        line: Floats = self.linear.shift[0] + self.trend * since
        return line


# The samples that do not share the course of the others.


def _without_strays(compared: Compared, single: Shifted) -> Iterator[_Fits]:
    """Yield the fits of the samples that share a robust course, constant or linear in t."""
    moving = courses.moving(single)
    if np.count_nonzero(moving) < _FEWEST:
        return
    for robust in (_median, _theil_sen):
        course = robust(single.shift, moving, compared.since)
        speed = np.sqrt(single.weight) / (float(single.unit) * single.size)
        across = np.linalg.norm(single.error, axis=1)
        strays = strays_from(course, single.shift, speed, across)
        if not strays:
            continue
        shared = compared.without(strays)
        line = courses.at(shared, np.delete(course, strays))
        if line is not None:
            yield _Fits.of(shared, line, strays)


def strays_from(course: Floats, shifts: Floats, speed: Floats, across: Floats) -> tuple[int, ...]:
    """Return the samples that lie unusually far from a course; none if there are many.

    ``shifts`` are the shifts of single samples, ``across`` the errors after them, and ``speed`` is the
    error that a unit shift causes.
    """
    off = np.hypot((shifts - course) * speed, across)
    is_off = (off > LEAVES * np.abs(course) * speed) & (off > _UNUSUAL * np.median(off))
    strays = tuple(int(k) for k in np.flatnonzero(is_off))
    few = max(1, int(_STRAYS * len(off)))
    return strays if len(strays) <= min(few, len(off) - _FEWEST) else ()


def _median(shifts: Floats, moving: Places, times: Floats) -> Floats:
    return np.full(len(times), np.median(shifts[moving]))


def _theil_sen(shifts: Floats, moving: Places, times: Floats) -> Floats:
    """Return the line whose slope is the median slope between all pairs of samples."""
    places = np.flatnonzero(moving)
    chosen = places[evenly(len(places), _MOST_PAIRED)]
    first, second = np.triu_indices(len(chosen), 1)
    t, c = times[chosen], shifts[chosen]
    gaps = t[second] - t[first]
    if not gaps.all():
        # After a large start time, all instants may be equal in float64: then there is no slope.
        return _median(shifts, moving, times)
    slope = float(np.median((c[second] - c[first]) / gaps))
    return np.median(c - slope * t) + slope * times
