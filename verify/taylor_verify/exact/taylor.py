"""The truth where no closed form is known: the equations of both texts, enclosed by Taylor series.

A motion is a set of balls that is proven to contain it (exact.enclosure): the rounding of the data and of
every operation, the truncation of each series, and what the motion makes of all these are bounded.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import ceil, log2
from typing import Any, Final, final

import numpy as np
from flint import arb, ctx
from mpmath import mp, mpf

from taylor_verify.exact.balls import balls, largest_size, midpoint, radius, size, width
from taylor_verify.exact.enclosure.course import Course
from taylor_verify.exact.enclosure.placing import Place
from taylor_verify.exact.enclosure.posing import posed
from taylor_verify.exact.enclosure.stopping import MOST_STEPS, Coarse, Unreached
from taylor_verify.exact.enclosure.system import System
from taylor_verify.exact.enclosure.walk import Row
from taylor_verify.exact.registry import kind_of
from taylor_verify.exact.rotation import rotation_matrix
from taylor_verify.exact.solution import NO_CLOSED_FORM, Solution, Unsettled
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.loads.states import Held
from taylor_verify.scenes.motion import Motion, State
from taylor_verify.scenes.scene import Scene

_GUARD_BITS: Final = 40
_MORE_BITS: Final = 16
# A motion without instants takes about so many steps.
_FEW_STEPS: Final = 50
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
class _Proven:
    """A row: midpoints, the errors of all components, radii, and the bits that the widest one lacks.

    ``peaks`` are lower bounds of the largest norms so far of the scene's own states.
    """

    values: Mapping[str, Any]
    errors: Mapping[str, Any]
    radii: Mapping[str, mpf]
    lacking: int
    peaks: Mapping[str, mpf]


@dataclass(frozen=True)
class Enclosing(Solution):
    """Motions in balls, at whatever precision makes them narrow enough."""

    scene: Scene

    route = "taylor"
    regime = NO_CLOSED_FORM

    def rows(self, times: Times, bits: int, most_bits: int) -> Iterator[tuple[int, Row]]:
        """A row of balls for the place of each time, at ``bits`` bits, which are the ambient precision.

        What was yielded before Coarse or Unreached was raised stands.
        """
        raise NotImplementedError

    def _before(self, times: Times, unreached: Fraction) -> Times:
        """The times on one side of the start that are reached without this one: none, unless stated."""
        return {}

    @cached_property
    def _system(self) -> System:
        return posed(self.scene)

    def _system_until(self, time: Fraction) -> System:
        """The system as far as an elapsed time; stairs of floor are listed so far."""
        loads = self.scene.body.loads
        if loads is None or (further := loads.reaching(time)) is loads:
            return self._system
        try:
            _ = further.switches
        except ValueError as fault:
            raise Unreached(str(fault), time) from None
        return posed(replace(self.scene, body=self.scene.body.with_loads(further)))

    @final
    def motion(self, elapsed: Sequence[Fraction], digits: int) -> Motion:
        """The midpoints, and the proven radius of every vector and matrix relative to its norm.

        Raises Unsettled where more than a million steps, or ten thousand bits more than the digits
        take, would be needed; with the rows of the times that lie before.
        """
        target = ceil(digits * log2(10))
        first = target + _GUARD_BITS + self._rounding_bits(elapsed)
        most_bits = 2 * target + _MOST_BITS
        proven: dict[int, _Proven] = {}
        doubts = []
        for is_later in (True, False):
            limit, doubt = most_bits, None
            times: Times = {k: time for k, time in enumerate(elapsed) if (time >= 0) is is_later}
            while times:
                try:
                    self._prove(proven, times, target, first, limit)
                except Unreached as reason:
                    # The sentence on a nearer time replaces the sentence on a later time.
                    hint = "; ask for it without the times behind it" if doubt else ""
                    limit, doubt = min(limit, 2 * target + _MOST_BITS_BESIDE), f"{reason}{hint}"
                    times = self._before(times, reason.time)
                times = {place: time for place, time in times.items() if place not in proven}
            if doubt is not None:
                doubts.append(doubt)
        places = sorted(proven)
        motion = self._gathered([proven[place] for place in places])
        if doubts:
            raise Unsettled("; ".join(doubts), motion if places else None, places)
        return motion

    def _rounding_bits(self, elapsed: Sequence[Fraction]) -> int:
        """The bits that are rounded away in the steps from instant to instant, beyond those of others."""
        loads = self.scene.body.loads
        if loads is None or not loads.held_values:
            return 0
        last = max((*elapsed, Fraction(0)))
        count = sum(state.count(last) for state in loads.states if isinstance(state, Held))
        return max(0, ceil(log2(max(count, 1) / _FEW_STEPS)))

    def _prove(
        self, proven: dict[int, _Proven], times: Times, target: int, bits: int, most_bits: int
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

    def _measured(self, row: Row, target: int) -> _Proven:
        values, errors, radii, lacking = {}, {}, {}, 0
        for name, (vector, counted) in self._vectors(row).items():
            balls = np.array(vector, dtype=object)
            radii[name], missing = counted.radius(list(balls.flat), target)
            # A vector that may be zero has no known digit: the answer is zero.
            has_digits = mp.isfinite(width(list(balls.flat)))
            middles = np.frompyfunc(midpoint, 1, 1)(balls)
            values[name] = middles if has_digits else np.full(balls.shape, mpf(0), dtype=object)
            errors[name] = np.frompyfunc(radius if has_digits else largest_size, 1, 1)(balls)
            lacking = max(lacking, missing)
        return _Proven(values, errors, radii, lacking, self._peaks(row))

    def _vectors(self, row: Row) -> dict[str, tuple[Any, _Size | _SoFar]]:
        """Return the tracked quantities as balls, with their largest sizes so far."""
        vectors: dict[str, tuple[Any, _Size | _SoFar]] = {
            name: (row.state[3 * k : 3 * k + 3], _Size(row.largest[k]))
            for k, name in enumerate(kind_of(self.scene.body).moving)
        }
        if row.turn:
            vectors["attitude"] = [row.turn[i : i + 3] for i in (0, 3, 6)], _Size(0.0)
        if row.centre is not None:
            vectors["centre"] = row.centre, _Size(row.largest[-1])
        for name, peak in self._peaks(row).items():
            places = self._system.own[name]
            vectors[name] = row.state[places.start : places.stop], _SoFar(peak)
        return vectors

    def _peaks(self, row: Row) -> dict[str, mpf]:
        """Lower bounds of the largest norms so far of the tracked own states."""
        return {name: midpoint(row.peaks[name]) for name in self._own}

    @property
    def _own(self) -> list[str]:
        return [group.name for group in self.scene.groups if group.name in self.scene.states]

    def _gathered(self, rows: Sequence[_Proven]) -> Motion:
        """The rows as one motion; the radius of a row is that of its widest quantity."""
        track = self.scene.track
        frame = ["attitude"] * bool(track) + ["centre"] * ("centre" in track)
        names = [*kind_of(self.scene.body).moving, *frame, *self._own]
        widest = np.array([max(row.radii.values()) for row in rows], dtype=object)
        return Motion(
            _stacked([row.values for row in rows], names),
            widest,
            _stacked([row.radii for row in rows], names),
            _stacked([row.errors for row in rows], names),
            _stacked([row.peaks for row in rows], self._own),
        )


def _stacked(rows: Sequence[Mapping[str, Any]], names: Sequence[str]) -> dict[str, Any]:
    """The entries of rows by name, each as one array of objects."""
    return {name: np.array([row[name] for row in rows], dtype=object) for name in names}


@final
@dataclass(frozen=True)
class TaylorSolution(Enclosing):
    """The motion of any scene, free or loaded, in balls that are proven to contain it."""

    most_steps: int = MOST_STEPS

    def rows(self, times: Times, bits: int, most_bits: int) -> Iterator[tuple[int, Row]]:
        system = self._system_until(max(times.values(), key=abs))
        start, place = system.start_balls(), _place(self.scene, self.scene.initial, system)
        course = Course.of(system, start, place, bits, most_bits)
        course = replace(course, most_steps=self.most_steps, begin=self.scene.clock.start)
        places: dict[Fraction, list[int]] = {}
        for number, time in times.items():
            places.setdefault(time, []).append(number)
        later = sorted(time for time in places if time > 0)
        earlier = sorted((time for time in places if time < 0), reverse=True)
        yield from ((number, course.first_row()) for number in places.get(Fraction(0), ()))
        for side in filter(None, (later, earlier)):
            for time, row in course.rows(side):
                yield from ((number, row) for number in places[time])

    def _before(self, times: Times, unreached: Fraction) -> Times:
        return {place: t for place, t in times.items() if abs(t) < abs(unreached)}


def arcs(
    scene: Scene,
    starts: Sequence[State],
    spans: Sequence[Fraction],
    digits: int,
    begins: Sequence[Fraction] = (),
    own: Sequence[Mapping[str, Vector]] = (),
) -> Motion:
    """Row k: where the scene's equations lead from the exact state starts[k] in the time spans[k].

    Enclosed to ``digits``, as Solution.motion is, and raises Unsettled likewise. The loads of a
    manufactured motion change with time: there each arc has to say when it begins, ``begins`` since the
    start of the scene. Elsewhere that changes nothing. A scene with states of its own needs these too:
    ``own`` has them by name, those that are held as they are after an instant at the beginning of an arc.
    """
    body = scene.body
    changes = body.manufactured is not None or body.loads is not None
    if changes and len(begins) != len(starts):
        raise ValueError(
            f"expected the times at which {len(starts)} arcs under loads that change with time begin, "
            f"got {len(begins)} @ {scene.name}"
        )
    if body.loads is not None and body.loads.states and len(own) != len(starts):
        raise ValueError(
            f"expected the scene's own states at the start of {len(starts)} arcs, "
            f"got {len(own)} @ {scene.name}"
        )
    return _Arcs(scene, tuple(starts), tuple(begins), tuple(own)).motion(spans, digits)


@final
@dataclass(frozen=True)
class _Arcs(Enclosing):
    """Many short motions of one body, each from a state of its own, and by the clock from its time."""

    starts: tuple[State, ...]
    begins: tuple[Fraction, ...]
    own: tuple[Mapping[str, Vector], ...]

    def rows(self, times: Times, bits: int, most_bits: int) -> Iterator[tuple[int, Row]]:
        whole = Course.of(
            self._system, (), _place(self.scene, self.starts[0], self._system), bits, most_bits
        )
        for number, span in times.items():
            start, begin = self.starts[number], self.begins[number] if self.begins else Fraction(0)
            if len(whole.system.start) > len(start.moving):
                # The frame is in the state, and counts from the start of its own arc.
                system = posed(self._arc_scene(number, begin + span))
                whole = Course.of(system, (), _place(self.scene, start, system), bits, most_bits)
                state = system.start_balls(begin)
            else:
                state = balls(kind_of(self.scene.body).state(start))
            place = _place(self.scene, start, whole.system)
            arc = replace(whole, start=state, place=place, origin=begin, has_values=True)
            yield number, next(arc.rows([span]))[1] if span else arc.first_row()

    def _arc_scene(self, number: int, end: Fraction) -> Scene:
        """The scene with the start of an arc, and stairs of floor as far as its end."""
        scene = replace(self.scene, initial=self.starts[number])
        if scene.body.loads is None:
            return scene
        loads = scene.body.loads.reaching(end)
        loads = loads.starting(self.own[number]) if self.own else loads
        return replace(scene, body=scene.body.with_loads(loads))


def _place(scene: Scene, initial: State, system: System) -> Place | None:
    """The frame at the start in balls, at the ambient precision; None where it is not followed apart."""
    if not scene.track or not system.is_framed:
        return None
    centre = kind_of(scene.body).centre(initial) if "centre" in scene.track else None
    return Place.of(rotation_matrix(initial.attitude), centre)


@dataclass(frozen=True)
class _Size:
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
class _SoFar:
    """The largest norm so far of an own state, by which its error is counted; absolute while it is zero."""

    peak: mpf

    def radius(self, vector: Sequence[arb], target: int) -> tuple[mpf, int]:
        """The radius of the vector over the peak, and how many bits it lacks."""
        error = mp.norm([radius(entry) for entry in vector]) / (self.peak or 1)
        if not mp.isfinite(error):
            return mp.inf, target
        return error, int(mp.mag(error)) + target if error else 0
