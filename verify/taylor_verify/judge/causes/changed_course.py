"""The motion of changed scenes from the start, with states of their own, for many changes at once."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from contextlib import suppress
from copy import copy
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import nan
from typing import Final

import numpy as np

from taylor_verify.judge.causes.arcs import Evidence, moved, parts_of
from taylor_verify.judge.causes.changed_equations import Changes, Equations
from taylor_verify.judge.causes.float_answer import Answer, Motion, velocities_of
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.quaternion_rows import steady_signs
from taylor_verify.models import own
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.loads.states import Instant

# The first row with an error of so many roundings, and some that follow it; or some of a part of all.
_CLEAR: Final = 300.0
_ROWS: Final = 6
_PART: Final = 6
_SPREAD: Final = 8
# What a motion leaves of the errors is settled if it is so little, or if a finer step leaves no less.
_LITTLE: Final = 5e-4
_NOTHING: Final = 1e-9
# A step of a quarter is taken if so many times the work of the last one is left.
_FINER: Final = 12.0
_OF_OWN: Final = 4
# A changed scene, or a method, that explains some rows may cost so much on all of them.
SETTLED: Final = 2_500_000.0
_HALVINGS: Final = 4
_ACCURATE: Final = 1e-5


@dataclass(frozen=True)
class Courses(Evidence):
    """The first wrong rows of an answer, or some of all, beside those of changed scenes from the start.

    No file has all states of the scene's own, so that no arc can begin at a row. Steps are so many times
    ``finer`` than the error needs.
    """

    finer: float = 1.0

    @classmethod
    def of(cls, answer: Answer) -> Courses:
        last = _first_wrong(answer) + _ROWS
        # Each instant costs as much as a row.
        if answer.right.loads is not None and answer.right.loads.held_states:
            return cls(answer.at(np.s_[:last]))
        return cls(answer.at(np.s_[: max(last, answer.count // _PART)]).thinned(_SPREAD))

    def defects(self, sets: Sequence[Changes]) -> Floats:
        answer = self.answer
        motions = courses(answer, sets, self.step)
        return np.array([((answer.file.v - each.v) / answer.sizes).T for each in motions])

    @cached_property
    def step(self) -> float:
        """A step that is accurate enough for the error."""
        answer = self.answer
        h = float(np.max(np.abs(np.diff(answer.times, prepend=answer.begins))))
        goal = max(_ACCURATE * answer.off, float(np.min(answer.rounding)))
        for _ in range(_HALVINGS):
            (motion,) = courses(answer, [{}], h)
            if np.max(np.abs(motion.v - answer.truth.v) / answer.sizes) < goal:
                break
            h /= 2
        return h / self.finer

    def motion(self, answer: Answer, changes: Changes) -> Motion | None:
        """Return the motion of a changed scene at the rows of an answer; None if it runs away."""
        (motion,) = courses(answer, [changes], self.step)
        return motion if np.all(np.isfinite(motion.v)) else None

    def motion_of_fault(self, answer: Answer, changes: Changes) -> Motion | None:
        """Return the motion of a fault that explains some rows; there is work for it, whatever is left."""
        answer.budget.at_least(SETTLED)
        return self.settled(answer, changes)

    def left_by(self, changes: Changes, defects: Floats) -> float:
        motion = self.settled(self.answer, changes)
        if motion is None:
            return np.inf
        return float(np.linalg.norm((self.answer.file.v - motion.v) / self.answer.sizes))

    def settled(self, answer: Answer, changes: Changes) -> Motion | None:
        """Return the motion with the step that a changed scene needs, which may be shorter."""
        best, before = None, np.inf
        h = min(self.step, float(np.max(np.diff(answer.times, prepend=answer.begins))))
        for _ in range(_HALVINGS):
            work = answer.budget.left
            (motion,) = courses(answer, [changes], h)
            work -= answer.budget.left
            left = max(answer.leaves(motion).values())
            if not np.isfinite(left):
                left = np.inf
            elif best is None or left < before:
                best = motion
            is_enough = left < _LITTLE and answer.budget.left < _FINER * work
            if left < _NOTHING or is_enough or before / 2 < left < np.inf:
                break
            before, h = left, h / 4
        return best


def _first_wrong(answer: Answer) -> int:
    """Return the first row whose error is clear, or the last one."""
    clear = [
        np.flatnonzero(answer.error[name] > _CLEAR * answer.roundings[name])
        for name in answer.moving
    ]
    return min((int(rows[0]) for rows in clear if len(rows)), default=answer.count - 1)


def courses(answer: Answer, sets: Sequence[Changes], h: float) -> Iterator[Motion]:
    """Yield the motion at the rows of an answer of each set of changes."""
    for part in parts_of(sets):
        course, rows = Course(answer, answer.right.copies(part), len(part), h), list[Floats]()
        for time in answer.times.tolist():
            course.move(time)
            rows.append(course.row)
        yield from (_motion(answer, each) for each in np.stack(rows, axis=1))


def own_rows(answer: Answer, changes: Changes) -> dict[str, Floats]:
    """Return the rows of each own state in a changed scene, (rows, components), by its name."""
    step = Courses.of(replace(answer, stepping=None)).step / _OF_OWN
    course = Course(answer, answer.right.copies([changes]), 1, step)
    rows = list[dict[str, list[float]]]()
    for time in answer.times.tolist():
        course.move(time)
        rows.append(course.own)
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


class Course:
    """The motion of changed scenes with their own states, from the start on, in steps of about ``h``."""

    def __init__(self, answer: Answer, equations: Equations, sets: int, h: float) -> None:
        self._answer, self._equations, self._h = answer, replace(equations, has_momenta=True), h
        loads = equations.loads
        assert loads is not None
        begin = _start(answer, self._equations, loads)
        self._z = np.repeat(begin, sets // len(begin), axis=0)
        starts = np.array(own.held_starts(loads), dtype=float)
        values = starts if equations.held is None else equations.held
        self._held = np.broadcast_to(values, (sets, len(starts)))
        self._now = answer.begins
        until = Fraction(float(answer.times[-1]))
        self._instants = deque(loads.instants(until))

    @property
    def row(self) -> Floats:
        """The velocities, or the momenta of a file, the attitude and the centre, (sets, components)."""
        if self._answer.right.has_momenta:
            return self._z[:, :, 0]
        nu = self._equations.velocities(np.array([self._now]), self._z)
        return np.concatenate([nu, self._z[:, self._equations.size :]], axis=1)[:, :, 0]

    @property
    def own(self) -> dict[str, list[float]]:
        """The own states of the first set now, by their names."""
        loads = self._equations.loads
        assert loads is not None
        first = self._z.shape[1] - len(loads.continuous)
        names = (*loads.continuous, *loads.held_values)
        now = dict(zip(names, [*self._z[0, first:, 0], *self._held[0]], strict=True))
        return {state.name: [now[each] for each in state.components] for state in loads.states}

    @property
    def v(self) -> Floats:
        """The part of the row that the equations of motion move, (sets, n)."""
        return self.row[:, : self._equations.size]

    def move(self, until: float) -> None:
        """Move to a time, and take the values of the instants up to it."""
        while self._instants and float(self._instants[0].time) <= until:
            instant = self._instants.popleft()
            self._flow(float(instant.time))
            self._held = _taken(self._with_held, instant, self._z, self._held)
        self._flow(until)

    def from_row(self, row: int, loads: Floats) -> Course:
        """Return the course through a row of the file, under constant loads (sets, n) besides its own."""
        own_row, answer, n = copy(self), self._answer, self._equations.size
        own_row._instants = self._instants.copy()
        own_row._equations = replace(self._equations, load=(answer.right.load + loads)[:, :, None])
        z = self._z.copy()
        states = answer.states(n + 7 if answer.start.c is not None else n + 4, np.s_[row : row + 1])
        z[:, n : states.shape[1]] = states[:, n:, None]
        nu = velocities_of(answer.right, answer.file.v[row : row + 1])
        momenta = (self._equations.mass @ nu[0])[None, :, None]
        z[:, :n] = _with_wheels(self._equations, momenta, z, self._now)
        own_row._z = np.repeat(z, len(loads) // len(z), axis=0)
        own_row._held = np.repeat(self._held, len(loads) // len(self._held), axis=0)
        return own_row

    @property
    def _with_held(self) -> Equations:
        return replace(self._equations, held=self._held)

    def _flow(self, until: float) -> None:
        since, span = np.array([self._now]), np.array([until - self._now])
        if until > self._now:
            steps = max(1, round(float(span[0]) / self._h))
            self._z = moved(self._answer, self._with_held, self._z, since, span, steps)
        self._now = until


def _start(answer: Answer, equations: Equations, loads: Loads) -> Floats:
    """Return the first states, (sets, components, 1)."""
    n = equations.size
    masses = equations.mass.reshape(-1, n, n)
    frame = [part[0] for part in (answer.start.q, answer.start.c) if part is not None]
    starts = np.array(own.starts(loads), dtype=float)
    z = np.stack([np.concatenate([answer.momenta(mass), *frame, starts]) for mass in masses])[
        :, :, None
    ]
    z[:, :n] = _with_wheels(equations, z[:, :n], z, 0.0)
    return z


def _with_wheels(equations: Equations, momenta: Floats, z: Floats, time: float) -> Floats:
    """Return momenta of the body with those of wheels that a text writes."""
    has_wheels = equations.loads is not None and any(equations.loads.rotor)
    return momenta + equations.wheels(np.array([time]), z) if has_wheels else momenta


def _taken(equations: Equations, instant: Instant, z: Floats, values: Floats) -> Floats:
    """Return the values that are held after an instant, by those before it, (sets, components)."""
    assert equations.acting is not None
    nu = equations.velocities(np.array([float(instant.time)]), z)
    states = equations.states_of_texts(z, nu)[:, 0]
    taken = np.full((len(states), values.shape[-1]), nan)
    for k, pair in enumerate(zip(states, values, strict=True)):
        # What floats refuse is no number.
        with suppress(ArithmeticError, ValueError):
            taken[k] = equations.acting.taken(instant, *pair)
    return taken


def _motion(answer: Answer, rows: Floats) -> Motion:
    n = answer.n
    q = steady_signs(rows[:, n : n + 4])
    return Motion(rows[:, :n], q, rows[:, n + 4 : n + 7] if answer.file.c is not None else None)
