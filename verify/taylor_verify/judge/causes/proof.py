"""Proof on the whole answer: the motion of a candidate from the scene's start at all rows.

Multiple shooting from the file's own rows Z_k: with F_k = flow(Z_k) and A_k = dF_k/dZ_k the corrections
obey delta_0 = 0, delta_k+1 = A_k delta_k + F_k - Z_k+1. All arcs are integrated at once, and two rounds
are usual.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from taylor_verify.judge.causes.arcs import Arcs, enough_steps, row_to_row
from taylor_verify.judge.causes.changed_equations import Equations
from taylor_verify.judge.causes.float_answer import Answer, Motion
from taylor_verify.judge.causes.kinks import has_kinks, moved_through
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.scenes.instants import evenly

# The standard of proof. What a cause leaves: of the error on the whole answer or of the defects, or so many
# roundings of the file; never more than the caps, with no fitted number and with any.
LEAVES: Final = 1e-3
ROUNDINGS: Final = 3.0
CAPS: Final = (0.1, 0.01)
# More numbers must leave this much less; what leaves no more than this much more explains as well.
BETTER: Final = 10.0
# Corrections at most, and slopes, which a correction of less than this part of the motion leaves as they
# are; they need so many times fewer steps.
_ROUNDS: Final = 16
_SLOPES: Final = 6
_STALE: Final = 1e-3
_SLOW: Final = 0.1
FEWER: Final = 4
# Corrections are done if the next one is less than this; below the other they may be roundings.
_SETTLED: Final = 1e-12
_SMALL: Final = 1e-6
# Rows so near to one motion are stepped to the kinks of the loads from here on.
_NEAR: Final = 1e-4
_LOST: Final = 1e3
_DIFFERENCE: Final = 1e-6
_SOME: Final = 12

# The ends of arcs from their begins, stepped to the kinks of loads or over them.
Go = Callable[[Floats, bool], Floats]
# The same in few steps or in all.
Ahead = Callable[[Floats, bool], Floats]


def may_leave(answer: Answer, groups: Sequence[str], count: int = 0) -> float:
    """Return the part of these groups' errors that a cause with so many fitted numbers may leave."""
    return min(max(LEAVES, ROUNDINGS * answer.floor(groups)), CAPS[min(count, 1)])


