"""The derivative of a motion under loads that a scene writes down, from the steps that enclose it.

Each step bounds the derivative of its flow. A product of them leads from time to time. Attitude and centre
are in the state where a load depends on them or the scene tracks them: e is the quaternion since the start,
R = R_0 R(e). A turn theta of the frame, in space axes, changes e by (0, R_0^T theta) e/2.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import Final, final

import numpy as np
from flint import arb, arb_mat

from taylor_verify.exact.balls import ball, balls, midpoint
from taylor_verify.exact.clocks import Floats
from taylor_verify.exact.conditioning.flow import Flow, Steps, products
from taylor_verify.exact.enclosure.course import Course
from taylor_verify.exact.enclosure.loaded import LoadedBody
from taylor_verify.exact.enclosure.walk import Row
from taylor_verify.exact.registry import kind_of
from taylor_verify.exact.rotation import rotation_matrix, rotation_rows
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import NO_CLOSED_FORM, Solution
from taylor_verify.exact.taylor import Enclosing, Times
from taylor_verify.numbers.precision import floor_log2, power_of_two
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.instants import chosen
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.scene import Scene

# As many times between the samples as this, which share no rhythm with them.
_POINTS: Final = 400
_GOLDEN: Final = Fraction(0.6180339887498949)
# Up to this many samples the motion and its derivative come from one run.
_MOST_SAMPLES: Final = 2000
# Digits where the derivative alone is wanted.
DIGITS: Final = 15


def frame(scene: Scene) -> frozenset[str]:
    """Return attitude and centre as far as a written load depends on them."""
    loads = scene.body.loads
    if loads is None or not loads.reads_attitude:
        return frozenset()
    return frozenset(("attitude", "centre") if loads.reads_centre else ("attitude",))


def samples_and_between(elapsed: Sequence[Fraction]) -> list[Fraction]:
    """Return samples, all of them unless they are many, and times between, sorted away from the start."""
    shares = ((k + k * _GOLDEN % 1) / _POINTS for k in range(_POINTS))
    samples = elapsed if len(elapsed) <= _MOST_SAMPLES else chosen(elapsed, _POINTS)
    return sorted({Fraction(0), *samples, *(elapsed[-1] * share for share in shares)}, key=abs)


def truth(scene: Scene, digits: int) -> Solution:
    """Return the exact solution; under written loads that which comes with the derivative of its motion."""
    if scene.body.loads is None or len(scene.clock.elapsed) > _MOST_SAMPLES:
        return solution(scene)
    return Linearised(scene, digits)


def enclosed(scene: Scene, flow: Flow, elapsed: Sequence[Fraction], digits: int = DIGITS) -> Steps:
    """Return the derivative of the motion between these times, the first of which is the start.

    Raises Unsettled where the motion is not reached.
    """
    return _run(scene, tuple(elapsed), digits).steps(flow)


@final
@dataclass(frozen=True)
class Linearised(Solution):
    """The motion of a scene at its own samples from the run that gives its derivative, to ``digits``."""

    scene: Scene
    digits: int

    route = "taylor"
    regime = NO_CLOSED_FORM

    def motion(self, elapsed: Sequence[Fraction], digits: int) -> Motion:
        samples = self.scene.clock.elapsed
        if elapsed != samples or digits > self.digits:
            return solution(self.scene).motion(elapsed, digits)
        motion = _run(self.scene, self._times, self.digits).whole
        return motion.at([self._places[time] for time in elapsed])

    def derivatives(
        self, flow: Flow, begins: Sequence[Fraction], ends: Sequence[Fraction]
    ) -> Floats:
        """Return the derivative of the motion over arcs between samples, or from the start."""
        steps = enclosed(self.scene, flow, self._times, self.digits).steps
        places = ((self._places[a], self._places[b]) for a, b in zip(begins, ends, strict=True))
        return np.array([products(steps[a:b])[-1] for a, b in places])

    @cached_property
    def _times(self) -> tuple[Fraction, ...]:
        return tuple(samples_and_between(self.scene.clock.elapsed))

    @cached_property
    def _places(self) -> Mapping[Fraction, int]:
        return {time: k for k, time in enumerate(self._times)}


@lru_cache(maxsize=4)
def _run(scene: Scene, elapsed: tuple[Fraction, ...], digits: int) -> _Run:
    return _Run(scene, elapsed, digits)


@final
@dataclass(frozen=True)
class _Run(Enclosing):
    """The motion and its derivative at some times, from one run of the enclosure."""

    elapsed: tuple[Fraction, ...]
    digits: int
    states: list[Floats] = field(default_factory=list)
    derivatives: list[Floats] = field(default_factory=list)

    @cached_property
    def whole(self) -> Motion:
        """The motion at all times."""
        return self.motion(self.elapsed, self.digits)

    def steps(self, flow: Flow) -> Steps:
        """The derivative between the times, in the units of a flow."""
        _ = self.whole
        frame, states = _Frame(self.scene, flow), np.array(self.states)
        matrices = [
            frame.counted(states[k - 1], states[k], derivative)
            for k, derivative in enumerate(self.derivatives, start=1)
        ]
        steps = np.array(matrices).reshape(len(matrices), frame.size, frame.size)
        return Steps(steps, products(steps), *frame.path(states))

    def rows(self, times: Times, bits: int, most_bits: int) -> Iterator[tuple[int, Row]]:
        """The row for the place of each time; the course meets all times, whichever are asked for."""
        self.states.clear()
        self.derivatives.clear()
        for place, row in enumerate(self._course(bits, most_bits)):
            self.states.append(np.array([float(midpoint(entry)) for entry in row.state]))
            if row.since is not None:
                self.derivatives.append(_floats(row.since))
            if place in times:
                yield place, self._in_space(row)
            if not any(times.values()):
                # The start belongs to both directions of time.
                return

    def _course(self, bits: int, most_bits: int) -> Iterator[Row]:
        scene = self.scene
        assert scene.body.loads is not None
        system = LoadedBody(scene, scene.body.loads, scene.track | frame(scene)).system()
        course = Course.of(system, _widened(system.start, bits), None, bits, most_bits)
        course = replace(course, differentiates=True, begin=scene.clock.start)
        yield replace(course, start=balls(system.start)).first_row()
        if later := self.elapsed[1:]:
            yield from (row for _, row in course.rows(later))

    def _in_space(self, row: Row) -> Row:
        """The row with the frame that its state has."""
        initial, track = self.scene.initial, self.scene.track
        d, has_centre = len(initial.moving), "centre" in track
        if not track:
            return replace(row, state=row.state[:d])
        start, turned = rotation_matrix(initial.attitude), rotation_rows(row.state[d : d + 4])
        turn = [
            sum((ball(start[i][k]) * turned[k][j] for k in range(3)), arb(0))
            for i in range(3)
            for j in range(3)
        ]
        largest = (*row.largest[: d // 3], row.largest[-2])
        return Row(row.state[:d], turn, row.state[d + 4 :] if has_centre else None, largest)


def _widened(start: Vector, bits: int) -> list[arb]:
    """Return the start with a small width: no derivative is made of an exact state.

    The largest component has it, so that a vector which is zero stays zero.
    """
    widened, k = balls(start), max(range(len(start)), key=lambda i: abs(start[i]))
    unit = power_of_two((floor_log2(start[k]) if start[k] else 0) - bits)
    widened[k] += arb(0, ball(unit).upper())
    return widened


def _floats(derivative: arb_mat) -> Floats:
    return np.array([[float(midpoint(entry)) for entry in line] for line in derivative.tolist()])


class _Frame:
    """The states of the enclosure as momenta, turns and centres, in the units of a flow."""

    def __init__(self, scene: Scene, flow: Flow) -> None:
        body, kind = scene.body, kind_of(scene.body)
        moved = scene.track | frame(scene)
        self._turns, self._travels = bool(moved), "centre" in moved
        self._units = np.array([float(unit) for unit in flow.components])
        self._length = float(flow.length)
        d = self._d = len(self._units)
        self.size = d + 6
        self._momentum = kind.momentum_matrix(body).astype(float)
        self._state = kind.state_matrix(body).astype(float)
        self._start = np.array(rotation_matrix(scene.initial.attitude), dtype=float)

    def counted(self, begin: Floats, end: Floats, derivative: Floats) -> Floats:
        """Return a derivative of the state at ``end`` by that at ``begin``."""
        step = np.eye(self.size)
        reached = self._out(end) @ derivative @ self._into(begin)
        n = len(reached)
        step[:n, :n] = reached
        return step

    def _into(self, state: Floats) -> Floats:
        """Return the matrix from errors of momentum, turn and centre to changes of the state."""
        d, columns = self._d, np.zeros((len(state), self._used))
        columns[:d, :d] = self._state * self._units
        if self._turns:
            columns[d : d + 4, d : d + 3] = _right(state[d : d + 4])[:, 1:] @ self._start.T / 2
        if self._travels:
            columns[d + 4 :, d + 3 :] = np.eye(3) * self._length
        return columns

    def _out(self, state: Floats) -> Floats:
        """Return the matrix from changes of the state to errors of momentum, turn and centre."""
        d, rows = self._d, np.zeros((self._used, len(state)))
        rows[:d, :d] = self._momentum / self._units[:, None]
        if self._turns:
            e = state[d : d + 4] * [1, -1, -1, -1]
            rows[d : d + 3, d : d + 4] = 2 * self._start @ _right(e)[1:]
        if self._travels:
            rows[d + 3 :, d + 4 :] = np.eye(3) / self._length
        return rows

    @property
    def _used(self) -> int:
        return self._d + 3 * self._turns + 3 * self._travels

    def path(self, states: Floats) -> tuple[Floats, Floats, Floats | None]:
        """Return momentum, centre from its start, and attitude at every time."""
        d = self._d
        momentum = states[:, :d] @ self._momentum.T / self._units
        centre = (states[:, d + 4 :] - states[:1, d + 4 :]) / self._length
        if not self._turns:
            return momentum, np.empty((0, 3)), None
        turns = [rotation_rows(e / np.linalg.norm(e)) for e in states[:, d : d + 4]]
        attitude = self._start @ np.array(turns)
        return momentum, centre if self._travels else np.empty((0, 3)), attitude


def _right(e: Floats) -> Floats:
    """Return the matrix of the product with e on the right: p e = right(e) p."""
    a, b, c, d = e
    return np.array([[a, -b, -c, -d], [b, a, d, -c], [c, -d, a, b], [d, c, -b, a]])
