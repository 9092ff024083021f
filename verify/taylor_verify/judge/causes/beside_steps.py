"""A fault beside the steps of a coarse method: the fault is looked for along the method's own steps.

The method's error is first fitted beside each family, linearly in h^p. What is found is then asked of
arcs that are stepped as the simulator's were, and proven with these steps on the whole answer.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from taylor_verify.judge.causes.answer import Answer, Stepping
from taylor_verify.judge.causes.arcs import Arcs
from taylor_verify.judge.causes.equations import Changes, Equations
from taylor_verify.judge.causes.flow import Floats
from taylor_verify.judge.causes.methods import METHODS, Method
from taylor_verify.judge.causes.replays import replay

# The steps of an arc by which the error of a method is measured.
_FINE: Final = 16
# What a method and a fault together leave of the defects to first order, and how small a method's part is.
_NEAR: Final = 0.2
_MOST: Final = 200
_METHODS: Final = 3
# Of each method the best fits give its numbers of steps.
_FITS: Final = 4
_SLIGHT: Final = 1e-3


@dataclass(frozen=True)
class Steps:
    """A method with its number of steps from row to row, and what it leaves beside a fault."""

    name: str
    method: Method
    count: int
    left: float

    def step(self, answer: Answer) -> float:
        return float(np.median(np.abs(np.diff(answer.times)))) / self.count

    def words(self, answer: Answer) -> str:
        return f"beside steps of {self.name}, h = {self.step(answer):.6g}"


def steps_beside(
    arcs: Arcs, stride: int, slopes: Iterable[Floats], faults: Iterable[Changes]
) -> list[Steps]:
    """Return the steps of a few methods that explain most of the defects beside a fault, best first.

    ``slopes`` are those of families, (entries, numbers).
    """
    if arcs.of_right.shape != (arcs.answer.n, len(arcs.first)):
        return []  # momenta are compared beside the start or the attitude, which no step of v leads to
    bases, sets = [np.zeros((arcs.of_right.size, 0)), *slopes], [{}, *faults]
    every = list(zip(sets, arcs.defects(sets), strict=True))
    tried = [
        Steps(name, method, count, _stepped_left(arcs, stride, method, count, changes, bases))
        for name, method in METHODS.items()
        if not method.is_implicit
        for changes, count in _counts(arcs, stride, method, bases, every)
    ]
    best = dict[tuple[str, int], Steps]()
    for each in sorted(tried, key=lambda each: each.left):
        best.setdefault((each.name, each.count), each)
    return [each for each in best.values() if each.left < _NEAR][:_METHODS]


def _counts(
    arcs: Arcs,
    stride: int,
    method: Method,
    bases: list[Floats],
    faults: list[tuple[Changes, Floats]],
) -> Iterator[tuple[Changes, int]]:
    """Yield the changes that explain the defects beside a method, with numbers of steps from row to row."""
    for changes, defects in faults:
        error = _error(arcs, method, arcs.answer.right.changed(changes)).ravel()
        fits = [
            _fitted(defects.ravel(), error, basis)
            for basis in (bases if not changes else bases[:1])
        ]
        near = sorted((left, part) for part, left in fits if part > 0 and left < _NEAR * arcs.size)
        some = [round(_FINE / stride * part ** (-1 / method.order)) for _, part in near[:_FITS]]
        around = {count + more for count in some for more in (-1, 0, 1)}
        yield from ((changes, count) for count in sorted(around) if 1 <= count <= _MOST)


def _stepped_left(
    arcs: Arcs, stride: int, method: Method, count: int, changes: Changes, bases: list[Floats]
) -> float:
    """Return the part of the defects that so many steps leave beside a family."""
    answer, equations = arcs.answer, arcs.answer.right.changed(changes)
    begin = arcs.begin(max(answer.n, equations.coupled))
    (ends,) = replay(answer, method, equations, begin, arcs.since, arcs.spans, count * stride)
    defects = ((arcs.end - ends[: answer.n]) / answer.sizes[:, None]).ravel()
    if not np.all(np.isfinite(defects)):
        return np.inf
    lefts = [_across(defects, basis) for basis in (bases if not changes else bases[:1])]
    return min(lefts) / arcs.size


def _across(defects: Floats, columns: Floats) -> float:
    """Return the size of what the columns leave of the defects."""
    if not columns.shape[1]:
        return float(np.linalg.norm(defects))
    numbers = np.linalg.lstsq(columns, defects, rcond=1e-9)[0]
    return float(np.linalg.norm(defects - columns @ numbers))


def _error(arcs: Arcs, method: Method, equations: Equations) -> Floats:
    """Return the error of fine steps over the arcs, relative to the motion."""
    answer, n = arcs.answer, arcs.answer.n
    begin = arcs.begin(max(n, equations.coupled))
    (ends,) = replay(answer, method, equations, begin, arcs.since, arcs.spans, _FINE)
    exact = arcs.ends(equations, arcs.steps)[0]
    return np.asarray((ends[:n] - exact[:n]) / answer.sizes[:, None])


def _fitted(defects: Floats, error: Floats, basis: Floats) -> tuple[float, float]:
    """Return the multiple of a method's error that fits best beside a family, and what is left."""
    columns = np.column_stack([error, basis])
    scale = np.linalg.norm(columns, axis=0)
    if not np.all(np.isfinite(scale)) or not scale[0] > 0:
        return 0.0, np.inf
    columns = columns / np.where(scale > 0, scale, 1.0)
    numbers = np.linalg.lstsq(columns, defects, rcond=1e-9)[0]
    left = float(np.linalg.norm(defects - columns @ numbers))
    is_slight = abs(numbers[0]) < _SLIGHT * np.linalg.norm(defects)
    return (0.0, np.inf) if is_slight else (float(numbers[0] / scale[0]), left)


def stepped(answer: Answer, steps: Steps) -> Answer:
    """Return the answer with arcs that are stepped from row to row."""
    return replace(answer, stepping=_stepping(answer, steps.method, steps.step(answer)))


def _stepping(answer: Answer, method: Method, h: float) -> Stepping:
    def ends(equations: Equations, begin: Floats, since: Floats, spans: Floats) -> Floats:
        count = max(1, round(float(np.median(np.abs(spans))) / h))
        return replay(answer, method, equations, begin, since, spans, count)

    return ends