def whole(answer: Answer, equations: Equations, components: int = 0) -> Motion | None:
    """Return the motion of the equations from the start of the answer; None if it is not reached.

    With ``components`` it has so many, and else all that the answer has.
    """
    from_start = answer.with_start(equations.mass)
    if from_start.count < 2:
        return None
    n, arcs, has_kinks_ahead = answer.n, row_to_row(from_start), has_kinks(equations)
    # Maps of the attitude go over kinks, to which the motion is stepped.
    least = n + 4 if has_kinks_ahead and answer.file.q is not None else 0
    count = components or max(equations.coupled, least)
    rows = from_start.states(count)
    frame = [part[0] for part in (answer.start.q, answer.start.c) if part is not None]
    rows[0] = np.concatenate([answer.first(equations.mass), *frame])[:count]
    steps = 1 if answer.stepping else _enough_steps(equations, arcs, rows)
    scale = np.concatenate([answer.sizes, np.ones(4), np.full(3, answer.reach)])[:count]

    of_kinks = list[Floats]()

    def go(z: Floats, is_near: bool) -> Floats:
        ends = arcs.moved(equations, z, steps)
        if not (is_near and has_kinks_ahead):
            return ends
        # What kinks change is the same wherever the rows are near, but for a small part of this little.
        if not of_kinks:
            of_kinks.append(moved_through(arcs, equations, z, steps) - ends)
        return ends + of_kinks[0]

    def ahead(z: Floats, is_fine: bool) -> Floats:
        return arcs.moved(equations, z, steps if is_fine else max(1, steps // FEWER))

    if not _shoot(rows, go, ahead, scale, is_near=not has_kinks_ahead):
        return None
    motion = Motion(
        rows[:, :n],
        rows[:, n : n + 4] if count > n else None,
        rows[:, n + 4 :] if count > n + 4 else None,
    )
    if not components:
        has_frame = answer.file.q is not None or n == 6
        motion = _with_frame(motion, equations, replace(arcs, steps_given=steps), has_frame)
    if motion.q is not None:
        motion = replace(motion, q=motion.q / np.linalg.norm(motion.q, axis=1, keepdims=True))
    return motion if answer.is_from_start else motion.at(np.s_[1:])


def _enough_steps(equations: Equations, arcs: Arcs, rows: Floats) -> int:
    """Return the steps of an arc whose error is below a tenth of the file's rounding, and that of all."""
    answer, some = arcs.answer, np.array(evenly(len(arcs.first), _SOME))
    part = min(0.1, 2 / len(arcs.first))
    goal = np.maximum(part * answer.rounding, 2e-14)[:, None] * answer.sizes[:, None]
    begin, few = rows[some].T[None], replace(arcs, first=some, last=some + 1)
    return enough_steps(
        lambda steps: few.moved(equations, begin, steps)[0, : answer.n],
        goal,
        is_patient=not has_kinks(equations),
    )


def _with_frame(motion: Motion, equations: Equations, arcs: Arcs, has_frame: bool) -> Motion:
    """Return the motion with the attitudes and the centres that it lacks, as far as the answer has them."""
    answer = arcs.answer
    if motion.q is None and has_frame:
        of_motion = replace(arcs, answer=replace(answer, file=motion))
        assert answer.start.q is not None
        q = chained(maps_of_attitude(equations, of_motion), answer.start.q[0])
        motion = replace(motion, q=q)
    if motion.c is None and answer.n == 6 and motion.q is not None and answer.file.c is not None:
        begin = [motion.v[:-1].T, motion.q[:-1].T, np.zeros((3, len(arcs.first)))]
        ends = arcs.moved(equations, np.concatenate(begin)[None], arcs.steps)[0, 10:].T
        assert answer.start.c is not None
        path = np.concatenate([answer.start.c, ends])
        motion = replace(motion, c=np.cumsum(path, axis=0))
    return motion


def _shoot(rows: Floats, go: Go, ahead: Ahead, scale: Floats, is_near: bool) -> bool:
    """Correct the rows until they are one motion, near it by another way; False if they become none.

    The slopes are those ``ahead`` in few steps, and serve until a correction is large. Where they lead on
    slowly, as beside kinks, they are made in all steps.
    """
    last, made, is_fine = 1.0, 0, False
    slopes: Floats | None = None
    for _ in range(_ROUNDS):
        if slopes is None:
            made += 1
            if made > _SLOPES:
                return False
            slopes = _slopes(rows, ahead, is_fine, scale)
        ends = go(rows[:-1].T[None], is_near)[0]
        if not (np.all(np.isfinite(ends)) and np.all(np.isfinite(slopes))):
            return False
        correction = np.zeros_like(rows)
        for k, (slope, gap) in enumerate(zip(slopes, ends.T - rows[1:], strict=True)):
            correction[k + 1] = slope @ correction[k] + gap
        size = float(np.max(np.abs(correction) / scale))
        if not size < _LOST:
            return False
        rows += correction
        # The next correction is smaller by as much again, or both are roundings.
        if is_near and (size**2 < _SETTLED * last or (is_fine and last / 2 < size < _SMALL)):
            return True
        is_slow = size > _SLOW * last and size <= _STALE
        if not is_near and size < _NEAR:
            # The other way has a correction of its own.
            is_near, last = True, 1.0
            continue
        if size > _STALE or (is_slow and not is_fine):
            slopes, is_fine = None, is_fine or is_slow
        last = min(size, 1.0)
    return False


def _slopes(rows: Floats, ahead: Ahead, is_fine: bool, scale: Floats) -> Floats:
    """Return the derivatives of the ends of arcs by their begins, (arcs, components, components)."""
    shifts = np.concatenate([np.zeros((1, len(scale))), _DIFFERENCE * np.diag(scale)])
    ends = ahead(rows[:-1].T[None] + shifts[:, :, None], is_fine)
    return np.asarray((ends[1:] - ends[0]).transpose(2, 1, 0) / (_DIFFERENCE * scale))


def with_units(v: Floats) -> Floats:
    """Return v (n, arcs) with each of the four unit quaternions, (4, n + 4, arcs)."""
    n, arcs = v.shape
    unit = np.broadcast_to(np.eye(4)[:, :, None], (4, 4, arcs))
    return np.concatenate([np.broadcast_to(v, (4, n, arcs)), unit], axis=1)


def maps_of_attitude(equations: Equations, arcs: Arcs) -> Floats:
    """Return the maps of q over arcs, (arcs, 4, 4); they are linear, given the moving part."""
    n, begin = arcs.answer.n, with_units(arcs.begin(arcs.answer.n)[0])
    ends = arcs.moved(equations, begin, arcs.steps)
    return np.asarray(ends[:, n:].transpose(2, 1, 0))


def chained(maps: Floats, first: Floats) -> Floats:
    """Return unit quaternions that follow from the first one by linear maps."""
    rows = [first]
    for each in maps:
        q = each @ rows[-1]
        rows.append(q / np.linalg.norm(q))
    return np.array(rows)


def left_of_all(answer: Answer, right: Equations) -> Mapping[str, float]:
    """Return what the motion of equations leaves of the whole answer; nothing if it is not explained."""
    motion = whole(answer, right)
    leaves = {} if motion is None else answer.leaves(motion)
    return leaves if are_explained(answer, leaves) else {}


def are_explained(answer: Answer, leaves: Mapping[str, float]) -> bool:
    return all(leaves.get(name, 1.0) <= may_leave(answer, [name], 1) for name in answer.failed)
