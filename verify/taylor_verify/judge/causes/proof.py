"""Proof on the whole answer: the motion of a candidate from the scene's start at all rows.

Multiple shooting from the file's own rows Z_k: with F_k = flow(Z_k) and A_k = dF_k/dZ_k the corrections
obey delta_0 = 0, delta_k+1 = A_k delta_k + F_k - Z_k+1. All arcs are integrated at once, and two rounds
are usual.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

import numpy as np

from taylor_verify.judge.causes.arcs import Arcs, enough_steps, moved
from taylor_verify.judge.causes.changed_equations import Equations
from taylor_verify.judge.causes.float_answer import Answer, Motion
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.scenes.instants import evenly

# A function from the states of all rows but the last (sets, components, arcs) to those one row later.
Stepper = Callable[[Floats], Floats]

# The standard of proof. What a cause leaves: of the error on the whole answer or of the defects, or so many
# roundings of the file; never more than the caps, with no fitted number and with any.
LEAVES: Final = 1e-3
ROUNDINGS: Final = 3.0
CAPS: Final = (0.1, 0.01)
# More numbers must leave this much less; what leaves no more than this much more explains as well.
BETTER: Final = 10.0
_ROUNDS: Final = 5
# The next correction is of second order.
_SMALL: Final = 1e-6
_LOST: Final = 1e3
_DIFFERENCE: Final = 1e-6
_SOME: Final = 24


def may_leave(answer: Answer, groups: Sequence[str], count: int = 0) -> float:
    """Return the part of these groups' errors that a cause with so many fitted numbers may leave."""
    return min(max(LEAVES, ROUNDINGS * answer.floor(groups)), CAPS[min(count, 1)])


def whole(
    answer: Answer, equations: Equations, stepper: Stepper | None = None, components: int = 0
) -> Motion | None:
    """Return the motion of the equations from the start of the answer; None if it is not reached.

    A ``stepper`` takes the place of the flow for the moving part, or for so many ``components``.
    """
    n, count = answer.n, components or equations.coupled
    start = _start(answer, equations, count)
    rows = answer.states(count)
    times = answer.times
    if not answer.is_from_start:
        rows, times = np.vstack([start, rows]), np.r_[answer.begins, times]
    rows[0] = start
    since, spans = times[:-1], np.diff(times)
    if not len(spans):
        return None
    steps = 1 if stepper else _enough_steps(answer, equations, rows, since, spans)
    go = stepper or (lambda z: moved(answer, equations, z, since, spans, steps))
    scale = np.concatenate([answer.sizes, np.ones(4), np.full(3, answer.reach)])[:count]
    if not _shoot(rows, go, scale):
        return None
    q, c = (rows[:, n : n + 4] if count > n else None), None
    if q is None and (answer.file.q is not None or n == 6) and stepper is None:
        q = _attitudes(answer, equations, rows, since, spans, steps)
    if count > n + 4:
        c = rows[:, n + 4 :]
    elif n == 6 and q is not None and answer.file.c is not None:
        c = _centres(answer, equations, rows[:, :6], q, since, spans, steps)
    unit = None if q is None else q / np.linalg.norm(q, axis=1, keepdims=True)
    motion = Motion(rows[:, :n], unit, c)
    return motion if answer.is_from_start else motion.at(np.s_[1:])


def _start(answer: Answer, equations: Equations, count: int) -> Floats:
    frame = [part[0] for part in (answer.start.q, answer.start.c) if part is not None]
    return np.concatenate([answer.first(equations.mass), *frame])[:count]


def _enough_steps(
    answer: Answer, equations: Equations, rows: Floats, since: Floats, spans: Floats
) -> int:
    """Return the steps of an arc whose error is below a tenth of the file's rounding."""
    some = np.array(evenly(len(spans), _SOME))
    goal = np.maximum(0.1 * answer.rounding, 2e-14)[:, None] * answer.sizes[:, None]
    begin = rows[:-1][some].T[None]
    return enough_steps(
        lambda steps: moved(answer, equations, begin, since[some], spans[some], steps)[
            0, : answer.n
        ],
        goal,
    )


def _shoot(rows: Floats, go: Stepper, scale: Floats) -> bool:
    """Correct the rows until they are one motion; False if they do not become one."""
    shifts = np.concatenate([np.zeros((1, len(scale))), _DIFFERENCE * np.diag(scale)])
    for _ in range(_ROUNDS):
        ends = go(rows[:-1].T[None] + shifts[:, :, None])
        if not np.all(np.isfinite(ends)):
            return False
        slopes = ((ends[1:] - ends[0]).transpose(2, 1, 0)) / (_DIFFERENCE * scale)
        gaps = ends[0].T - rows[1:]
        correction = np.zeros_like(rows)
        for k, (slope, gap) in enumerate(zip(slopes, gaps, strict=True)):
            correction[k + 1] = slope @ correction[k] + gap
        size = np.max(np.abs(correction) / scale)
        if not size < _LOST:
            return False
        rows += correction
        if size < _SMALL:
            return True
    return False


def _attitudes(
    answer: Answer, equations: Equations, rows: Floats, since: Floats, spans: Floats, steps: int
) -> Floats:
    """Return the attitudes of a motion; they are linear in the first one, given the moving part."""
    assert answer.start.q is not None
    ends = moved(answer, equations, with_units(rows[:-1].T), since, spans, steps)
    return chained(ends[:, rows.shape[1] :].transpose(2, 1, 0), answer.start.q[0])


def with_units(v: Floats) -> Floats:
    """Return v (n, arcs) with each of the four unit quaternions, (4, n + 4, arcs)."""
    n, arcs = v.shape
    unit = np.broadcast_to(np.eye(4)[:, :, None], (4, 4, arcs))
    return np.concatenate([np.broadcast_to(v, (4, n, arcs)), unit], axis=1)


def maps_of_attitude(equations: Equations, arcs: Arcs) -> Floats:
    """Return the maps of q over arcs, (arcs, 4, 4); they are linear, given the moving part."""
    n, begin = arcs.answer.n, with_units(arcs.begin(arcs.answer.n)[0])
    ends = moved(arcs.answer, equations, begin, arcs.since, arcs.spans, arcs.steps)
    return np.asarray(ends[:, n:].transpose(2, 1, 0))


def chained(maps: Floats, first: Floats) -> Floats:
    """Return unit quaternions that follow from the first one by linear maps."""
    rows = [first]
    for each in maps:
        q = each @ rows[-1]
        rows.append(q / np.linalg.norm(q))
    return np.array(rows)


def _centres(
    answer: Answer,
    equations: Equations,
    v: Floats,
    q: Floats,
    since: Floats,
    spans: Floats,
    steps: int,
) -> Floats:
    assert answer.start.c is not None
    first = answer.start.c[0]
    frame = np.concatenate([v[:-1].T, q[:-1].T, np.zeros((3, len(spans)))])[None]
    ends = moved(answer, equations, frame, since, spans, steps)[0, 10:].T
    return np.asarray(first + np.concatenate([np.zeros((1, 3)), np.cumsum(ends, axis=0)]))
