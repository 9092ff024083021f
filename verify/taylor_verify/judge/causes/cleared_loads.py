"""Loads that act in the first of some steps of each row alone, as of engines that clear them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import Final

import numpy as np

from taylor_verify.judge.causes.arcs import row_to_row
from taylor_verify.judge.causes.candidate import Candidate
from taylor_verify.judge.causes.changed_equations import Equations
from taylor_verify.judge.causes.fit import fault
from taylor_verify.judge.causes.float_answer import Answer
from taylor_verify.judge.causes.held_loads import without_texts
from taylor_verify.judge.causes.many_flows import Floats, flow
from taylor_verify.judge.causes.replayed_methods import Method
from taylor_verify.judge.causes.replays import Steps, in_steps, motion_of_steps
from taylor_verify.scenes.instants import evenly

_ARCS: Final = 16
_COUNTS: Final = (2, 3, 4, 5, 6, 8, 10, 12, 15, 16, 20)
_LEAVES: Final = 0.02
# The price of a step in evaluations, about.
_EVALUATIONS: Final = 24


def cleared_loads(answer: Answer) -> Iterator[Candidate]:
    """Yield the motion whose loads, but for weight and buoyancy, act in a first part of each row alone."""
    if not answer.right.has_loads:
        return
    rows = np.array(evenly(answer.count - 1, _ARCS))
    arcs = replace(row_to_row(answer), first=rows, last=rows + 1)
    best, least = None, _LEAVES
    for count in _COUNTS:
        method = Method(1, partial(_cleared, count), _EVALUATIONS, has_frame=True)
        left = float(np.linalg.norm(in_steps(arcs, method, 1).defects([{}]))) / arcs.size
        if left < least:
            best, least = (count, Steps("", method, 1, left)), left
    if best is not None:
        count, steps = best
        name = f"the loads act in the first of {count} steps from row to row, and not in the others"
        of_loads = fault(name, "method", {})
        motion = partial(motion_of_steps, steps)
        yield Candidate(of_loads, of_loads.right, steps.left, motion, _LEAVES, steps)


def _cleared(count: int, equations: Equations, time: Floats, z: Floats, h: Floats) -> Floats:
    """Return the exact step with the loads in its first part alone."""
    first = h / count
    acting = equations.acting
    others = None if acting is None else without_texts(acting)
    without = replace(equations, acting=others, load=0 * equations.load)
    z = flow(equations.rates, z, time, first, 1)
    return flow(without.rates, z, time + first, h - first, 1)
