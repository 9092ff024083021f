"""The load that explains the rows where no cause is proven: constant from each row to the next.

It is always true and names nothing: with it the scene's equations lead from row to row.
"""

from __future__ import annotations

from contextlib import suppress
from typing import Final

import numpy as np

from taylor_verify.judge.causes.arcs import Arcs, row_to_row
from taylor_verify.judge.causes.budget import Spent
from taylor_verify.judge.causes.changed_course import Course, Courses
from taylor_verify.judge.causes.fit import Sizes
from taylor_verify.judge.causes.float_answer import Answer
from taylor_verify.judge.causes.kinks import moved_through
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.proof import FEWER
from taylor_verify.records.answers import MissingLoad

_ROUNDS: Final = 3
_SHIFT: Final = 1e-3
# A load stands out if it is so many times what the rounding of the rows makes, and at least this part of
# the largest: what is less may be the noise of the method.
_STANDS_OUT: Final = 30.0
_PART: Final = 1e-4
# Rows whose defects are so small a part of the error follow the scene, from elsewhere or at another time.
_FOLLOWS: Final = 1e-6
# The rows must follow to this part of their defects.
_LEAVES: Final = 1e-3
_SHOTS: Final = 6
# Where each arc waits for the one before, there are at most so many.
_MOST_IN_TURN: Final = 50


def missing_load(answer: Answer) -> tuple[MissingLoad, ...]:
    """Return the load between rows; empty where rows are too far apart to tell it, or it is rounding."""
    if answer.count < 4 or not answer.moving:
        return ()
    if answer.has_states:
        answer = answer.thinned(_MOST_IN_TURN)
        return _clear(answer, *_in_turn(answer))
    arcs = row_to_row(answer)
    if np.max(np.abs(arcs.of_right[: answer.n])) < _FOLLOWS * answer.off:
        return ()
    load, slopes, left = _fitted(answer, arcs)
    if not left < _LEAVES * np.linalg.norm(arcs.of_right[: answer.n]):
        return ()
    return _clear(answer, load, slopes)


def _clear(answer: Answer, load: Floats, slopes: Floats) -> tuple[MissingLoad, ...]:
    """Return the loads that stand out of the rounding, with their times."""
    unit = np.abs(np.linalg.inv(slopes)) @ answer.rounding
    sizes = np.linalg.norm(load / Sizes.of(answer).load, axis=1)
    is_clear = np.any(np.abs(load) > _STANDS_OUT * unit, axis=1) & (
        sizes > _PART * np.max(sizes, initial=0.0)
    )
    clear = np.flatnonzero(is_clear)
    times = (answer.times + answer.right.start).tolist()
    return tuple(MissingLoad(times[k], times[k + 1], tuple(load[k].tolist())) for k in clear)


def _in_turn(answer: Answer) -> tuple[Floats, Floats]:
    """Return the load of each arc, and its slopes, where the scene's own states go on from arc to arc.

    They end at an arc that does not reach the next row, or with what may be spent.
    """
    course = Course(answer, answer.right, 1, Courses.of(answer).step)
    course.move(float(answer.times[0]))
    spans = np.diff(answer.times)
    slope, load, loads = _first_slope(answer, course), np.zeros(answer.n), list[Floats]()
    slopes = slope * (spans / spans[0])[:, None, None]
    with suppress(Spent):
        for row, of_row in enumerate(slopes):
            course, load = _shot(answer, course, row, of_row, load)
            loads.append(load)
    return np.reshape(loads, (-1, answer.n)), slopes[: len(loads)]


def _first_slope(answer: Answer, course: Course) -> Floats:
    """Return the slopes of the end of the first arc by its load."""
    n, scale = answer.n, Sizes.of(answer).load * _SHIFT
    tried = course.from_row(0, np.concatenate([np.zeros((1, n)), np.diag(scale)]))
    tried.move(float(answer.times[1]))
    ends = tried.v / answer.sizes
    return np.asarray((ends[1:] - ends[0]).T / scale)


def _shot(
    answer: Answer, course: Course, row: int, slope: Floats, load: Floats
) -> tuple[Course, Floats]:
    """Return the course through a row that ends at the next, and its load; raises Spent for none."""
    first = None
    for _ in range(_SHOTS):
        tried = course.from_row(row, load[None])
        tried.move(float(answer.times[row + 1]))
        defect = (answer.file.v[row + 1] - tried.v[0]) / answer.sizes
        if first is None:
            first = max(float(np.linalg.norm(defect)), float(np.linalg.norm(answer.rounding)))
        elif np.linalg.norm(defect) <= _LEAVES * first:
            return tried, load
        load = load + np.linalg.solve(slope, defect)
    raise Spent


def _fitted(answer: Answer, arcs: Arcs) -> tuple[Floats, Floats, float]:
    """Return the load of each arc (arcs, n), its slopes (arcs, n, n), and the defects that it leaves."""
    right, n, scale = answer.right, answer.n, Sizes.of(answer).load * _SHIFT
    load, begin = np.zeros((len(arcs.first), n)), arcs.begin(max(n, right.coupled))
    few = max(1, arcs.steps // FEWER)
    for _ in range(_ROUNDS):
        shifts = np.concatenate([np.zeros((1, n)), np.diag(scale)])
        tried = right.load[None, :, None] + load.T[None] + shifts[:, :, None]
        ends = arcs.moved(right.changed({"load": tried}), begin, few)[:, :n]
        slopes = (ends[1:] - ends[0]).transpose(2, 1, 0) / (answer.sizes[:, None] * scale)
        there = moved_through(arcs, right.changed({"load": tried[:1]}), begin, arcs.steps)[0, :n]
        defects = ((arcs.end - there) / answer.sizes[:, None]).T
        load = load + np.linalg.solve(slopes, defects[..., None])[..., 0]
    return load, slopes, float(np.linalg.norm(defects))
