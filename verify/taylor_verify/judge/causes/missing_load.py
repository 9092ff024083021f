"""The load that explains the rows where no cause is proven: constant from each row to the next.

It is always true and names nothing: with it the scene's equations lead from row to row.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from taylor_verify.judge.causes.arcs import Arcs, row_to_row
from taylor_verify.judge.causes.fit import Sizes
from taylor_verify.judge.causes.float_answer import Answer
from taylor_verify.judge.causes.many_flows import Floats
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


def missing_load(answer: Answer) -> tuple[MissingLoad, ...]:
    """Return the load between rows; empty where rows are too far apart to tell it, or it is rounding."""
    if answer.count < 4 or not answer.moving or answer.has_states:
        return ()
    arcs = row_to_row(answer)
    if np.max(np.abs(arcs.of_right[: answer.n])) < _FOLLOWS * answer.off:
        return ()
    load, slopes, left = _fitted(answer, arcs)
    if not left < _LEAVES * np.linalg.norm(arcs.of_right[: answer.n]):
        return ()
    unit = np.abs(np.linalg.inv(slopes)) @ answer.rounding
    sizes = np.linalg.norm(load / Sizes.of(answer).load, axis=1)
    is_clear = np.any(np.abs(load) > _STANDS_OUT * unit, axis=1) & (sizes > _PART * np.max(sizes))
    clear = np.flatnonzero(is_clear)
    times = (answer.times + answer.right.start).tolist()
    return tuple(MissingLoad(times[k], times[k + 1], tuple(load[k].tolist())) for k in clear)


def _fitted(answer: Answer, arcs: Arcs) -> tuple[Floats, Floats, float]:
    """Return the load of each arc (arcs, n), its slopes (arcs, n, n), and the defects that it leaves."""
    right, n, scale = answer.right, answer.n, Sizes.of(answer).load * _SHIFT
    load = np.zeros((len(arcs.first), n))
    slopes = np.zeros((len(arcs.first), n, n))
    for _ in range(_ROUNDS):
        shifts = np.concatenate([np.zeros((1, n)), np.diag(scale)])
        tried = right.load[None, :, None] + load.T[None] + shifts[:, :, None]
        ends = arcs.ends(right.changed({"load": tried}), arcs.steps)[:, :n]
        ends = ends / answer.sizes[:, None]
        slopes = (ends[1:] - ends[0]).transpose(2, 1, 0) / scale
        defects = (arcs.end / answer.sizes[:, None] - ends[0]).T
        load = load + np.linalg.solve(slopes, defects[..., None])[..., 0]
    return load, slopes, float(np.linalg.norm(defects))
