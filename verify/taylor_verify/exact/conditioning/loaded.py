"""The derivative of a motion without closed form, as under written loads, from the steps that enclose it.

Each step bounds the derivative of its flow. A product of them leads from time to time. Attitude and centre
are in the state where a load depends on them or the scene tracks them: e is the quaternion since the start,
R = R_0 R(e). A turn theta of the frame, in space axes, changes e by (0, R_0^T theta) e/2.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property, lru_cache
from itertools import chain, pairwise
from typing import Final, NamedTuple, final

import numpy as np
from flint import arb, arb_mat

from taylor_verify.exact.balls import midpoint
from taylor_verify.exact.conditioning.linearised import Flow, Steps, products
from taylor_verify.exact.conditioning.path_times import MOST_OF_RUN, times_of_run
from taylor_verify.exact.enclosure.box import Box
from taylor_verify.exact.enclosure.course import Course
from taylor_verify.exact.enclosure.image import Image
from taylor_verify.exact.enclosure.walk import Row
from taylor_verify.exact.proving import Times
from taylor_verify.exact.quadratic_forms import Floats
from taylor_verify.exact.registry import kind_of
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import NO_CLOSED_FORM, Solution
from taylor_verify.exact.taylor import Enclosing
from taylor_verify.numbers.precision import floor_log2, power_of_two
from taylor_verify.numbers.rotation import product, rotation_matrix, rotation_rows
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.scene import Scene

# Digits where the derivative alone is wanted.
DIGITS: Final = 15


def frame(scene: Scene) -> frozenset[str]:
    """Return attitude and centre as far as the scene tracks them or a written load depends on them."""
    loads = scene.body.loads
    if loads is None or not loads.reads_attitude:
        return scene.track
    return scene.track.union(("attitude", "centre") if loads.reads_centre else ("attitude",))


def is_of_run(scene: Scene) -> bool:
    """Return True if one run of the enclosure gives motion and derivative: there is no closed form."""
    return scene.body.loads is not None or solution(scene).route == "taylor"


def truth(scene: Scene, digits: int) -> Solution:
    """Return the exact solution; without closed form that which comes with the derivative of its motion."""
    if not is_of_run(scene) or len(scene.clock.elapsed) > MOST_OF_RUN:
        return solution(scene)
    return Linearised(scene, digits)


def known(scene: Scene, digits: int) -> Solution:
    """Return the exact solution: that of the run which gives the derivative, where that is made already."""
    exact = truth(scene, digits)
    is_unmade = isinstance(exact, Linearised) and not exact.is_made
    return solution(scene) if is_unmade else exact


def enclosed(scene: Scene, elapsed: Sequence[Fraction], digits: int = DIGITS) -> Steps:
    """Return the derivative of the motion between these times, the first of which is the start.

    Raises Unsettled where the motion is not reached.
    """
    return _run(scene, tuple(elapsed), digits).steps()


@final
@dataclass(frozen=True)
class Linearised(Solution):
    """The motion of a scene from the run that gives its derivative, at its own samples, to ``digits``."""

    scene: Scene
    digits: int

    route = "taylor"
    regime = NO_CLOSED_FORM

    def motion(self, elapsed: Sequence[Fraction], digits: int) -> Motion:
        if digits > self.digits or not self._places.keys() >= set(elapsed):
            return solution(self.scene).motion(elapsed, digits)
        motion = _run(self.scene, self._times, self.digits).whole
        return motion.at([self._places[time] for time in elapsed])

    def derivatives(self, begins: Sequence[Fraction], ends: Sequence[Fraction]) -> Floats:
        """Return the derivative of the motion over arcs between samples, or from the start."""
        steps = enclosed(self.scene, self._times, self.digits).steps
        places = ((self._places[a], self._places[b]) for a, b in zip(begins, ends, strict=True))
        return np.array([products(steps[a:b])[-1] for a, b in places])

    @property
    def is_made(self) -> bool:
        """True if the run has been made."""
        return "whole" in vars(_run(self.scene, self._times, self.digits))

    @cached_property
    def _times(self) -> tuple[Fraction, ...]:
        return tuple(times_of_run(self.scene))

    @cached_property
    def _places(self) -> Mapping[Fraction, int]:
        return {time: k for k, time in enumerate(self._times)}


@lru_cache(maxsize=4)
def _run(scene: Scene, elapsed: tuple[Fraction, ...], digits: int) -> _Run:
    return _Run(scene, elapsed, digits)


class _Point(NamedTuple):
    """The state at one time, and the derivative of the wheels' momentum by own states, as float64."""

    state: Floats
    wheels: Floats


