"""The derivative of a motion under loads that a scene writes down, from the steps that enclose it.

Each step bounds the derivative of its flow. A product of them leads from time to time. Attitude and centre
are in the state where a load depends on them or the scene tracks them: e is the quaternion since the start,
R = R_0 R(e). A turn theta of the frame, in space axes, changes e by (0, R_0^T theta) e/2.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Final

import numpy as np
from flint import arb, ctx

from taylor_verify.exact.balls import ball, midpoint
from taylor_verify.exact.clocks import Floats
from taylor_verify.exact.conditioning.flow import Flow, Steps, products
from taylor_verify.exact.enclosure.course import Course
from taylor_verify.exact.enclosure.loaded import LoadedBody
from taylor_verify.exact.enclosure.stopping import Coarse
from taylor_verify.exact.enclosure.system import System
from taylor_verify.exact.enclosure.walk import Row
from taylor_verify.exact.registry import kind_of
from taylor_verify.exact.rotation import rotation_matrix, rotation_rows
from taylor_verify.exact.solution import Unsettled
from taylor_verify.numbers.precision import floor_log2, power_of_two
from taylor_verify.scenes.instants import chosen
from taylor_verify.scenes.scene import Scene

# Derivatives are wanted to their leading digits, along a motion right to about float64.
_BITS: Final = 96
_MOST_BITS: Final = 4000
_ATTEMPTS: Final = 6
# As many samples as this, and as many times between them, which share no rhythm with the samples.
_POINTS: Final = 400
_GOLDEN: Final = Fraction(0.6180339887498949)


def frame(scene: Scene) -> frozenset[str]:
    """Return attitude and centre as far as a written load depends on them."""
    loads = scene.body.loads
    if loads is None or not loads.reads_attitude:
        return frozenset()
    return frozenset(("attitude", "centre") if loads.reads_centre else ("attitude",))


def between(elapsed: Sequence[Fraction]) -> list[Fraction]:
    """Return samples and the times between them, sorted away from the start."""
    shares = ((k + k * _GOLDEN % 1) / _POINTS for k in range(_POINTS))
    points = {Fraction(0), *chosen(elapsed, _POINTS), *(elapsed[-1] * share for share in shares)}
    return sorted(points, key=abs)


def enclosed(scene: Scene, flow: Flow, elapsed: Sequence[Fraction]) -> Steps:
    """Return the derivative of the motion between these times, the first of which is the start.

    Raises Unsettled where the motion is not reached.
    """
    assert scene.body.loads is not None
    system = LoadedBody(scene, scene.body.loads, scene.track | frame(scene)).system()
    bits = _BITS
    for _ in range(_ATTEMPTS):
        try:
            with ctx.workprec(bits):
                return _steps(scene, flow, system, elapsed, bits)
        except Coarse as reason:
            if reason.bits > _MOST_BITS or reason.stuck is not None:
                raise Unsettled(reason.because or _LOST) from reason
            bits = max(reason.bits, bits * 5 // 4)
    raise Unsettled(_LOST)


_LOST: Final = "the derivative of the motion is not reached"


def _steps(
    scene: Scene, flow: Flow, system: System, elapsed: Sequence[Fraction], bits: int
) -> Steps:
    widths = _widths(system, bits)
    start = [ball(z) + arb(0, w) for z, w in zip(system.start, widths, strict=True)]
    course = Course.of(system, start, None, bits, _MOST_BITS)
    course = replace(course, differentiates=True, begin=scene.clock.start)
    later = [time for time in elapsed if time]
    rows = [course.first_row(), *(row for _, row in course.rows(later))] if later else []
    rows = rows or [course.first_row()]
    frame = _Frame(scene, flow)
    states = np.array([[float(midpoint(entry)) for entry in row.state] for row in rows])
    matrices = [
        frame.counted(states[k - 1], states[k], _floats(rows[k])) for k in range(1, len(rows))
    ]
    steps = np.array(matrices).reshape(len(matrices), frame.size, frame.size)
    momentum, centre, attitude = frame.path(states)
    return Steps(steps, products(steps), momentum, centre, attitude)


def _widths(system: System, bits: int) -> list[arb]:
    """Return a small width for each component of the start: no derivative is made of an exact state."""
    widths: list[arb] = []
    for span in system.spans:
        size = max(abs(system.start[i]) for i in span)
        unit = power_of_two((floor_log2(size) if size else 0) - bits + 8)
        widths += [ball(unit).upper()] * len(span)
    return widths


def _floats(row: Row) -> Floats:
    assert row.since is not None
    return np.array([[float(midpoint(entry)) for entry in line] for line in row.since.tolist()])


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
