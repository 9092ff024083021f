"""Rows of a right motion: repeated, single ones wrong, or interpolated between exact ones."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Final

import numpy as np

from taylor_verify.judge.causes.candidate import Cause
from taylor_verify.judge.causes.float_answer import Answer, Motion, Places
from taylor_verify.judge.causes.many_flows import Floats, cubic

_BAD: Final = 30.0
# A simulator has errors of its own: those below this part of the largest one.
_OWN: Final = 1e-6
_FEWEST: Final = 4
_ONE_IN: Final = 20
_MOST_BETWEEN: Final = 12
# What interpolation leaves, and how far single rows stand out from all others.
_LEAVES: Final = 1e-2
_ROUNDINGS: Final = 10.0
_STANDS_OUT: Final = 100.0


def wrong_rows(answer: Answer) -> Cause | None:
    """Return the cause of an answer most of whose rows are right."""
    answer = replace(answer, quantities=_far_off(answer))
    bad = np.zeros(answer.count, dtype=bool)
    for name in answer.failed:
        bad |= answer.error[name] > max(_BAD * answer.roundings[name], _OWN * answer.worst[name])
    wrong, good = np.flatnonzero(bad), ~bad
    if not len(wrong) or np.count_nonzero(good) < max(_FEWEST, answer.count // _ONE_IN):
        return None
    return _repeated(answer, wrong) or _interpolated(answer, bad) or _single(answer, wrong, good)


def _far_off(answer: Answer) -> tuple[str, ...]:
    """Return the quantities that failed by more than a simulator's own errors beside those of others."""
    largest = max(answer.worst[name] for name in answer.failed)
    return tuple(answer.quantity(n) for n in answer.failed if answer.worst[n] > _OWN * largest)


def are_saved_twice(answer: Answer) -> bool:
    """Return True if every second row is the row before it, and no other is."""
    parts = [part for part in (answer.file.v, answer.file.q, answer.file.c) if part is not None]
    are_same = np.all([np.all(part[1:] == part[:-1], axis=1) for part in parts], axis=0)
    is_long = answer.count >= _MOST_BETWEEN
    return is_long and bool(np.all(are_same[::2]) and not np.any(are_same[1::2]))


def _repeated(answer: Answer, wrong: Places) -> Cause | None:
    parts = [part for part in (answer.file.v, answer.file.q, answer.file.c) if part is not None]
    is_repeated = all(
        row > 0 and all(np.array_equal(part[row], part[row - 1]) for part in parts) for row in wrong
    )
    if not is_repeated or len(wrong) > answer.count // 2 or answer.stride != 1:
        return None
    count = "one row repeats" if len(wrong) == 1 else f"{len(wrong)} rows repeat"
    return _of_some(answer, wrong, f"{count} the row before")


