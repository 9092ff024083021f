"""Omega cut to a largest length after each step of a method, as engines have it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.arcs import Arcs
from taylor_verify.judge.causes.candidate import Candidate
from taylor_verify.judge.causes.changed_equations import Equations
from taylor_verify.judge.causes.fit import fault
from taylor_verify.judge.causes.float_answer import Answer, Places
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.replayed_methods import METHODS
from taylor_verify.judge.causes.replays import Steps, in_steps, motion_of_steps
from taylor_verify.scenes.instants import evenly

# So many rows have the largest length, to so many roundings of the file.
_FEWEST: Final = 3
_ROUNDINGS: Final = 8.0
# Arcs from rows of that length, and from others.
_AT_CAP: Final = 12
_OTHERS: Final = 4
# The steps of a row that are tried, and what the right number leaves of the defects.
_COUNTS: Final = (1, 2, 3, 4, 5, 6, 8, 10, 12, 15, 16, 20, 24, 25, 30, 32, 40, 50)
_LEAVES: Final = 0.02
# The motion of a step.
_MOTIONS: Final = {"": "RK4", ", beside steps of explicit Euler": "explicit Euler"}


def capped_speed(answer: Answer) -> Iterator[Candidate]:
    """Yield steps after each of which omega is cut to the largest length that the later rows have."""
    lengths = np.linalg.norm(answer.file.v, axis=1)
    cap = float(np.max(lengths[1:]))
    is_at_cap = np.abs(lengths[:-1] - cap) <= _ROUNDINGS * float(np.max(answer.noise[0]))
    at_cap = np.flatnonzero(is_at_cap)
    if answer.n != 3 or len(at_cap) < _FEWEST:
        return
    arcs = _arcs(answer, at_cap)
    for words, name in _MOTIONS.items():
        step = partial(_cut, METHODS[name].step, cap)
        method = replace(METHODS[name], step=step, has_frame=not words)
        tried = (Steps("", method, count, _left(arcs, method, count)) for count in _COUNTS)
        best = min(tried, key=lambda steps: steps.left)
        if best.left < _LEAVES:
            each = best.words(answer)
            title = f"omega is cut to the length {cap:.6g} after each step, {each}{words}"
            of_cap = fault(title, "method", {})
            motion = partial(motion_of_steps, best)
            yield Candidate(of_cap, of_cap.right, best.left, motion, _LEAVES, best)


def _arcs(answer: Answer, at_cap: Places) -> Arcs:
    """Return arcs from row to row, most of them from rows of the largest length."""
    some = at_cap[evenly(len(at_cap), _AT_CAP)]
    rows = np.union1d(some, evenly(answer.count - 1, _OTHERS))
    return Arcs(answer, rows, rows + 1)


def _cut(step: Any, cap: float, equations: Equations, time: Floats, v: Floats, h: Floats) -> Floats:
    """Return a step with omega no longer than the cap."""
    after = step(equations, time, v, h)
    lengths = np.linalg.norm(after[:, :3], axis=1, keepdims=True)
    after[:, :3] *= np.minimum(1.0, cap / np.where(lengths > 0, lengths, cap))
    return np.asarray(after)


def _left(arcs: Arcs, method: Any, count: int) -> float:
    """Return the part of the defects that so many steps from row to row leave."""
    left = float(np.linalg.norm(in_steps(arcs, method, count).defects([{}]))) / arcs.size
    return left if np.isfinite(left) else np.inf
