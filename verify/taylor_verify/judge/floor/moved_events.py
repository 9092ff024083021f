"""Times of an event g = 0, and the distance by which the roundoff floor of the state moves them.

An error d of the state z moves the time by |dg/dz| d / |dg/dt|, and the time itself is rounded once:

    attainable(t) = [ (u t)^2 + sum over the blocks z (|dg/dz| attainable_z / |dg/dt|)^2 ]^(1/2).

The floor of the state is that of a file for the same scene, with a row at each event: roundings of the
steps, as many as the scene has samples, and of the input. Both derivatives are differences of g along exact
states. At a kink the larger slope by the state counts, and the smaller one by the time.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Unsettled
from taylor_verify.judge.conventions.axis_orders import quaternion_columns
from taylor_verify.judge.floor.arithmetic import truth_digits, working_bits
from taylor_verify.judge.floor.counted_steps import Steps
from taylor_verify.judge.floor.rounded_input import input_rounding
from taylor_verify.judge.gated import gates_of
from taylor_verify.judge.judged_rows import Run
from taylor_verify.judge.tolerances import NO_TOLERANCES
from taylor_verify.models.acting import Acting
from taylor_verify.models.problem import Problem, adopt
from taylor_verify.numbers.precision import Rung
from taylor_verify.numbers.rotation import product
from taylor_verify.records.quantities import MOMENTA
from taylor_verify.scenes.doubles import within_doubles
from taylor_verify.scenes.loads.states import Continuous
from taylor_verify.scenes.loads.vocabulary import INVARIANTS
from taylor_verify.scenes.reading.event import Event, event_of
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.file import Recorded

Floats = np.ndarray[Any, np.dtype[np.float64]]

# Differences in doubles are of this share of a size: half of the digits are left to them.
_SHARE: Final = 1e-6
_STEP: Final = Fraction(1, 10**5)
_BITS: Final = 53


class NoFloor(Exception):
    """The error for an event whose attainable error is not known; the text says why."""


def attainable_of_events(scene: Scene, text: str, times: Sequence[Fraction], rung: Rung) -> Floats:
    """Return the attainable error of each time of an event, in the order of the motion.

    Raises NoFloor where it is not known.
    """
    event = event_of(scene, text)
    if event.is_extremum:
        raise NoFloor("the rate of the expression is zero at an extremum")
    if not event.loads.inputs.isdisjoint(INVARIANTS[scene.model]):
        raise NoFloor("the expression has an invariant of the free motion")
    scene, samples = _tracking(scene, event), len(scene.clock.instants)
    try:
        with within_doubles(scene, Unsettled), np.errstate(all="ignore"):
            rows = tuple(map(rung.round, times))
            if len(set(rows)) < len(rows):
                raise NoFloor(f"two events are one time in {rung.name}")
            problem = adopt(scene, rung, rows)
            return _attainable(problem, event_of(problem.given, text), samples)
    except Unsettled as doubt:
        raise NoFloor(str(doubt)) from doubt


def _tracking(scene: Scene, event: Event) -> Scene:
    """Return the scene with all that the event and the loads read among its states."""
    loads, frame = event.loads, list[str]()
    if loads.reads_attitude:
        frame = ["attitude", "centre"] if loads.reads_centre else ["attitude"]
    own = {state.name for state in loads.states if isinstance(state, Continuous)}
    return replace(scene, track=frozenset(frame), states=frozenset(own))


def _attainable(problem: Problem, event: Event, samples: int) -> Floats:
    given, rung = problem.given, problem.rung
    floors = _floors(problem, samples)
    function = _Function(given, event)
    slopes = function.slopes()
    step = _STEP * problem.units.time * (1 if given.clock.elapsed[-1] >= 0 else -1)
    squares = sum((slopes[name] * floors[name]) ** 2 for name in slopes)
    times = np.array([float(t) for t in given.clock.instants])
    moved = np.hypot(float(rung.unit_roundoff) * times, np.sqrt(squares) / function.speeds(step))
    if not np.isfinite(moved).all():
        raise NoFloor("the expression does not pass zero at a speed")
    return moved


def _floors(problem: Problem, samples: int) -> dict[str, Floats]:
    """Return the attainable error of each block of the state at the events, in its own unit."""
    given, rung = problem.given, problem.rung
    digits = truth_digits(rung.bits)
    exact = Recorded(solution(given).motion(given.clock.elapsed, digits).quantities)
    run = Run(problem, exact, exact.solve(problem), NO_TOLERANCES)
    inputs = input_rounding(given, rung, problem.scene)
    floors = {}
    with mp.workprec(working_bits(rung.bits)):
        for gate in gates_of(run, Steps(samples), inputs):
            for part, scale in gate.errors.parts.items() if gate.errors.is_state else ():
                floors[part] = gate.attainable * float(scale) * gate.errors.sizes
    return floors


class _Function:
    """The function g of an event along the exact motion of a scene, in doubles."""

    def __init__(self, given: Scene, event: Event) -> None:
        self._given, self._loads = given, event.loads
        self._acting = Acting(given, event.loads)
        self._elapsed = list(given.clock.elapsed)
        self._blocks = self._states(self._elapsed)
        self._here = self._values(self._elapsed, self._blocks)
        if "attitude" in self._blocks:
            # q and -q are one attitude, and g is zero at one of the two.
            other = {**self._blocks, "attitude": -self._blocks["attitude"]}
            values = self._values(self._elapsed, other)
            is_other = abs(values) < abs(self._here)
            self._blocks["attitude"][is_other] *= -1
            self._here = np.where(is_other, values, self._here)

    def slopes(self) -> dict[str, Floats]:
        """Return |dg/dz| at the events by the blocks z: of an attitude by the angle of a turn."""
        return {name: self._slope(name) for name in self._blocks}

    def speeds(self, step: Fraction) -> Floats:
        """Return |dg/dt| at the events from those beside them; 0 where g does not pass zero there.

        ``step`` leads away from the start, before which there is nothing.
        """
        places = range(len(self._elapsed))
        after = self._rates(step, places)
        before, inner = after.copy(), [k for k in places if (self._elapsed[k] - step) * step >= 0]
        before[inner] = self._rates(-step, inner)
        smaller: Floats = np.minimum(abs(before), abs(after))
        return np.where(before * after > 0, smaller, 0.0)

    def _rates(self, step: Fraction, places: Sequence[int]) -> Floats:
        if not places:
            return np.empty(0)
        beside = [self._elapsed[k] + step for k in places]
        states = self._states(beside)
        if "attitude" in states:
            near = np.sum(states["attitude"] * self._blocks["attitude"][places], axis=1)
            states["attitude"][near < 0] *= -1
        rates: Floats = (self._values(beside, states) - self._here[places]) / float(step)
        return rates

    def _slope(self, name: str) -> Floats:
        rows = self._blocks[name]
        size = float(np.max(np.linalg.norm(rows, axis=1))) or 1.0
        squares = np.zeros(len(rows))
        for direction in _turns(rows) if name == "attitude" else np.eye(rows.shape[1]):
            changes = []
            for step in (-_SHARE * size, _SHARE * size):
                moved = {**self._blocks, name: rows + step * direction}
                changes.append(abs(self._values(self._elapsed, moved) - self._here) / abs(step))
            squares += np.maximum(*changes) ** 2
        return np.sqrt(squares)

    def _values(self, elapsed: Sequence[Fraction], blocks: Mapping[str, Floats]) -> Floats:
        times = np.array([float(self._given.clock.start + t) for t in elapsed])
        return self._acting.functions(times, np.hstack(list(blocks.values())))[:, 0]

    def _states(self, elapsed: Sequence[Fraction]) -> dict[str, Floats]:
        """Return the exact states at some times, rounded to doubles."""
        motion = solution(self._given).motion(elapsed, truth_digits(_BITS))
        own = [state.name for state in self._loads.states if isinstance(state, Continuous)]
        frame = [name for name in ("attitude", "centre") if name in self._given.track]
        names = (*MOMENTA[self._given.model], *frame, *own)
        blocks: dict[str, Floats] = {name: motion[name].astype(float) for name in names}
        if "attitude" in blocks:
            q = quaternion_columns(blocks["attitude"])
            blocks["attitude"] = q / np.linalg.norm(q, axis=1, keepdims=True)
        return blocks


def _turns(quaternions: Floats) -> list[Floats]:
    """Return the change of quaternions, by radian, as the body turns about each of its axes."""
    axes = np.eye(4)[1:]
    return [np.transpose(product(list(quaternions.T), list(axis / 2))) for axis in axes]
