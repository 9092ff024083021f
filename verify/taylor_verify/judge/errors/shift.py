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
from taylor_verify.judge.errors.passage import Passage
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
    every = [Compared(run, errors) for errors in of]
    starts = [_start(compared) for compared in every]
    reaches = [courses.reach(start) for start in starts if start is not None]
    passage = Passage(run, max(reaches, default=0.0))
    return [
        None if start is None else _shift(compared, start, passage)
        for compared, start in zip(every, starts, strict=True)
    ]


def _start(compared: Compared) -> Shifted | None:
    """Return the comparison without a shift; None if a number is beyond float64."""
    run = compared.run
    if not all(error <= _LARGEST_ERROR for error in compared.errors.values):
        return None
    start = compared.fit(run.truth, run.rates, run.unshifted)
    return start if start.is_finite else None


def _shift(compared: Compared, start: Shifted, passage: Passage) -> Shift:
    """Return the best shift; of a large error one in float64 is asked first, where that is quicker."""
    if compared.largest(start) > courses.FAR and passage.is_followed:
        if courses.reach(start) <= passage.around and _passes_too_far(compared, start, passage):
            return _without_evaluation(compared, start)
        quick = _searched(replace(compared, is_quick=True), start)
        if quick.kind is Kind.NONE:
            return quick
        if (exact := _settled(compared, start, quick)) is not None:
            return exact
    return _searched(compared, start)


def _searched(compared: Compared, start: Shifted) -> Shift:
    run = compared.run
    fits = best = _Fits.of(compared, start)
    nearest = min(fits.constant, fits.linear, key=lambda fit: fit.left)
    single = courses.fitted(compared, nearest, courses.single)
    if fits.kind is Kind.NONE:
        others = _without_strays(compared, single)
        best = next((other for other in others if other.kind is not Kind.NONE), fits)
    kind, remains, course = best.kind, best.remains, best.course(run)
    if kind is Kind.NONE and best.explains(single):
        kind, remains, course = Kind.WANDERING, compared.largest(single), single.shift
    return Shift(
        time_shift=float(best.constant.shift[0]),
        residual=best.compared.largest(best.constant),
        kind=kind,
        remains=remains,
        trend=best.trend,
        times=run.instants,
        at_samples=tuple(single.shift.tolist()),
        course=tuple(course.tolist()),
        strays=tuple(run.instants[k] for k in best.strays),
    )


def _settled(compared: Compared, start: Shifted, quick: Shift) -> Shift | None:
    """Return a shift that float64 found with the numbers of the exact motion; None if it explains nothing.

    Numbers that do not belong to its course stay as they are.
    """
    run = compared.run
    strays = tuple(k for k, t in enumerate(run.instants) if t in quick.strays)
    shared = compared.without(strays) if strays else compared
    unshifted = shared.fit(shared.run.truth, shared.run.rates, shared.run.unshifted)
    near = courses.at(shared, unshifted, np.delete(quick.course, strays))
    if near is None:
        return None
    fit = courses.fitted(shared, near, _COURSES[quick.kind])
    fits = _Fits(shared, unshifted, fit, fit, strays)
    if not fits.explains(fit):
        return None
    course = fit.shift if quick.kind is Kind.WANDERING else fits.line(run)
    settled = replace(quick, remains=shared.largest(fit), course=tuple(course.tolist()))
    match quick.kind:
        case Kind.CONSTANT:
            return replace(settled, time_shift=settled.course[0], residual=settled.remains)
        case Kind.DRIFTING:
            return replace(settled, trend=fits.trend)
    return replace(settled, at_samples=settled.course)


def _passes_too_far(compared: Compared, start: Shifted, passage: Passage) -> bool:
    """Return True if the exact motion, at whatever time, is too far from more rows than may be strays."""
    # The error of several parts is that of the worst, and a distance is at most this much larger.
    within = LEAVES * compared.largest(start) * float(np.sqrt(len(compared.errors.parts)))
    most = max(1, int(_STRAYS * len(compared.run.elapsed)))
    return int(np.count_nonzero(passage.distances(compared) > within)) > most


