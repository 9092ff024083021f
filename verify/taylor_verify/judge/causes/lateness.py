"""The true motion at other times than those of the rows, and single quantities that are late or early."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import ceil
from typing import Final

import numpy as np

from taylor_verify.judge.causes.arcs import moved
from taylor_verify.judge.causes.float_answer import Answer
from taylor_verify.judge.causes.many_flows import Floats

# Steps from a row to the next.
_STEPS: Final = 8
_ROUNDS: Final = 5
# A shift leaves less of the error than this to first order, and spans no more rows.
_FITS: Final = 0.7
# The quantity that is right has so much less of an error.
_RIGHT: Final = 1e-3
_MOST_ROWS: Final = 6.0
_WHOLE: Final = 1e-4


def true_states(answer: Answer, count: int) -> Floats:
    """Return the true states at the rows, with so many components or all that the loads read."""
    truth = replace(answer, file=answer.truth)
    return truth.states(max(count, answer.right.coupled)).T[None]


def at_other_times(answer: Answer, states: Floats, late: Floats) -> Floats:
    """Return the true motion so much later than at the rows, each from the state of the nearest row."""
    own, times = replace(answer, stepping=None), answer.times
    when, onward = times + late, np.sign(times[-1] - times[0]) or 1.0
    after = np.clip(np.searchsorted(onward * times, onward * when), 1, answer.count - 1)
    is_before = np.abs(when - times[after - 1]) < np.abs(when - times[after])
    near = np.where(is_before, after - 1, after)
    spans = when - times[near]
    steps = max(1, ceil(_STEPS * float(np.max(np.abs(spans))) / answer.spacing))
    return moved(own, answer.right, states[:, :, near], times[near], spans, steps)


def late_rows(answer: Answer, name: str) -> Iterator[tuple[str, Floats]]:
    """Yield the rows of a quantity that is late or early by a constant while another one is right."""
    others = [error for group, error in answer.worst.items() if group != name]
    if answer.has_states or not others or min(others) > _RIGHT * answer.worst[name]:
        return
    part, scale = part_of(answer, name)
    states = true_states(answer, part.stop)
    file, spacing = columns_of(answer, name, states), answer.spacing
    first = answer.begins - answer.times
    for is_held in (True, False):
        late, at, shifts = 0.0, states, np.zeros(answer.count)
        for place in range(_ROUNDS):
            # Rows that are held at the start do not move.
            slopes = (
                answer.right.rates(answer.times + shifts, at)[0, part] * (shifts == late) / scale
            )
            apart = (file - at[0, part]) / scale
            square = float(np.sum(slopes**2))
            step = float(np.sum(slopes * apart)) / square if square > 0 else 0.0
            if not place and np.linalg.norm(apart - step * slopes) > _FITS * np.linalg.norm(apart):
                return
            late = float(np.clip(late + step, -_MOST_ROWS * spacing, _MOST_ROWS * spacing))
            # Before the start a simulator may have nothing but the start.
            is_before = np.abs(first) < abs(late)
            shifts = np.where(is_held & is_before & (first * late >= 0), first, late)
            at = at_other_times(answer, states, shifts)
        yield _words(late, spacing / abs(answer.stride)), at[0, part].T


def columns_of(answer: Answer, name: str, states: Floats) -> Floats:
    """Return the file's rows of a quantity as columns; attitudes with the signs of those of the states."""
    file = answer.rows(answer.file, name).T
    if name != "attitude":
        return file
    return np.asarray(file * np.sign(np.sum(file * states[0, part_of(answer, name)[0]], axis=0)))


def part_of(answer: Answer, name: str) -> tuple[slice, float]:
    """Return the places of a quantity in a state, and its size."""
    n = answer.n
    if name == "attitude":
        return slice(n, n + 4), 1.0
    if name == "centre":
        return slice(n + 4, n + 7), answer.reach
    return answer.groups[name], float(answer.sizes[answer.groups[name]][0])


def _words(late: float, spacing: float) -> str:
    """Return how late the rows are: the rows hold the motion at a time ``late`` after theirs."""
    rows = abs(late) / spacing
    count = round(rows)
    of_rows = (
        f", {'one row' if count == 1 else f'{count} rows'}"
        if abs(rows - count) < _WHOLE and count
        else ""
    )
    return f"is {'late' if late < 0 else 'early'} by {abs(late):.6g}{of_rows}"
