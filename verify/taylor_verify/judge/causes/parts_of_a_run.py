"""Causes that act in a part of the rows, while the scene's own motion leads over all others."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from typing import Final

import numpy as np

from taylor_verify.judge.causes import starts
from taylor_verify.judge.causes.budget import Spent
from taylor_verify.judge.causes.candidate import Cause
from taylor_verify.judge.causes.dynamics import Dynamics
from taylor_verify.judge.causes.float_answer import Answer
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.proof import ROUNDINGS, left_of_all
from taylor_verify.judge.causes.settled import FAIR

# The search for the causes of some rows.
Ask = Callable[[Answer], list[Cause]]

_FEWEST: Final = 6
# A jump stands out if it is so many times what any other row is off by.
_JUMP: Final = 100.0
_SHORTEST: Final = 12
# What leads from one row to the next leaves so many roundings, or this part of what the scene leaves.
_FEW_ROUNDINGS: Final = 10.0
_PART: Final = 1e-3


def causes_in_pieces(answer: Answer, defects: Floats, ask: Ask) -> list[Cause] | None:
    """Return the causes of an answer that is right in pieces, each with the times of its ends."""
    cause = starts.exact_in_pieces(answer, defects)
    if cause is not None:
        return [cause]
    if causes := _after_a_jump(answer, defects, ask):
        return causes
    causes, last = list[Cause](), answer.count - 1
    for begin, end in starts.wrong_spans(answer, defects):
        stopped = starts.stopped(answer, begin) if end == last else None
        if stopped is not None:
            return [stopped]
        own = list[Cause]()
        with suppress(Spent):
            own = _within(answer, begin, end, ask)
        if not own and end - begin < _SHORTEST:
            return None
        causes += own
    return causes or None


def _after_a_jump(answer: Answer, defects: Floats, ask: Ask) -> list[Cause]:
    """Return a jump between the first two rows, and the causes of the motion from the second row on."""
    if len(defects) < _SHORTEST:
        return []
    # Defects that die away from row to row are no jump.
    first, second = (defects[row] >= _JUMP * np.max(defects[row + 1 :]) for row in (0, 1))
    if second or not first:
        return []
    part = starts.piece(answer, 1, answer.count - 1)
    begin, end = (answer.times[row] + answer.right.start for row in (0, 1))
    words = f"a jump between the first two rows, from t = {begin:.6g} to {end:.6g}"
    later = [of_part(answer, part, cause, "from the second row on") for cause in ask(part)]
    return [Cause(words, "jump at the start", {}), *later] if later else []


def _within(
    answer: Answer, begin: int, end: int, ask: Ask, is_right_before: bool = True
) -> list[Cause]:
    """Return the causes of the rows between two, which the motion before and after them does not have.

    What acts in a part of them is said of that part, and the rest is asked again.
    """
    # A load may begin or end between two rows: the arcs at both ends are left out.
    first, last = begin + bool(begin), end - (end < answer.count - 1)
    part = starts.piece(answer, first, last)
    if last - first < _FEWEST:
        cause = _without_numbers(part) if last > first else None
        if cause is None:
            return []
        return [of_part(answer, part, cause, _times(answer, begin, end, is_right_before, cause))]
    if causes := ask(part):
        if all_along := _all_along(answer, causes[0]):
            return [all_along, *causes[1:]]
        where = _times(answer, begin, end, is_right_before, causes[0])
        return [of_part(answer, part, cause, where) for cause in causes]
    half = part.at(np.s_[: part.count // 2])
    cause = Dynamics(half).cause() if half.count >= _SHORTEST and half.moving else None
    if cause is None or cause.method is not None:
        return []
    other = replace(part, right=part.right.changed(cause.changes))
    wrong = starts.wrong_arcs(starts.roundings(other))
    if not len(wrong):
        return []
    change = first + int(wrong[0])
    where = _times(answer, begin, change, is_right_before, cause)
    causes = [of_part(answer, half, cause, where)]
    with suppress(Spent):
        causes += _within(answer, change, end, ask, is_right_before=False)
    return causes


def _without_numbers(part: Answer) -> Cause | None:
    """Return a cause without numbers of a few rows, which leaves no more than a fair simulator does."""
    with suppress(Spent):
        cause = Dynamics(part).without_numbers()
        least = max(FAIR, ROUNDINGS * part.floor(part.moving)) if part.moving else 0.0
        if cause is not None and max(cause.leaves.values()) <= least:
            return cause
    return None


def _all_along(answer: Answer, cause: Cause) -> Cause | None:
    """Return a cause of a part that explains the whole answer, as where a limit is not left before."""
    changed = answer.right.changed(cause.changes)
    leaves = left_of_all(answer, changed) if cause.changes else {}
    return replace(cause, leaves=leaves) if leaves else None


def of_part(answer: Answer, part: Answer, cause: Cause, where: str) -> Cause:
    """Return the cause of a part of the rows; no scene has a fault in a part of its run."""
    leaves = {
        name: left * part.worst[name] / answer.worst[name] for name, left in cause.leaves.items()
    }
    return replace(cause, leaves=leaves, where=where, changes={})


def _times(answer: Answer, begin: int, end: int, is_right_before: bool, cause: Cause) -> str:
    """Return in words the part of the run between two rows in which a cause acts."""
    first, last = (f"t = {answer.times[row] + answer.right.start:.6g}" for row in (begin, end))
    if end == answer.count - 1:
        return f"right up to {first}, then" if is_right_before else f"from {first} on"
    last = last.removeprefix("t = ") if begin else last
    if not _follows(answer, cause, end - 1):
        last += ", or less than a row before"
    if begin and not _follows(answer, cause, begin):
        first += ", or less than a row later,"
    return f"from {first} to {last}" if begin else f"up to {last}"


def _follows(answer: Answer, cause: Cause, row: int) -> bool:
    """Return True if a cause leads from a row to the next one, all the way."""
    if cause.method is not None:
        return True
    part = starts.piece(answer, row, row + 1)
    scene, changed = (
        starts.roundings(replace(part, right=part.right.changed(changes)))[0]
        for changes in ({}, cause.changes)
    )
    return bool(changed <= max(_FEW_ROUNDINGS, _PART * scene))