def _without_evaluation(compared: Compared, start: Shifted) -> Shift:
    """Return the shift of an error that none explains, with the numbers that first order tells."""
    run = compared.run
    best = start.with_first_order(courses.constant(start, run.times))
    single = courses.single(start, run.times) * (float(start.unit) * start.size)
    return Shift(
        time_shift=float(best.shift[0]),
        residual=compared.largest(best),
        kind=Kind.NONE,
        remains=compared.largest(start),
        trend=0.0,
        times=run.instants,
        at_samples=tuple(single.tolist()),
        course=(0.0,) * len(run.instants),
    )


@dataclass(frozen=True)
class _Fits:
    """The constant and the drifting fit of some samples; ``strays`` are the indices of the others."""

    compared: Compared
    start: Shifted
    constant: Shifted
    linear: Shifted
    strays: tuple[int, ...] = ()

    @classmethod
    def of(
        cls,
        compared: Compared,
        start: Shifted,
        line: Shifted | None = None,
        strays: tuple[int, ...] = (),
    ) -> _Fits:
        """Return the fits that begin at ``start``, without a shift; the drifting fit begins at ``line``.

        The constant fit must begin at a constant, because a fit contains the shift that it begins with.
        """
        begin = courses.best_start(compared, start, courses.constant)
        constant = courses.fitted(compared, begin, courses.constant)
        onward = line or courses.best_start(compared, constant, courses.linear)
        linear = courses.fitted(compared, onward, courses.linear)
        return cls(compared, start, constant, linear, strays)

    def explains(self, fit: Shifted) -> bool:
        """Return True if the remaining error is small beside the error and beside the answer's motion.

        An answer without motion equals the truth at a constant time, which does not explain its error.
        """
        some = min(self.compared.largest(self.start), self.compared.reach)
        return bool(some > 0 and self.compared.largest(fit) <= LEAVES * some)

    @cached_property
    def kind(self) -> Kind:
        if self.explains(self.constant):
            return Kind.CONSTANT
        return Kind.DRIFTING if self.explains(self.linear) else Kind.NONE

    @property
    def remains(self) -> float:
        fits = {Kind.CONSTANT: self.constant, Kind.DRIFTING: self.linear}
        return self.compared.largest(fits.get(self.kind, self.start))

    @property
    def trend(self) -> float:
        line, span = self.linear.shift, self.compared.run.span
        return float(line[-1] - line[0]) / span if span else 0.0

    def course(self, run: Run) -> Floats:
        """Return the shift of all samples of a run, including strays."""
        if self.kind is not Kind.DRIFTING:
            return np.full(len(run.instants), float(self.constant.shift[0]))
        return self.line(run)

    def line(self, run: Run) -> Floats:
        """Return the drifting shift of all samples of a run."""
        since: Floats = np.array(run.instants) - self.compared.run.instants[0]
        line: Floats = self.linear.shift[0] + self.trend * since
        return line


# The samples that do not share the course of the others.


def _without_strays(compared: Compared, single: Shifted) -> Iterator[_Fits]:
    """Yield the fits of the samples that share a robust course, constant or linear in t."""
    moving = courses.moving(single)
    if np.count_nonzero(moving) < _FEWEST:
        return
    for robust in (_median, _theil_sen):
        course = robust(single.shift, moving, np.array(compared.run.instants))
        speed = np.sqrt(single.weight) / (float(single.unit) * single.size)
        across = np.linalg.norm(single.error, axis=1)
        strays = strays_from(course, single.shift, speed, across)
        if not strays:
            continue
        shared = compared.without(strays)
        run, shared_course = shared.run, np.delete(course, strays)
        start = shared.fit(run.truth, run.rates, run.unshifted)
        line = courses.at(shared, start, shared_course)
        if line is not None:
            yield _Fits.of(shared, start, line, strays)


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
