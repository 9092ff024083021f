"""Attitudes that follow the motion but for a few rows: set anew, or at rest for a part of the run."""

from __future__ import annotations

from typing import Final

import numpy as np

from taylor_verify.judge.causes.answer import Answer, Motion, Places, angles
from taylor_verify.judge.causes.arcs import row_to_row
from taylor_verify.judge.causes.candidate import Cause
from taylor_verify.judge.causes.equations import Equations
from taylor_verify.judge.causes.flow import Floats
from taylor_verify.judge.causes.proof import chained, maps_of_attitude, may_leave

# A turn between two rows that is wrong by so many roundings, and by this part of the largest, is a jump.
_JUMP: Final = 40.0
_PART: Final = 1e-3
# Jumps are few: this many, and one in so many rows.
_FEW: Final = 3
_ONE_IN: Final = 10
_LAST: Final = 3


def attitude_in_pieces(answer: Answer, right: Equations) -> Cause | None:
    """Return the cause of attitudes that are right from row to row but at few of them, given the motion."""
    q, n, arcs = answer.file.q, answer.n, row_to_row(answer)
    assert q is not None
    maps, ends = maps_of_attitude(right, arcs), arcs.ends(right, arcs.steps)
    turned = np.einsum("aij,aj->ai", maps, q[:-1])
    wrong = angles(q[1:], turned / np.linalg.norm(turned, axis=1, keepdims=True))
    # What turns more than the file's own omega lets it is no jump of the attitude alone.
    apart = np.linalg.norm(arcs.end[-3:] - ends[0, n - 3 : n], axis=0)
    by_omega = np.abs(arcs.spans) * apart
    bad = np.flatnonzero(wrong > max(_JUMP * answer.roundings["attitude"], _PART * np.max(wrong)))
    still = np.all(q[1:] == q[:-1], axis=1)
    if not len(bad) or bad[0] == 0 or np.all(wrong[bad] <= by_omega[bad]):
        return None
    if still[bad].all() and len(bad) >= _LAST and _is_one_part(bad):
        return _stands_still(answer, maps, bad)
    if len(bad) > min(_FEW, answer.count // _ONE_IN):
        return None
    begins = [0, *(int(row) + 1 for row in bad)]
    listed = ", ".join(f"{answer.times[row] + answer.right.start:.6g}" for row in begins[1:])
    words = (
        f"attitude set anew at t = {listed}: each piece follows the motion from its own first row"
    )
    is_start = angles(q[bad[:1] + 1], q[:1])[0] <= answer.roundings["attitude"]
    words += ", which is the attitude of the start" if is_start and len(bad) == 1 else ""
    return _proven(answer, maps, begins, words)


def _is_one_part(rows: Places) -> bool:
    return bool(np.all(np.diff(rows) == 1))


def _stands_still(answer: Answer, maps: Floats, bad: Places) -> Cause | None:
    """Return the cause of attitudes that do not change in one part of the run."""
    last = int(bad[-1]) + 1
    still = maps.copy()
    still[bad] = np.eye(4)
    where = f"from t = {answer.times[bad[0]] + answer.right.start:.6g}"
    if last < answer.count - 1:
        where += f" to {answer.times[last] + answer.right.start:.6g}"
    else:
        where += " on"
    return _proven(
        answer, still, [0], f"attitude stands still {where}, and follows the motion before"
    )


def _proven(answer: Answer, maps: Floats, begins: list[int], words: str) -> Cause | None:
    """Return the cause if each piece follows from its own first row, the first one from the start."""
    q, start = answer.file.q, answer.start.q
    assert q is not None
    assert start is not None
    pieces = [
        chained(maps[begin : end - 1], q[begin] if begin else start[0])
        for begin, end in zip(begins, [*begins[1:], answer.count], strict=True)
    ]
    left = answer.leaves(Motion(answer.truth.v, np.concatenate(pieces))).get("attitude", np.inf)
    if left > may_leave(answer, ["attitude"]):
        return None
    return Cause(words, "attitude in pieces", {"attitude": left})