@final
@dataclass(frozen=True)
class _Run(Enclosing):
    """The motion and its derivative at some times, from one run of the enclosure."""

    elapsed: tuple[Fraction, ...]
    digits: int
    visited: list[tuple[_Point, Floats]] = field(default_factory=list)

    @cached_property
    def whole(self) -> Motion:
        """The motion at all times."""
        return self.motion(self.elapsed, self.digits)

    def steps(self) -> Steps:
        """The derivative between the times, in the units of the scene's flow."""
        _ = self.whole
        states = np.array([point.state for point, _ in self.visited])
        frame = _Frame(self.scene, self._system.own, states)
        matrices = [
            frame.counted(begin, end, derivative)
            for (begin, _), (end, derivative) in pairwise(self.visited)
        ]
        steps = np.array(matrices).reshape(len(matrices), frame.size, frame.size)
        own = frame.own, frame.own_units
        return Steps(steps, products(steps), *frame.path(states), *own, frame.flow)

    def rows(self, times: Times, bits: int, most_bits: int) -> Iterator[tuple[int, Row]]:
        """The row for the place of each time; the course meets all times, whichever are asked for.

        What a whole course has visited stays where only some rows are asked for again, with more digits.
        """
        visited = list[tuple[_Point, Floats]]()
        for place, row in enumerate(self._course(bits, most_bits)):
            assert row.since is not None
            visited.append((self._point(row, self.elapsed[place]), _floats(row.since)))
            if len(visited) == len(self.elapsed):
                self.visited[:] = visited
            if place in times:
                yield place, row
            if not any(times.values()):
                # The start belongs to both directions of time.
                return

    def _course(self, bits: int, most_bits: int) -> Iterator[Row]:
        start = self._system.start_balls()
        course = Course.of(self._system, _widened(start, bits), bits, most_bits)
        course = replace(course, differentiates=True, begin=self.scene.clock.start)
        yield replace(course, start=start).first_row()
        if later := self.elapsed[1:]:
            yield from (row for _, row in course.rows(later))

    def _point(self, row: Row, time: Fraction) -> _Point:
        state = np.array([float(midpoint(entry)) for entry in row.state])
        d, own = len(self.scene.initial.moving), [*chain(*self._system.own.values())]
        image = self._system.pieces(time, self.elapsed[-1] >= 0).image
        if image is None:
            return _Point(state, np.zeros((d, len(own))))
        # omega = K (H - h), and the wheels h do not depend on H.
        slopes = _floats(Image(image, Box.about(row.state), time).outputs().slopes)
        momentum = kind_of(self.scene.body).momentum_matrix(self.scene.body).astype(float)
        return _Point(state, -momentum @ slopes[:d, own])


def _widened(start: Sequence[arb], bits: int) -> list[arb]:
    """Return the start with a small width: no derivative is made of an exact state.

    The largest component has it, so that a vector which is zero stays zero.
    """
    widened, k = list(start), max(range(len(start)), key=lambda i: abs(float(midpoint(start[i]))))
    size = widened[k].abs_upper() or arb(1)
    widened[k] += arb(0, (size * arb(2) ** -bits).upper())
    return widened


def _floats(derivative: arb_mat) -> Floats:
    return np.array([[float(midpoint(entry)) for entry in line] for line in derivative.tolist()])


