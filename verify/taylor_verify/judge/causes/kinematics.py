"""Causes in the attitude, given the moving part: wrong sides, factors, and replayed updates."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.answer import Answer, Motion
from taylor_verify.judge.causes.arcs import Arcs, moved
from taylor_verify.judge.causes.candidate import Cause
from taylor_verify.judge.causes.equations import Equations
from taylor_verify.judge.causes.fit import Family
from taylor_verify.judge.causes.flow import Floats
from taylor_verify.judge.causes.methods import UPDATES
from taylor_verify.judge.causes.proof import chained
from taylor_verify.judge.causes.replays import replay
from taylor_verify.scenes.instants import evenly
from taylor_verify.words.causes import with_numbers

_ARCS: Final = 48
_CLEAR: Final = 20.0
# What is left of the defects, and of the error on the whole answer.
_LEAVES: Final = 1e-3
_REPLAYED: Final = 1e-2
_CAPS: Final = (0.1, 0.01)
_BETTER: Final = 10.0
_MOST: Final = 256

# The weights (b, a) of q' = (b W q + a q W) / 2.
_WRONG: Final = (
    ("attitude kinematics in the wrong axes: R' = [omega]x R with omega in body axes", (1.0, 0.0)),
    ("attitude turned backwards: R' = -R [omega]x", (0.0, -1.0)),
    ("transposed attitude: R' = -[omega]x R", (-1.0, 0.0)),
    ("attitude stands still: R' = 0", (0.0, 0.0)),
    ("attitude turns twice as fast: q' = q omega, where q' = q omega / 2", (0.0, 2.0)),
    ("attitude turns half as fast: q' = q omega / 4, where q' = q omega / 2", (0.0, 0.5)),
)


@dataclass(frozen=True)
class _Tried:
    """A hypothesis: the part of the defects that it leaves, and its maps of q over all rows."""

    name: str
    kind: str
    left: float
    maps: Callable[[Answer], Floats]
    numbers: Floats | None = None

    @property
    def count(self) -> int:
        return 0 if self.numbers is None else len(self.numbers)

    @property
    def text(self) -> str:
        return self.name if self.numbers is None else with_numbers(self.name, (), (), self.numbers)


def kinematics(answer: Answer, right: Equations, method: Any = None) -> Cause | None:
    """Return the proven cause of a wrong attitude by equations that are right for the moving part.

    A ``method`` of the moving part, with its number of steps, is taken for that part.
    """
    answer = answer.with_start(right.mass)
    rows = np.array(evenly(answer.count - 1, _ARCS))
    arcs = Arcs(answer, rows, rows + 1)
    assert answer.file.q is not None
    ends = answer.file.q[rows + 1].T
    by_right = _turned(answer, right, arcs, method)
    size, floor = _apart(ends, by_right), max(answer.noise[1], 1e-16) * np.sqrt(ends.size)
    if size < _CLEAR * floor:
        return None
    tried = list(_replays(answer, right, arcs, ends, size, method))
    if method is None:
        tried += [*_wrong(answer, right, arcs, ends, size), *_fits(answer, right, arcs, ends, size)]
    near = [
        each
        for each in tried
        if each.left < max(_LEAVES if each.count else _REPLAYED, 30 * floor / size)
    ]
    return _settled(answer, sorted(near, key=lambda each: (each.count, each.left)))


def _settled(answer: Answer, near: list[_Tried]) -> Cause | None:
    for each in near:
        simpler = [other for other in near if other.count < each.count]
        if any(other.left < _BETTER * each.left for other in simpler):
            continue
        assert answer.start.q is not None
        q = chained(each.maps(answer), answer.start.q[0])
        left = answer.leaves(Motion(answer.truth.v, q)).get("attitude", np.inf)
        allowed = max(_LEAVES, 3 * answer.floor(["attitude"]))
        if left <= min(allowed, _CAPS[min(each.count, 1)]):
            same = [other for other in near if other.count == each.count and other is not each]
            alike = tuple(other.text for other in same if other.left < 3 * each.left)
            return Cause(each.name, each.kind, {"attitude": left}, each.text, alike)
    return None


def _apart(ends: Floats, q: Floats) -> float:
    """Return the size of the difference of quaternions; q and -q are one attitude."""
    unit = q / np.linalg.norm(q, axis=0)
    signs = np.sign(np.sum(ends * unit, axis=0))
    apart = float(np.linalg.norm(ends * signs - unit))
    return apart if np.isfinite(apart) else np.inf


def _turned(answer: Answer, right: Equations, arcs: Arcs, method: Any) -> Floats:
    """Return q at the ends of the arcs by the moving part of the equations or of the method."""
    count = max(answer.n + 4, right.coupled)
    begin = arcs.begin(count)
    ends = moved(answer, right, begin, arcs.since, arcs.spans, arcs.steps)
    return np.asarray(ends[0, answer.n : answer.n + 4])


def _weighted(changed: Equations, answer: Answer) -> Floats:
    """Return the maps of q from each row to the next by equations of the attitude."""
    every = _all_arcs(answer)
    v = every.begin(changed.coupled)[0, : answer.n]
    unit = np.broadcast_to(np.eye(4)[:, :, None], (4, 4, v.shape[1]))
    begin = np.concatenate([np.broadcast_to(v, (4, *v.shape)), unit], axis=1)
    ends = moved(answer, changed, begin, every.since, every.spans, every.steps)
    return np.asarray(ends[:, answer.n : answer.n + 4].transpose(2, 1, 0))


def _all_arcs(answer: Answer) -> Arcs:
    rows = np.arange(answer.count - 1)
    return Arcs(answer, rows, rows + 1)


def _wrong(
    answer: Answer, right: Equations, arcs: Arcs, ends: Floats, size: float
) -> Iterator[_Tried]:
    for name, weights in _WRONG:
        changed = right.changed({"turns": np.array(weights)})
        left = _apart(ends, _turned(answer, changed, arcs, None)) / size
        kind = "kinematics"
        yield _Tried(name, kind, left, partial(_weighted, changed))


def _fits(
    answer: Answer, right: Equations, arcs: Arcs, ends: Floats, size: float
) -> Iterator[_Tried]:
    pace = (
        float(np.max(np.linalg.norm(answer.truth.v[:, -3:], axis=1)))
        if not right.has_momenta
        else 1.0
    )
    one = np.ones(1)
    families = (
        Family(
            "attitude by the rate of another moment",
            "late rate",
            0 * one,
            one * 0.1 / pace,
            lambda p: {"ahead": p[0]},
        ),
        Family(
            "attitude turns by a factor",
            "kinematics",
            one,
            one,
            lambda p: {"turns": np.array([0.0, p[0]])},
        ),
    )
    for family in families:
        numbers = family.right.copy()
        for _ in range(4):
            rest = [
                _rest(ends, _turned(answer, right.changed(changes), arcs, None))
                for changes in (family.changes(numbers), *family.around(numbers))
            ]
            slopes = family.slopes(np.array(rest[1:]))
            numbers = numbers - np.linalg.lstsq(slopes, rest[0].ravel(), rcond=1e-9)[0]
        changed = right.changed(family.changes(numbers))
        left = _apart(ends, _turned(answer, changed, arcs, None)) / size
        if f"{numbers[0]:.6g}" == "1":
            continue
        yield _Tried(
            family.name,
            family.kind,
            left,
            partial(_weighted, changed),
            numbers,
        )


def _rest(ends: Floats, q: Floats) -> Floats:
    unit = q / np.linalg.norm(q, axis=0)
    return np.asarray(ends * np.sign(np.sum(ends * unit, axis=0)) - unit)


def _replays(
    answer: Answer, right: Equations, arcs: Arcs, ends: Floats, size: float, method: Any
) -> Iterator[_Tried]:
    if right.coupled > answer.n:
        return
    begin = arcs.begin(answer.n + 4)
    exact = _turned(answer, right, arcs, None)
    for name, (order, update) in UPDATES.items():

        def left(steps: int, update: Any = update) -> float:
            return (
                _apart(ends, _updated(answer, right, update, begin, arcs, steps, method)[0]) / size
            )

        def error(steps: int, update: Any = update) -> float:
            return _apart(
                exact / np.linalg.norm(exact, axis=0),
                _updated(answer, right, update, begin, arcs, steps, method)[0],
            )

        steps = method[1] if method else _steps(order, error, size)
        tried = {k: left(k) for k in ({steps} if method else {max(1, steps - 1), steps, steps + 1})}
        best = min(tried, key=lambda k: tried[k])
        h = float(np.median(np.abs(arcs.spans))) / best
        words = f"attitude {name}" + ("" if method else f", h = {h:.6g}")
        yield _Tried(
            words,
            "attitude step",
            tried[best],
            partial(_maps, right, update, best, method),
        )


def _steps(order: int, error: Callable[[int], float], size: float) -> int:
    steps = 1
    for _ in range(4):
        own = error(steps)
        if not 0 < own < np.inf:
            break
        further = int(np.clip(round(steps * (own / size) ** (1 / order)), 1, _MOST))
        if further == steps:
            break
        steps = further
    return steps


def _updated(
    answer: Answer,
    right: Equations,
    update: Any,
    begin: Floats,
    arcs: Arcs,
    steps: int,
    method: Any,
) -> Floats:
    """Return q, not of unit length, after the arcs in so many updates."""
    n, h = answer.n, arcs.spans / steps
    v, q = begin[:, :n], begin[:, n:]
    for k in range(steps):
        since = arcs.since + k * h
        if method:
            after = replay(answer, method[0], right, v, since, h, 1)
        else:
            inner = max(1, -(-arcs.steps // steps))
            after = moved(answer, right, v, since, h, inner)
        q = update(q, _omega(right, v), _omega(right, after), h)
        v = after
    return np.asarray(q)


def _omega(right: Equations, v: Floats) -> Floats:
    return (right.inverse @ v if right.has_momenta else v)[:, -3:]


def _maps(right: Equations, update: Any, steps: int, method: Any, answer: Answer) -> Floats:
    """Return the maps of q; an update is linear in q up to the length."""
    every = _all_arcs(answer)
    v = every.begin(answer.n)
    unit = np.broadcast_to(np.eye(4)[:, :, None], (4, 4, v.shape[2]))
    begin = np.concatenate([np.broadcast_to(v, (4, *v.shape[1:])), unit], axis=1)
    ends = _updated(answer, right, update, begin, every, steps, method)
    return ends.transpose(2, 1, 0)
