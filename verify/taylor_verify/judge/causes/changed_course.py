"""The motion of changed scenes from the start, with states of their own, for many changes at once."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Final

import numpy as np

from taylor_verify.judge.causes.arcs import Evidence, moved, parts_of
from taylor_verify.judge.causes.changed_equations import Changes, Equations
from taylor_verify.judge.causes.float_answer import Answer, Motion, steady_signs
from taylor_verify.judge.causes.many_flows import Floats
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
# A changed scene that explains some rows may cost so much on all of them.
_SETTLED: Final = 2_500_000.0
_HALVINGS: Final = 4
_ACCURATE: Final = 1e-5


@dataclass(frozen=True)
class Courses(Evidence):
    """The first wrong rows of an answer, or some of all, beside those of changed scenes from the start.

    No file has all states of the scene's own, so that no arc can begin at a row.
    """

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
        return h

    def motion(self, answer: Answer, changes: Changes) -> Motion | None:
        """Return the motion of a changed scene at the rows of an answer; None if it runs away."""
        (motion,) = courses(answer, [changes], self.step)
        return motion if np.all(np.isfinite(motion.v)) else None

    def motion_of_fault(self, answer: Answer, changes: Changes) -> Motion | None:
        """Return the motion of a fault that explains some rows, which may cost more than is left."""
        answer.budget.left = max(answer.budget.left, _SETTLED)
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
            (motion,) = courses(answer, [changes], h)
            left = max(answer.leaves(motion).values())
            if not np.isfinite(left):
                left = np.inf
            elif best is None or left < before:
                best = motion
            if left < _LITTLE or before / 2 < left < np.inf:
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
        equations = replace(answer.right.copies(part), has_momenta=True)
        rows = _course(answer, equations, len(part), h)
        yield from (_motion(answer, each) for each in rows)


def _course(answer: Answer, equations: Equations, sets: int, h: float) -> Floats:
    """Return the velocities, attitudes and centres at the rows, (sets, rows, components)."""
    loads = equations.loads
    assert loads is not None
    z = np.repeat(_start(answer, equations, loads), sets // len(equations.mass_sets), axis=0)
    starts = np.array(own.held_starts(loads), dtype=float)
    values = np.array(
        np.broadcast_to(starts if equations.held is None else equations.held, (sets, len(starts)))
    )
    taken = {float(i.time): i for i in loads.instants(Fraction(float(answer.times[-1])))}
    marks = np.union1d(answer.times, [*taken])
    equations, now, rows = replace(equations, held=values), answer.begins, list[Floats]()
    for mark in marks:
        since, span = np.array([now]), np.array([mark - now])
        if mark > now:
            z = moved(answer, equations, z, since, span, max(1, round(float(span[0]) / h)))
        if mark in taken:
            values = _taken(equations, taken[mark], z, values)
            equations = replace(equations, held=values)
        now = mark
        if mark in answer.times:
            nu = equations.velocities(np.array([now]), z)
            rows.append(np.concatenate([nu, z[:, equations.size :]], axis=1)[:, :, 0])
    return np.stack(rows, axis=1)


def _start(answer: Answer, equations: Equations, loads: Loads) -> Floats:
    """Return the first states, (sets, components, 1)."""
    nu, masses = answer.start.v[0], equations.mass_sets
    frame = [part[0] for part in (answer.start.q, answer.start.c) if part is not None]
    starts = np.array(own.starts(loads), dtype=float)
    z = np.stack([np.concatenate([mass @ nu, *frame, starts]) for mass in masses])[:, :, None]
    if loads.rotor:
        z[:, : equations.size] += equations.wheels(np.array([0.0]), z)
    return z


def _taken(equations: Equations, instant: Instant, z: Floats, values: Floats) -> Floats:
    """Return the values that are held after an instant, by those before it, (sets, components)."""
    assert equations.acting is not None
    nu = equations.velocities(np.array([float(instant.time)]), z)
    states = equations.states_of_texts(z, nu)[:, 0]
    taken = [equations.acting.taken(instant, *pair) for pair in zip(states, values, strict=True)]
    return np.array(taken)


def _motion(answer: Answer, rows: Floats) -> Motion:
    n, right = answer.n, answer.right
    v = rows[:, :n] @ right.mass.T if right.has_momenta else rows[:, :n]
    q = steady_signs(rows[:, n : n + 4])
    return Motion(v, q, rows[:, n + 4 : n + 7] if answer.file.c is not None else None)