def _single(answer: Answer, wrong: Places, good: Floats) -> Cause | None:
    stands_out = all(
        np.max(answer.error[name][wrong])
        > _STANDS_OUT * max(answer.roundings[name], float(np.max(answer.error[name][good])))
        for name in answer.failed
    )
    is_end = len(wrong) > 1 and wrong[-1] == answer.count - 1 and bool(np.all(np.diff(wrong) == 1))
    if not stands_out or is_end or len(wrong) > max(1, answer.count // _ONE_IN):
        return None
    count = "one row is" if len(wrong) == 1 else f"{len(wrong)} rows are"
    return _of_some(answer, wrong, f"{count} wrong")


def _of_some(answer: Answer, wrong: Places, what: str) -> Cause:
    """Return the cause of an answer whose other rows are right."""
    first = answer.times[wrong[0]] + answer.right.start
    some = f"{answer.count} rows" if abs(answer.stride) == 1 else f"{answer.count} examined rows"
    name = f"{what} (first at t = {first:.6g}); all others of {some} are right"
    return Cause(name, "rows", dict.fromkeys(answer.failed, 0.0))


# Interpolation: every so many rows one is exact.


def _interpolated(answer: Answer, bad: Floats) -> Cause | None:
    file, (rates, turns) = answer.file, _rates(answer)
    for every in range(2, _MOST_BETWEEN + 1):
        nodes = np.arange(0, answer.count, every)
        if len(nodes) < _FEWEST or np.any(bad[nodes]):
            continue
        tried = dict[str, dict[str, float]]()
        for name, (between, of_q) in _KINDS.items():
            v = between(answer, nodes, file.v, rates)
            q = None if file.q is None else of_q(answer, nodes, file.q, turns)
            unit = None if q is None else q / np.linalg.norm(q, axis=1, keepdims=True)
            errors = answer.errors(Motion(v, unit))
            tried[name] = _leaves(answer, errors, np.s_[: nodes[-1]])
        # Small turns are nearly linear.
        name, leaves = min(tried.items(), key=lambda each: max(each[1].values(), default=np.inf))
        if not leaves:
            return None
        allowed = max(_LEAVES, min(0.1, _ROUNDINGS * answer.floor([*leaves])))
        if max(leaves.values()) <= allowed:
            words = (
                f"{name} between exact rows: every {every * abs(answer.stride)} rows one is exact"
            )
            return Cause(words, "interpolation", leaves)
    return None


def _leaves(answer: Answer, errors: dict[str, Floats], rows: slice) -> dict[str, float]:
    """Return what is left of the error of the same rows: others may be wrong for another reason."""
    return {
        name: float(np.max(errors[name][rows]))
        / max(float(np.max(answer.error[name][rows])), 1e-300)
        for name in answer.failed
        if name in errors
    }


def _rates(answer: Answer) -> tuple[Floats, Floats]:
    """Return the rates of v and q along the truth, with the file's sign of q.

    They are unknown where they depend on states of the scene's own.
    """
    if answer.has_states:
        return np.full((answer.count, answer.n), np.nan), np.full((answer.count, 4), np.nan)
    parts = [answer.truth.v, answer.truth.q]
    if answer.right.reads > 4:
        parts.append(answer.truth.c)
    z = np.hstack([part for part in parts if part is not None]).T[None]
    rates = answer.right.rates(answer.times, z)[0].T
    of_q = rates[:, answer.n : answer.n + 4]
    if answer.file.q is not None and answer.truth.q is not None:
        of_q = of_q * np.sign(np.sum(answer.file.q * answer.truth.q, axis=1))[:, None]
    return rates[:, : answer.n], of_q


def _linear(answer: Answer, nodes: Places, rows: Floats, rates: Floats) -> Floats:
    times = answer.times
    return np.stack([np.interp(times, times[nodes], column[nodes]) for column in rows.T], axis=1)


def _held(answer: Answer, nodes: Places, rows: Floats, rates: Floats) -> Floats:
    last = np.searchsorted(nodes, np.arange(answer.count), side="right") - 1
    return np.asarray(rows[nodes][np.maximum(last, 0)])


def _cubic(answer: Answer, nodes: Places, rows: Floats, rates: Floats) -> Floats:
    return cubic(answer.times[nodes], rows[nodes], rates[nodes], answer.times)


def _along_arcs(answer: Answer, nodes: Places, rows: Floats, rates: Floats) -> Floats:
    """Return unit quaternions on the great circles between exact ones, at equal paces (slerp)."""
    k = np.clip(
        np.searchsorted(nodes, np.arange(answer.count), side="right") - 1, 0, len(nodes) - 2
    )
    one, other = rows[nodes[k]], rows[nodes[k + 1]]
    cosine = np.sum(one * other, axis=1, keepdims=True)
    angle = np.arccos(np.clip(np.abs(cosine), 0.0, 1.0)) / np.pi
    begins, ends = answer.times[nodes[k]], answer.times[nodes[k + 1]]
    part = ((answer.times - begins) / (ends - begins))[:, None]
    first, last = (p * np.sinc(p * angle) / np.sinc(angle) for p in (1 - part, part))
    return np.asarray(first * one + np.sign(cosine) * last * other)


_Between = Callable[[Answer, Places, Floats, Floats], Floats]
_KINDS: Final[dict[str, tuple[_Between, _Between]]] = {
    "linear interpolation": (_linear, _linear),
    "linear interpolation and slerp of the attitude": (_linear, _along_arcs),
    "cubic interpolation (Hermite)": (_cubic, _cubic),
    "values that are held": (_held, _held),
}
