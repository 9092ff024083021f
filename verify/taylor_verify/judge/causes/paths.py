"""Paths that follow from the right velocities and attitudes by a wrong rate, or in steps of first order."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.arcs import moved, row_to_row
from taylor_verify.judge.causes.candidate import Cause
from taylor_verify.judge.causes.changed_equations import Equations, Path
from taylor_verify.judge.causes.float_answer import Answer
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.many_frames import to_space
from taylor_verify.words.causes import steps_in_words

# What the velocities and attitudes are wrong by is nothing beside the path.
_RIGHT: Final = 1e-3
_WRONG: Final = 30.0
_SINGLE: Final = 1e-6
_MOST: Final = 64
# The steps fit the error of the path so well that they are replayed.
_FITS: Final = 0.3


def _by_heading(R: Any, U: Floats) -> Floats:
    """Return R_z(yaw) U, with the yaw of R = R_z(yaw) R_y(pitch) R_x(roll)."""
    x, y = R[:, 0, 0], R[:, 1, 0]
    level = np.hypot(x, y)
    c, s = x / level, y / level
    return np.stack([c * U[:, 0] - s * U[:, 1], s * U[:, 0] + c * U[:, 1], U[:, 2] + 0 * c], axis=1)


_TURNED: Final[dict[str, Path]] = {
    "is the path by R^T: c' = R^T U in place of R U": (
        lambda R, U, current: to_space(R.swapaxes(1, 2), U) + current
    ),
    "is the path by the heading alone, without pitch and roll": (
        lambda R, U, current: _by_heading(R, U) + current
    ),
    "is the path without the attitude: c' = U, not turned into space axes": (
        lambda R, U, current: U + current
    ),
}
_DRIFTING: Final[dict[str, Path]] = {
    "is the path without the current": lambda R, U, current: to_space(R, U),
    "is the path with the current in body axes": lambda R, U, current: to_space(R, U + current),
    "is the path with the current of the other sign": (
        lambda R, U, current: to_space(R, U) - current
    ),
    "is the path with the current twice": lambda R, U, current: to_space(R, U) + 2 * current,
}


def paths(answer: Answer) -> Iterator[tuple[str, Floats]]:
    """Yield the centres of a right motion whose path has another rate, in words.

    None of them is for a motion that is wrong itself, whose path is wrong with it.
    """
    if answer.has_states or not _is_right(answer):
        return
    right, from_start = answer.right, _along_truth(answer)
    for words, path in (*_TURNED.items(), *(_DRIFTING.items() if any(right.current) else ())):
        yield words, _path(answer, from_start, right.changed({"path": path}))
    yield from _in_steps(answer, from_start)


def contradicts(answer: Answer) -> Cause | None:
    """Return the cause of a path that does not follow from right velocities and attitudes."""
    if answer.has_states or answer.file.q is None or not _is_right(answer):
        return None
    own = answer.with_start(answer.right.mass)
    assert own.file.c is not None
    apart = np.linalg.norm(np.diff(own.file.c, axis=0) - _steps(own, own.right), axis=1)
    worst = int(np.argmax(apart))
    # Centres in float32 contradict nothing.
    if not apart[worst] > max(_WRONG * answer.roundings["centre"], _SINGLE * answer.reach):
        return None
    first, last = own.times[worst : worst + 2] + own.right.start
    words = (
        "the centre contradicts the file's own velocities and attitude, which are right: from one row to "
        f"the next it goes up to {apart[worst]:.2g} elsewhere than they lead, most from t = {first:.6g} to "
        f"{last:.6g}"
    )
    return Cause(words, "path against velocities", {})


def _is_right(answer: Answer) -> bool:
    """Return True if the velocities and attitudes are right, and the centre is not."""
    wrong = answer.worst["centre"] / answer.reach
    others = [error for name, error in answer.worst.items() if name != "centre"]
    return max(others) < _RIGHT * wrong


def _along_truth(answer: Answer) -> Answer:
    """Return the true motion as an answer, with the start as its first row."""
    return replace(answer, file=answer.truth).with_start(answer.right.mass)


def _path(answer: Answer, from_start: Answer, equations: Equations) -> Floats:
    """Return the centres at the rows of an answer by the path of the equations."""
    return _from_start(answer, _steps(from_start, equations))


def _from_start(answer: Answer, steps: Floats) -> Floats:
    assert answer.start.c is not None
    rows = np.cumsum(np.concatenate([answer.start.c, steps]), axis=0)
    return rows[len(rows) - answer.count :]


def _steps(answer: Answer, equations: Equations) -> Floats:
    """Return how far the centre goes from each row to the next, (rows - 1, 3)."""
    arcs, n = row_to_row(answer), answer.n
    begin = arcs.begin(n + 7)
    return (arcs.moved(equations, begin, arcs.steps) - begin)[0, n + 4 :].T


def _in_steps(answer: Answer, from_start: Answer) -> Iterator[tuple[str, Floats]]:
    """Yield the paths of steps of first order, with the velocities at their begin or at their end."""
    assert answer.file.c is not None
    assert answer.truth.c is not None
    arcs, n, right = row_to_row(from_start), answer.n, answer.right
    z = from_start.states(n + 7).T[None]
    rates = right.rates(from_start.times, z)[0, n + 4 :].T
    change = (rates - rates[0])[-answer.count :]
    error = answer.file.c - answer.truth.c
    h = -2 * np.sum(error * change) / max(float(np.sum(change**2)), 1e-300)
    spans = float(np.median(np.abs(arcs.spans)))
    is_near = np.linalg.norm(error + h / 2 * change) < _FITS * np.linalg.norm(error)
    if not is_near or not spans / _MOST < abs(h) < 2 * spans:
        return
    where = "begin" if h * arcs.spans[0] > 0 else "end"
    counted = round(spans / abs(h))
    for count in sorted({max(1, counted + k) for k in (-1, 0, 1)}, key=lambda k: abs(k - counted)):
        h_ = arcs.spans / count
        total = np.zeros((3, len(h_)))
        for k in range(count):
            past = (k + (where == "end")) * h_
            states = moved(answer, right, arcs.begin(n + 7), arcs.since, past, arcs.steps)
            total += h_ * right.rates(arcs.since + past, states)[0, n + 4 :]
        words = (
            f"is the path of steps of first order, c += h c' at the {where} of each step, "
            f"{steps_in_words(np.diff(answer.times).tolist(), count)}"
        )
        yield words, _from_start(answer, total.T)
