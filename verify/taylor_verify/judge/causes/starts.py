"""Answers whose motion is right but for its start, for jumps, or from some row on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from operator import attrgetter
from typing import Final

import numpy as np

from taylor_verify.judge.causes.arcs import row_to_row
from taylor_verify.judge.causes.budget import Budget
from taylor_verify.judge.causes.candidate import Cause
from taylor_verify.judge.causes.float_answer import Answer, Motion, Places
from taylor_verify.judge.causes.kinks import moved_through
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.proof import CAPS, may_leave, whole

# A defect of so many roundings, and of this part of the largest one, is a jump.
_JUMP: Final = 40.0
_PART: Final = 1e-2
# A simulator has defects of its own: those below this part of the largest one.
_NOISE: Final = 1e-6
# Jumps are few: this many, or one in so many rows.
_FEW: Final = 2
_ONE_IN: Final = 50
# So many jumps are listed.
_LISTED: Final = 4
_OFF: Final = 10.0
_FEWEST: Final = 2
_RIGHT: Final = 4
_MOST_SPANS: Final = 3
_EARLY: Final = 20
_STANDS_OUT: Final = 30.0
_AT_REST: Final = 4.0


def roundings(answer: Answer) -> Floats:
    """Return the largest defect of each arc from row to row, in roundings of the file."""
    arcs = row_to_row(answer)
    begin = arcs.begin(answer.right.coupled)
    ends = moved_through(arcs, answer.right, begin, arcs.steps)[0, : answer.n]
    defects = np.abs(arcs.end - ends) / answer.sizes[:, None]
    return np.asarray(np.max(defects / answer.rounding[:, None], axis=0))


def exact_in_pieces(answer: Answer, defects: Floats) -> Cause | None:
    """Return the cause of an answer that is the exact motion from its own first row, or between jumps."""
    bad = np.flatnonzero(defects > max(_JUMP, _PART * float(np.max(defects))))
    is_off = has_own_start(answer)
    if is_off and (cause := _from_a_row(answer, 0)):
        return cause
    if len(bad) > max(_FEW, answer.count // _ONE_IN) or not (is_off or len(bad)):
        return None
    if len(bad) > 1 and bad[0] == 0 and bad[1] == 1:
        return None  # what dies away from the start on, as behind a filter, is no jump
    first = 1 if len(bad) and bad[0] == 0 else 0
    if len(bad) <= first:
        return _from_a_row(answer, first) if first else None
    begins = [0, *(int(row) + 1 for row in bad)]
    leaves = _leaves(answer, begins, is_off)
    if leaves is None or max(leaves.values()) > may_leave(answer, answer.moving):
        return None
    last = answer.file.v[bad[-1] + 1 :]
    *jumps, latest = (f"{answer.times[row + 1] + answer.right.start:.6g}" for row in bad)
    if _is_at_rest(answer, last):
        before = f"exact between jumps at t = {_listed(jumps)}" if jumps else "right"
        name = f"at rest from t = {latest} on: the motion is {before} before, and then all velocities are 0"
        return Cause(name, "at rest", leaves)
    name = (
        f"exact motion between jumps at t = {_listed([*jumps, latest])}, or loads for a short time before "
        "them: each piece is the scene's motion from its own first row"
    )
    return Cause(name, "jump", leaves)


def _listed(times: Sequence[str]) -> str:
    """Return some times, and the number of those that are not listed."""
    more = len(times) - _LISTED
    return ", ".join(times[:_LISTED]) + (f" and {more} more" if more > 0 else "")


def has_own_start(answer: Answer) -> bool:
    """Return True if the first row is at the start of the scene, and is not its initial motion."""
    off = (answer.error[name][0] > _OFF * answer.roundings[name] for name in answer.moving)
    return answer.is_from_start and any(off)


def _is_at_rest(answer: Answer, rows: Floats) -> bool:
    return bool(np.all(np.abs(rows) <= _nothing(answer)))


def _nothing(answer: Answer) -> Floats:
    """Return the largest size of each component of v that is no motion."""
    return np.asarray(_AT_REST * np.maximum(answer.noise[0], 1e-300))


def _from_a_row(answer: Answer, first: int) -> Cause | None:
    part = answer.begun_at(first)
    motion = whole(part, part.right)
    if motion is None:
        return None
    errors = part.errors(motion)
    leaves = answer.parts(errors)
    if max(leaves[name] for name in answer.moving) > may_leave(answer, answer.moving):
        return None
    if "attitude" in errors and "attitude" not in answer.failed:
        # A right attitude refutes another start of omega.
        right = max(answer.worst["attitude"], answer.roundings["attitude"])
        if np.max(errors["attitude"]) > _OFF * right:
            return None
    if leaves.get("attitude", 0.0) > CAPS[0]:
        del leaves["attitude"]
    if first:
        begin, end = answer.times[0] + answer.right.start, answer.times[1] + answer.right.start
        sizes = [np.linalg.norm(answer.file.v[k, -3:]) for k in (0, 1)]
        of_rate = (
            "" if answer.right.has_momenta else f" (|omega| is {sizes[0]:.4g}, then {sizes[1]:.4g})"
        )
        name = (
            f"all of the error arises between the first two rows, from t = {begin:.6g} to {end:.6g}"
            f"{of_rate}: from the second row on the motion is exact"
        )
        return Cause(name, "jump at the start", leaves)
    name = "another start: from the file's own first row the motion is exact"
    return Cause(name, "own start", leaves, alike=_factor(answer))


def _factor(answer: Answer) -> tuple[str, ...]:
    """Return the factor of the body that starts in the first row by the scene's momenta, if one does."""
    right, own, nu = answer.right, answer.file.v[0], answer.start.v[0]
    if right.has_momenta or right.has_loads or np.any(right.rotor) or not own @ nu > 0:
        return ()
    factor = float(nu @ nu / (own @ nu))
    off = np.abs(own - nu / factor) / answer.sizes
    if np.any(off > _OFF * answer.rounding) or f"{factor:.6g}" == "1":
        return ()
    noun = "inertia" if answer.n == 3 else "mass matrix"
    return (f"factor of the {noun} = {factor:.6g}, from the scene's momenta",)