class _Frame:
    """The states of the enclosure as momenta, turns, centres and own states, in the units of the flow."""

    def __init__(self, scene: Scene, own: Mapping[str, range], states: Floats) -> None:
        body, kind, moved = scene.body, kind_of(scene.body), frame(scene)
        self._momentum = kind.momentum_matrix(body).astype(float)
        momenta = states[:, : len(self._momentum)] @ self._momentum.T
        flow = self.flow = Flow.along(scene, momenta)
        self._turns, self._travels = bool(moved), "centre" in moved
        self._units = np.array([float(unit) for unit in flow.components])
        self._length = float(flow.length)
        d = self._d = len(self._units)
        self.own = {name: states[:, places.start : places.stop] for name, places in own.items()}
        self.own_units = {name: _unit(rows) for name, rows in self.own.items()}
        self._own = [place for places in own.values() for place in places]
        counts = [float(self.own_units[name]) for name, places in own.items() for _ in places]
        self._own_counts = np.diag(np.array(counts))
        self.size = d + 6 + len(self._own)
        self._reads_frame = body.loads is not None and body.loads.reads_attitude
        self._others = np.r_[0:d, d + 6 : self.size]
        self._into_state, self._from_state = kind.state_matrix(body).astype(float), self._momentum
        if body.loads is not None and body.loads.rotor:
            # The enclosure follows H = I omega + h, though omega stands in the state.
            self._into_state = self._from_state = np.eye(d)
        self._start = np.array(rotation_matrix(scene.initial.attitude), dtype=float)

    def counted(self, begin: _Point, end: _Point, derivative: Floats) -> Floats:
        """Return a derivative of the state at ``end`` by that at ``begin``."""
        step: Floats = self._out(end) @ derivative @ self._into(begin)
        if not self._reads_frame:
            # The balls hold zero there, and their midpoints are noise beside a small momentum.
            step[self._others, self._d : self._d + 6] = 0
        for first in (self._d,) * (not self._turns) + (self._d + 3,) * (not self._travels):
            step[first : first + 3, first : first + 3] = np.eye(3)
        return step

    def _into(self, point: _Point) -> Floats:
        """Return the matrix from errors of momentum, turn, centre and own states to those of the state."""
        state, d = point.state, self._d
        columns = np.zeros((len(state), self.size))
        columns[:d, :d] = self._into_state * self._units
        columns[:d, d + 6 :] = point.wheels @ self._own_counts
        columns[self._own, d + 6 :] = self._own_counts
        if self._turns:
            columns[d : d + 4, d : d + 3] = _right(state[d : d + 4])[:, 1:] @ self._start.T / 2
        if self._travels:
            columns[d + 4 : d + 7, d + 3 : d + 6] = np.eye(3) * self._length
        return columns

    def _out(self, point: _Point) -> Floats:
        """Return the matrix from changes of the state to the errors that a path has."""
        state, d = point.state, self._d
        rows = np.zeros((self.size, len(state)))
        rows[:d, :d] = self._from_state
        rows[:d, self._own] -= point.wheels
        rows[:d] /= self._units[:, None]
        rows[d + 6 :, self._own] = np.linalg.inv(self._own_counts)
        if self._turns:
            e = state[d : d + 4] * [1, -1, -1, -1]
            rows[d : d + 3, d : d + 4] = 2 * self._start @ _right(e)[1:]
        if self._travels:
            rows[d + 3 : d + 6, d + 4 : d + 7] = np.eye(3) / self._length
        return rows

    def path(self, states: Floats) -> tuple[Floats, Floats, Floats | None]:
        """Return momentum, centre from its start, and attitude at every time."""
        d = self._d
        momentum = states[:, :d] @ self._momentum.T / self._units
        centre = (states[:, d + 4 : d + 7] - states[:1, d + 4 : d + 7]) / self._length
        if not self._turns:
            return momentum, np.empty((0, 3)), None
        turns = [rotation_rows(e / np.linalg.norm(e)) for e in states[:, d : d + 4]]
        attitude = self._start @ np.array(turns)
        return momentum, centre if self._travels else np.empty((0, 3)), attitude


def _unit(rows: Floats) -> Fraction:
    """A power of two near the largest size of an own state; 1 of one that is zero."""
    largest = float(np.max(np.abs(rows), initial=0.0))
    return power_of_two(floor_log2(Fraction(largest))) if largest else Fraction(1)


def _right(e: Floats) -> Floats:
    """Return the matrix of the product with e on the right: p e = right(e) p."""
    return np.array([product(unit, e.tolist()) for unit in np.eye(4).tolist()]).T
