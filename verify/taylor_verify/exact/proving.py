"""A motion in balls whose precision rises until every row has the digits that were asked for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import ceil, log2
from typing import Any, Final, final

import numpy as np
from flint import arb, ctx
from mpmath import mp, mpf

from taylor_verify.exact.balls import largest_size, midpoint, radius, size, width
from taylor_verify.exact.enclosure.course import Course
from taylor_verify.exact.enclosure.stopping import Coarse, Unreached
from taylor_verify.exact.enclosure.walk import Row
from taylor_verify.exact.solution import NO_CLOSED_FORM, Solution, Unsettled
from taylor_verify.scenes.motion import Motion

_GUARD_BITS: Final = 40
_MORE_BITS: Final = 16
_ATTEMPTS: Final = 24
# Bits that a motion may lose, beyond twice the bits of the digits asked for.
_MOST_BITS: Final = 10_000
# The same limit for times before a time that is out of reach: seconds of work, not hours.
_MOST_BITS_BESIDE: Final = 500
# A vector that may be zero has no relative digits. If it is smaller than this, in bits beyond the digits
# asked for, beside its own largest size, its error is reported as an absolute bound.
_NEGLIGIBLE_BITS: Final = 1000
# The sizes of vectors that are zero throughout.
_LEAST_SIZE: Final = -1e9

Times = Mapping[int, Fraction]


@dataclass(frozen=True)
class Proven:
    """A row: midpoints, the errors of all components, radii, and the bits that the widest one lacks.

    ``peaks`` are lower bounds of the largest norms so far of the scene's own states.
    """

    values: Mapping[str, Any]
    errors: Mapping[str, Any]
    radii: Mapping[str, mpf]
    lacking: int
    peaks: Mapping[str, mpf]


class Proving(Solution):
    """Motions in balls, at whatever precision makes them narrow enough."""

    route = "taylor"
    regime = NO_CLOSED_FORM
    is_one_course = False
    """True where a nearer time is reached on the way to every later one."""

    def rows(self, times: Times, bits: int, most_bits: int) -> Iterator[tuple[int, Row]]:
        """A row of balls for the place of each time, at ``bits`` bits, which are the ambient precision.

        What was yielded before Coarse or Unreached was raised stands.
        """
        raise NotImplementedError

    def vectors(self, row: Row) -> Mapping[str, tuple[Any, Size | SoFar]]:
        """The quantities of a row as balls, each with the size by which its error is counted."""
        raise NotImplementedError

    @property
    def names(self) -> Sequence[str]:
        """The quantities of every row."""
        raise NotImplementedError

    @property
    def own_names(self) -> Sequence[str]:
        """The quantities whose errors are counted by their largest sizes so far."""
        return ()

    def _before(self, times: Times, unreached: Fraction) -> Times:
        """The times on one side of the start that are reached without this one."""
        nearer = {place: t for place, t in times.items() if abs(t) < abs(unreached)}
        return nearer if self.is_one_course else {}

    @final
    def motion(self, elapsed: Sequence[Fraction], digits: int) -> Motion:
        """The midpoints, and the proven radius of every vector and matrix relative to its norm.

        Raises Unsettled where more than a million steps, or ten thousand bits more than the digits
        take, would be needed; with the rows of the times that lie before.
        """
        target = ceil(digits * log2(10))
        first = target + _GUARD_BITS + self._rounding_bits(elapsed)
        most_bits = 2 * target + _MOST_BITS
        proven: dict[int, Proven] = {}
        doubts, ends = [], False
        for is_later in (True, False):
            limit, doubt = most_bits, None
            times: Times = {k: time for k, time in enumerate(elapsed) if (time >= 0) is is_later}
            while times:
                try:
                    self._prove(proven, times, target, first, limit)
                except Unreached as reason:
                    # The sentence on a nearer time replaces the sentence on a later time.
                    hint = "; ask for it without the times behind it" if doubt else ""
                    ends = ends or reason.is_end
                    limit, doubt = min(limit, 2 * target + _MOST_BITS_BESIDE), f"{reason}{hint}"
                    times = self._before(times, reason.time)
                times = {place: time for place, time in times.items() if place not in proven}
            if doubt is not None:
                doubts.append(doubt)
        places = sorted(proven)
        motion = self._gathered([proven[place] for place in places])
        if doubts:
            raise Unsettled("; ".join(doubts), motion if places else None, places, ends)
        return motion

    def _rounding_bits(self, elapsed: Sequence[Fraction]) -> int:
        """The bits that many short steps round away, beyond those of a motion without instants."""
        return 0

    def _prove(
        self, proven: dict[int, Proven], times: Times, target: int, bits: int, most_bits: int
    ) -> None:
        """Add the row of every time, with more bits for those that lack some. Raises Unreached."""
        missing, stuck = dict(times), False
        for _ in range(_ATTEMPTS):
            if bits > most_bits:
                break
            lacking = 0
            try:
                with ctx.workprec(bits):
                    for place, row in self.rows(missing, bits, most_bits):
                        measured = self._measured(row, target)
                        lacking = max(lacking, measured.lacking)
                        if measured.lacking <= 0:
                            proven[place] = measured
            except Coarse as reason:
                if reason.stuck is not None and stuck:
                    raise Unreached(reason.because, reason.stuck) from reason
                more, stuck = reason.bits, reason.stuck is not None
            else:
                more = bits + min(lacking + _MORE_BITS, bits)
            missing = {place: time for place, time in missing.items() if place not in proven}
            if not missing:
                return
            bits = more
        nearest = min(missing.values(), key=abs)
        raise Unreached(
            f"the enclosure does not shrink to a radius of 2^-{target} with {most_bits} bits",
            nearest,
        )

    def _measured(self, row: Row, target: int) -> Proven:
        values, errors, radii, lacking = {}, {}, {}, 0
        for name, (vector, counted) in self.vectors(row).items():
            balls = np.array(vector, dtype=object)
            radii[name], missing = counted.radius(list(balls.flat), target)
            # A vector that may be zero has no known digit: the answer is zero.
            has_digits = mp.isfinite(width(list(balls.flat)))
            middles = np.frompyfunc(midpoint, 1, 1)(balls)
            values[name] = middles if has_digits else np.full(balls.shape, mpf(0), dtype=object)
            errors[name] = np.frompyfunc(radius if has_digits else largest_size, 1, 1)(balls)
            lacking = max(lacking, missing)
        return Proven(values, errors, radii, lacking, self.peaks(row))

    def peaks(self, row: Row) -> dict[str, mpf]:
        """Lower bounds of the largest norms so far."""
        return {name: midpoint(row.peaks[name]) for name in self.own_names}

    def _gathered(self, rows: Sequence[Proven]) -> Motion:
        """The rows as one motion; the radius of a row is that of its widest quantity."""
        widest = np.array([max(row.radii.values()) for row in rows], dtype=object)
        return Motion(
            _stacked([row.values for row in rows], self.names),
            widest,
            _stacked([row.radii for row in rows], self.names),
            _stacked([row.errors for row in rows], self.names),
            _stacked([row.peaks for row in rows], self.own_names),
        )


def rows_of(course: Course, times: Times) -> Iterator[tuple[int, Row]]:
    """The rows of a course at times on both sides of its start, with the places of the times."""
    places: dict[Fraction, list[int]] = {}
    for number, time in times.items():
        places.setdefault(time, []).append(number)
    later = sorted(time for time in places if time > 0)
    earlier = sorted((time for time in places if time < 0), reverse=True)
    yield from ((number, course.first_row()) for number in places.get(Fraction(0), ()))
    for side in filter(None, (later, earlier)):
        for time, row in course.rows(side):
            yield from ((number, row) for number in places[time])


def _stacked(rows: Sequence[Mapping[str, Any]], names: Sequence[str]) -> dict[str, Any]:
    """The entries of rows by name, each as one array of objects."""
    return {name: np.array([row[name] for row in rows], dtype=object) for name in names}


@dataclass(frozen=True)
class Size:
    """The size of a vector or matrix, by which its error is counted; ``largest`` is log2 of its largest."""

    largest: float

    def radius(self, vector: Sequence[arb], target: int) -> tuple[mpf, int]:
        """The width of the vector, and how many bits it lacks.

        A bound of its size, which is absolute, where it may be zero and is negligible beside its own
        largest size.
        """
        relative = width(vector)
        if mp.isfinite(relative):
            return relative, int(mp.mag(relative)) + target if relative else 0
        absolute = size(vector)
        if not mp.isfinite(absolute):
            return mp.inf, target
        negligible = _NEGLIGIBLE_BITS - int(max(self.largest, _LEAST_SIZE))
        return absolute, int(mp.mag(absolute)) + target + negligible


@dataclass(frozen=True)
class SoFar:
    """The largest norm so far of an own state, by which its error is counted; absolute while it is zero."""

    peak: mpf

    def radius(self, vector: Sequence[arb], target: int) -> tuple[mpf, int]:
        """The radius of the vector over the peak, and how many bits it lacks."""
        error = mp.norm([radius(entry) for entry in vector]) / (self.peak or 1)
        if not mp.isfinite(error):
            return mp.inf, target
        return error, int(mp.mag(error)) + target if error else 0
