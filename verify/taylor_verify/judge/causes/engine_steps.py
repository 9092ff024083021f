"""Steps as engines have them: omega cut to a largest length, loads cleared after the first of a row."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.arcs import Arcs, some_arcs
from taylor_verify.judge.causes.candidate import Candidate
from taylor_verify.judge.causes.changed_equations import Equations
from taylor_verify.judge.causes.float_answer import Answer
from taylor_verify.judge.causes.held_loads import without_texts
from taylor_verify.judge.causes.many_flows import Floats, flow
from taylor_verify.judge.causes.replayed_methods import METHODS, Method
from taylor_verify.judge.causes.replays import LEAVES
from taylor_verify.judge.causes.stepped_arcs import best_steps
from taylor_verify.scenes.instants import evenly

# So many rows have the largest length, to so many roundings of the file.
_FEWEST: Final = 3
_ROUNDINGS: Final = 8.0
# Arcs from rows of that length, and from others.
_AT_CAP: Final = 12
_OTHERS: Final = 4
# The steps of a row that are tried.
_COUNTS: Final = (1, 2, 3, 4, 5, 6, 8, 10, 12, 15, 16, 20, 24, 25, 30, 32, 40, 50)
_OF_LOADS: Final = (2, 3, 4, 5, 6, 8, 10, 12, 15, 16, 20)
# The motion of a step.
_MOTIONS: Final = {"": "RK4", ", beside steps of explicit Euler": "explicit Euler"}
# The price of a step in evaluations, about.
_EVALUATIONS: Final = 24


def capped_speed(answer: Answer) -> Iterator[Candidate]:
    """Yield steps after each of which omega is cut to the largest length that the later rows have."""
    lengths = np.linalg.norm(answer.file.v, axis=1)
    cap = float(np.max(lengths[1:]))
    is_at_cap = np.abs(lengths[:-1] - cap) <= _ROUNDINGS * float(np.max(answer.noise[0]))
    at_cap = np.flatnonzero(is_at_cap)
    if answer.n != 3 or len(at_cap) < _FEWEST:
        return
    some = at_cap[evenly(len(at_cap), _AT_CAP)]
    rows = np.union1d(some, evenly(answer.count - 1, _OTHERS))
    for words, name in _MOTIONS.items():
        step = partial(_cut, METHODS[name].step, cap)
        method = replace(METHODS[name], step=step, has_frame=not words)
        best = best_steps(Arcs(answer, rows, rows + 1), [("", method, n) for n in _COUNTS])
        each = best.words(answer)
        title = f"omega is cut to the length {cap:.6g} after each step, {each}{words}"
        if best.left < LEAVES:
            yield best.candidate(title, LEAVES, {})


def _cut(step: Any, cap: float, equations: Equations, time: Floats, v: Floats, h: Floats) -> Floats:
    """Return a step with omega no longer than the cap."""
    after = step(equations, time, v, h)
    lengths = np.linalg.norm(after[:, :3], axis=1, keepdims=True)
    after[:, :3] *= np.minimum(1.0, cap / np.where(lengths > 0, lengths, cap))
    return np.asarray(after)


def cleared_loads(answer: Answer) -> Iterator[Candidate]:
    """Yield the motion whose loads, but for weight and buoyancy, act in a first part of each row alone."""
    if not answer.right.has_loads:
        return
    methods = {
        f"the first of {n} steps": Method(1, partial(_cleared, n), _EVALUATIONS, has_frame=True)
        for n in _OF_LOADS
    }
    best = best_steps(some_arcs(answer), [(name, each, 1) for name, each in methods.items()])
    if best.left < LEAVES:
        title = f"the loads act in {best.name} from row to row, and not in the others"
        yield best.candidate(title, LEAVES, {})


def _cleared(count: int, equations: Equations, time: Floats, z: Floats, h: Floats) -> Floats:
    """Return the exact step with the loads in its first part alone."""
    others = None if equations.acting is None else without_texts(equations.acting)
    without = replace(equations, acting=others, load=0 * equations.load)
    first = h / count
    z = flow(equations.rates, z, time, first, 1)
    return flow(without.rates, z, time + first, h - first, 1)