def _leaves(answer: Answer, begins: list[int], is_off: bool) -> dict[str, float] | None:
    """Return what is left of v if each piece is the exact motion from its own first row."""
    leaves = dict.fromkeys(answer.moving, 0.0)
    for begin, end in zip(begins, [*begins[1:], answer.count], strict=True):
        if end - begin < 2:
            continue
        piece = (answer.begun_at(begin) if begin or is_off else answer).at(np.s_[: end - begin])
        piece = replace(piece, file=Motion(piece.file.v, None, None))
        motion = whole(piece, piece.right)
        if motion is None:
            return None
        for name in leaves:
            part = answer.groups[name]
            apart = np.linalg.norm(piece.file.v[:, part] - motion.v[:, part], axis=1)
            left = float(np.max(apart)) / answer.sizes[part][0] / answer.worst[name]
            leaves[name] = max(leaves[name], left)
    return leaves


def wrong_arcs(defects: Floats) -> Places:
    """Return the arcs whose defects are more than those of a simulator with errors of its own."""
    return np.flatnonzero(defects > max(_JUMP, _NOISE * float(np.max(defects))))


def wrong_spans(answer: Answer, defects: Floats) -> list[tuple[int, int]]:
    """Return the rows between which the motion is wrong, if it is right in the rest of the run.

    A span begins at the last right row, and ends at the first row from which the motion is right again.
    """
    bad = wrong_arcs(defects)
    right = max(_RIGHT, answer.count // _EARLY)
    if not len(bad) or len(bad) > len(defects) - right:
        return []
    parts = np.split(bad, np.flatnonzero(np.diff(bad) > right) + 1)
    spans = [(int(part[0]), int(part[-1]) + 1) for part in parts]
    is_inside = np.zeros(len(defects), dtype=bool)
    for begin, end in spans:
        is_inside[begin:end] = True
    is_short = any(end - begin < _FEWEST for begin, end in spans)
    if is_short or np.count_nonzero(~is_inside) < right or len(spans) > _MOST_SPANS:
        return []
    # The row at which a fault begins may have a little of it.
    after = min(float(np.median(defects[begin + 1 : end])) for begin, end in spans)
    is_clear = after > _STANDS_OUT * float(np.max(defects[~is_inside]))
    return spans if is_clear else []


def piece(answer: Answer, first: int, last: int) -> Answer:
    """Return some of the rows, begun at the first; they have a budget of their own if little is left.

    The truth is the right motion from there; where the rows are too far from it to reach it, it is the
    scene's own.
    """
    part = answer.begun_at(first).at(np.s_[: last - first + 1])
    part = replace(part, budget=max(answer.budget, Budget(), key=attrgetter("left")))
    truth = whole(part, part.right)
    if truth is None:
        return part
    q, c = (part.truth.q if truth.q is None else truth.q), truth.c
    return replace(part, truth=Motion(truth.v, q, part.truth.c if c is None else c))


def stopped(answer: Answer, row: int) -> Cause | None:
    """Return the cause of rows that are all the same after a row that is right."""
    rest = answer.file.v[row + 1 :]
    if np.any(np.ptp(rest, axis=0) > _nothing(answer)):
        return None
    time = answer.times[row + 1] + answer.right.start
    is_at_rest = _is_at_rest(answer, rest[-1])
    what = "all velocities are 0" if is_at_rest else "all rows have the same numbers"
    leaves = dict.fromkeys(answer.failed, 0.0)
    return Cause(f"right before t = {time:.6g}, and {what} from there on", "at rest", leaves)
