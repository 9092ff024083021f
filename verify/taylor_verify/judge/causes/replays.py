"""Methods replayed from row to row of an answer: which one, and how many steps make a row."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Final

import numpy as np

from taylor_verify.judge.causes.answer import Answer, Motion
from taylor_verify.judge.causes.arcs import Arcs
from taylor_verify.judge.causes.candidate import Candidate
from taylor_verify.judge.causes.equations import Equations
from taylor_verify.judge.causes.flow import Floats
from taylor_verify.judge.causes.methods import (
    METHODS,
    OF_MOMENTUM,
    Method,
    with_unit_attitude,
    with_updates,
)
from taylor_verify.judge.causes.proof import whole
from taylor_verify.scenes.instants import evenly

_ARCS: Final = 16
# A replay leaves at most this part of the defects, which are this many roundings at least.
_LEAVES: Final = 0.02
_CLEAR: Final = 30.0
# A method is asymptotic where its defects are this small; they point where the file's defects do.
_ASYMPTOTIC: Final = 0.05
_ALONG: Final = 0.8
_SEARCHES: Final = 3
_MOST: Final = 200
_MOST_IMPLICIT: Final = 64
# Evaluations of an implicit step, about.
_EVALUATIONS: Final = 12
# Words that programs look for.
_WORDS: Final = {
    "explicit Euler": "explicit gyroscopic step: explicit Euler",
    "backward Euler": "implicit gyroscopic step: backward Euler",
    "one Newton step of backward Euler": "implicit gyroscopic step: one Newton step of backward Euler",
}


def replay(
    answer: Answer,
    method: Method,
    equations: Equations,
    v: Floats,
    since: Floats,
    spans: Floats,
    steps: int,
) -> Floats:
    """Return v after the spans, each in so many steps."""
    h = spans / steps
    evaluations = _EVALUATIONS if method.is_implicit else method.order
    price = equations.price(v.shape[1], v.size // v.shape[1])
    answer.budget.spend(steps * evaluations * price)
    for k in range(steps):
        v = method.step(equations, since + k * h, v, h)
        if v.shape[1] > answer.n:
            v = with_unit_attitude(v, answer.n)
    return v


def replays(answer: Answer, stride: int) -> Iterator[Candidate]:
    """Yield the methods whose steps lead from row to row."""
    rows = np.array(evenly(answer.count - stride, _ARCS))
    arcs = Arcs(answer, rows, rows + stride)
    if arcs.floor * _CLEAR > 1:
        return
    known = METHODS if answer.n == 6 else {**METHODS, **OF_MOMENTUM}
    if answer.right.coupled > answer.n:
        known = {**METHODS, **dict(with_updates(answer.n))}
    for name, method in known.items():
        steps, left = _steps_of(arcs, method, stride)
        if steps and left < max(_LEAVES, _CLEAR * arcs.floor):
            h = float(np.median(np.abs(arcs.spans))) / steps / stride
            words = _WORDS.get(name, name) if answer.n == 3 else name
            if method.order > 1:
                words = f"truncation of order {method.order}: {name}"
            yield Candidate(
                name=f"{words}, h = {h:.6g}",
                kind="method",
                defects=left,
                motion=partial(_motion, method, steps),
                near=_LEAVES,
                method=(method, steps),
            )


def _motion(method: Method, steps: int, answer: Answer) -> Motion | None:
    return whole(answer, answer.right, stepper(answer, method, steps))


def stepper(answer: Answer, method: Method, steps: int) -> Callable[[Floats], Floats]:
    """Return the steps of a method from each row to the next one."""
    times = answer.times if answer.is_from_start else np.r_[answer.begins, answer.times]
    since, spans = times[:-1], np.diff(times)
    return lambda z: replay(answer, method, answer.right, z, since, spans, steps)


def _steps_of(arcs: Arcs, method: Method, stride: int) -> tuple[int, float]:
    """Return the number of steps from a row to the next that fits best, and the part that it leaves."""
    answer = arcs.answer
    defects = arcs.of_right[: answer.n, : len(arcs.first)]
    scale, size = answer.sizes[:, None], float(np.linalg.norm(defects))
    exact = arcs.ends(answer.right, arcs.steps)[0, : answer.n]

    def ends(steps: int) -> Floats:
        begin = arcs.begin(max(answer.n, answer.right.coupled))
        count = steps * stride
        (rows,) = replay(answer, method, answer.right, begin, arcs.since, arcs.spans, count)
        return np.asarray(rows[: answer.n])

    steps, error = 1, (ends(1) - exact) / scale
    limit = _MOST_IMPLICIT if method.is_implicit else _MOST
    while not np.linalg.norm(error) < _ASYMPTOTIC * np.sqrt(error.size) and steps < 32:
        steps *= 2
        error = (ends(steps) - exact) / scale
    for _ in range(_SEARCHES):
        own = float(np.linalg.norm(error))
        if not 0 < own < np.inf:
            return 0, np.inf
        further = round(steps * (own / size) ** (1 / method.order))
        if further == steps or not 1 <= further <= limit:
            break
        steps, error = further, (ends(further) - exact) / scale
    if np.sum(error * defects) < _ALONG * float(np.linalg.norm(error)) * size:
        return 0, np.inf
    tried = {k: _left(ends(k), arcs) / size for k in {max(1, steps - 1), steps, steps + 1}}
    best = min(tried, key=lambda k: tried[k])
    return best, tried[best]


def _left(ends: Floats, arcs: Arcs) -> float:
    left = float(np.linalg.norm((arcs.end - ends) / arcs.answer.sizes[:, None]))
    return left if np.isfinite(left) else np.inf
