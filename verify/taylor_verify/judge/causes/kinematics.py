"""Causes in the attitude, given the moving part: wrong sides, factors, and replayed updates."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.arcs import Arcs, Evidence, moved, row_to_row, some_arcs
from taylor_verify.judge.causes.candidate import Candidate, Cause, has_few_digits
from taylor_verify.judge.causes.changed_equations import Changes, Equations
from taylor_verify.judge.causes.fit import Family, fault, linear
from taylor_verify.judge.causes.fitted_search import Search
from taylor_verify.judge.causes.float_answer import Answer, Motion, Places
from taylor_verify.judge.causes.many_flows import Floats, flow
from taylor_verify.judge.causes.many_frames import AFTER, outer, rotations, to_space
from taylor_verify.judge.causes.other_frames import steady_rate
from taylor_verify.judge.causes.proof import chained, maps_of_attitude, may_leave, with_units
from taylor_verify.judge.causes.quaternion_rows import angles, matrices
from taylor_verify.judge.causes.replayed_methods import OF_SECOND_ORDER, UPDATES
from taylor_verify.judge.causes.stepped_arcs import Steps, replay
from taylor_verify.judge.conventions.angle_meanings import Angles
from taylor_verify.words.causes import steps_in_words

_CLEAR: Final = 20.0
# What a replayed update leaves of the defects.
_REPLAYED: Final = 1e-2
_MOST: Final = 256
# The error of an update in few steps of an arc points where the defects do.
_FEW: Final = 4
_ALONG: Final = 0.5

# A turn between two rows that is wrong by so many roundings, and by this part of the largest, is a jump.
_JUMP: Final = 40.0
_PART: Final = 1e-3
# Jumps are few: this many, and one in so many rows.
_FEW_JUMPS: Final = 3
# What the jump of omega within a row turns, by that at the end of the row.
_TURNED: Final = 1.5
_ONE_IN: Final = 10
_LAST: Final = 3
# The weights (b, a) of q' = (b W q + a q W) / 2.
_WRONG: Final = (
    ("attitude kinematics in the wrong axes: R' = [omega]x R with omega in body axes", (1.0, 0.0)),
    ("attitude turned backwards: R' = -R [omega]x", (0.0, -1.0)),
    ("transposed attitude: R' = -[omega]x R", (-1.0, 0.0)),
    ("attitude stands still: R' = 0", (0.0, 0.0)),
    ("attitude turns twice as fast: q' = q omega, where q' = q omega / 2", (0.0, 2.0)),
    ("attitude turns half as fast: q' = q omega / 4, where q' = q omega / 2", (0.0, 0.5)),
)
_ANGLES: Final = (
    "attitude by roll' = p, pitch' = q, yaw' = r: the body's rates are no rates of Euler angles"
)


# The maps of q over arcs.
Maps = Callable[[Arcs], Floats]


def kinematics(answer: Answer, right: Equations, method: Steps | None = None) -> Cause | None:
    """Return the proven cause of a wrong attitude by equations that are right for the moving part.

    The steps of a ``method`` of the moving part are taken for that part. An attitude that
    follows from the file's own omega is not wrong by itself.
    """
    answer = answer.with_start(right.mass)
    maps = maps_of_attitude(right, row_to_row(answer))
    if method is None and _left(answer, maps, [0]) is not None:
        return None
    if method is None and (in_pieces := _in_pieces(answer, right, maps)) is not None:
        return in_pieces
    if not answer.moving:
        # What the file rounds off of a right omega adds up over the rows.
        answer = replace(answer, file=replace(answer.file, v=answer.truth.v))
    turns, stride = _turns(answer, right)
    if turns.floor * _CLEAR > 1:
        return None
    search = Search(answer, turns, turns.motion, ["attitude"])
    # Steps lead from row to row.
    candidates = [*_updates(turns, method)] if stride == 1 else []
    if method is None:
        faults = [fault(name, "kinematics", {"turns": np.array(pair)}) for name, pair in _WRONG]
        fitted = search.fitted(_families(answer, right))
        if steady_rate(answer) is not None:
            # Such a turn does not tell the error of a method from a factor.
            fitted = (each for each in fitted if has_few_digits(each, turns.floor))
        candidates += [*search.without_numbers(faults), *fitted]
        name = (
            "attitude kinematics with omega in space axes: R' = R [omega]x, which is for body axes"
        )
        candidates.append(turns.candidate(name, "kinematics", partial(_by_space, right)))
        if right.coupled == answer.n:
            candidates.append(_by_angles(answer, right))
    return search.cause(candidates)


def _turns(answer: Answer, right: Equations) -> tuple[_Turns, int]:
    """Return turns over as many rows as stand out of the rounding, up to a quarter, and that number."""
    turns, stride = _Turns(answer, some_arcs(answer), right), 1
    while turns.floor * _CLEAR > 1 and 8 * stride <= answer.count:
        stride *= 2
        turns = replace(turns, arcs=some_arcs(answer, stride))
    return turns, stride


@dataclass(frozen=True)
class _Turns(Evidence):
    """Attitudes at the ends of arcs, by equations that are ``right`` for the moving part."""

    arcs: Arcs
    right: Equations

    @property
    def rounding(self) -> Floats:
        return np.full(4, max(self.answer.noise[1], 1e-16))

    def defects(self, sets: Sequence[Changes]) -> Floats:
        n = self.answer.n
        ends = self.arcs.ends(self.right.copies(sets), self.arcs.steps, n + 4)[:, n : n + 4]
        return self.rest(np.broadcast_to(ends, (len(sets), *ends.shape[1:])))

    def rest(self, q: Floats) -> Floats:
        """Return the difference of the file from quaternions; q and -q are one attitude."""
        assert self.answer.file.q is not None
        ends, unit = (
            self.answer.file.q[self.arcs.last].T,
            q / np.linalg.norm(q, axis=-2)[..., None, :],
        )
        signs = np.sign(np.sum(ends * unit, axis=-2))[..., None, :]
        return np.asarray(ends * signs - unit)

    def motion(self, answer: Answer, changes: Changes) -> Motion:
        return _chained(partial(maps_of_attitude, self.right.changed(changes)), answer, changes)

    def candidate(self, name: str, kind: str, maps: Maps) -> Candidate:
        """Return the candidate whose attitudes follow by maps of q."""
        q = self.arcs.begin(self.answer.n + 4)[0, self.answer.n :]
        rest = self.rest(np.einsum("aij,ja->ia", maps(self.arcs), q))
        left = float(np.linalg.norm(rest)) / self.size
        of_maps = fault(name, kind, {})
        return Candidate(of_maps, of_maps.right, left, partial(_chained, maps), _REPLAYED)


def _chained(maps: Maps, answer: Answer, _: Changes) -> Motion:
    assert answer.start.q is not None
    return Motion(answer.truth.v, chained(maps(row_to_row(answer)), answer.start.q[0]))


def _by_space(right: Equations, arcs: Arcs) -> Floats:
    """Return the maps of q by q' = q omega / 2 with the components of the true omega in space axes."""
    n, truth = arcs.answer.n, arcs.answer.truth.q
    assert truth is not None
    true = np.broadcast_to(truth[arcs.first].T, (4, 4, len(arcs.first)))
    own = with_units(arcs.begin(n)[0])
    begin = np.concatenate([own[:, :n], true, own[:, n:]], axis=1)

    def rates(time: Floats, z: Floats) -> Floats:
        in_space = to_space(rotations(z[:, n : n + 4]), right.velocities(time, z)[:, -3:])
        turned = AFTER @ outer(z[:, n + 4 :], in_space)
        return np.concatenate([right.rates(time, z[:, : n + 4]), turned], axis=1)

    ends = flow(rates, begin, arcs.since, arcs.spans, arcs.steps)
    return np.asarray(ends[:, n + 4 :].transpose(2, 1, 0))


def _by_angles(answer: Answer, right: Equations) -> Candidate:
    """Return the candidate of Euler angles whose rates are p, q and r, tried on all rows at once."""
    motion = _turned_by_angles(right, answer, {})
    left = answer.leaves(motion).get("attitude", np.inf)
    of_angles = fault(_ANGLES, "kinematics", {})
    return Candidate(of_angles, of_angles.right, left, partial(_turned_by_angles, right), _REPLAYED)


def _turned_by_angles(right: Equations, answer: Answer, _: Changes) -> Motion:
    """Return attitudes whose roll, pitch and yaw are the integrals of p, q and r."""
    n, arcs = answer.n, row_to_row(answer)
    begin = np.concatenate([arcs.begin(n)[0], np.zeros((3, len(arcs.first)))])

    def rates(time: Floats, z: Floats) -> Floats:
        v = z[:, :n]
        return np.concatenate([right.rates(time, v), right.velocities(time, v)[:, -3:]], axis=1)

    ends = flow(rates, begin[None], arcs.since, arcs.spans, arcs.steps)[0, n:].T
    assert answer.start.q is not None
    R = matrices(answer.start.q[:1])[0]
    first = (
        np.arctan2(R[2, 1], R[2, 2]),
        -np.arcsin(np.clip(R[2, 0], -1, 1)),
        np.arctan2(R[1, 0], R[0, 0]),
    )
    roll, pitch, yaw = (
        np.array(first) + np.concatenate([np.zeros((1, 3)), np.cumsum(ends, axis=0)])
    ).T
    return Motion(answer.truth.v, Angles("zyx").quaternions(np.stack([yaw, pitch, roll], axis=1)))


def _families(answer: Answer, right: Equations) -> list[Family]:
    omega = answer.truth.v[:, -3:]
    pace = 1.0 if right.has_momenta else float(np.max(np.linalg.norm(omega, axis=1)))
    turns, name = right.changed({"turns": np.array([0.0, 1.0])}), "attitude turns by a factor"
    return [
        linear(right, "attitude by the rate of another moment", "late rate", 0.1 / pace, ahead=[1]),
        linear(turns, name, "kinematics", 1.0, [1], turns=[[0, 1]]),
    ]


def _updates(turns: _Turns, method: Steps | None) -> Iterator[Candidate]:
    arcs, right, n = turns.arcs, turns.right, turns.answer.n
    if right.coupled > n:
        return
    q, rates = arcs.begin(n + 4)[:, n:], cache(partial(_rates, right, arcs, method))
    exact = turns.rest(arcs.ends(right, arcs.steps, n + 4)[0, n : n + 4])
    for name, update in UPDATES.items():

        def error(steps: int, update: Any = update) -> Floats:
            return turns.rest(_updated(update, q, rates(steps), arcs.spans / steps)[0])

        if method is None and not _is_along(exact, exact - error(_FEW)):
            continue
        order = 2 if name in OF_SECOND_ORDER else 1
        steps = method.count if method else _steps(order, partial(_apart, error, exact), turns.size)
        some = {steps} if method else {max(1, steps - 1), steps, steps + 1}
        best = min(some, key=lambda k: _size(error(k)))
        long = steps_in_words(arcs.spans.tolist(), best)
        words = f"attitude {name}" + ("" if method else f", {long}")
        yield turns.candidate(words, "attitude step", partial(_maps, right, update, best, method))


def _size(rest: Floats) -> float:
    size = float(np.linalg.norm(rest))
    return size if np.isfinite(size) else np.inf


def _apart(error: Callable[[int], Floats], exact: Floats, steps: int) -> float:
    return _size(error(steps) - exact)


def _is_along(one: Floats, other: Floats) -> bool:
    """Return True if two errors have nearly the same direction."""
    return bool(np.sum(one * other) > _ALONG * _size(one) * _size(other))


def _steps(order: int, error: Callable[[int], float], size: float) -> int:
    """Return the number of steps whose error has this size."""
    steps = 1
    for _ in range(4):
        own = error(steps)
        if not 0 < own < np.inf:
            break
        further = int(np.clip(round(steps * (own / size) ** (1 / order)), 1, _MOST))
        if further == steps:
            break
        steps = further
    return steps


def _updated(update: Any, q: Floats, rates: list[Floats], h: Floats) -> Floats:
    """Return q, not of unit length, after an update from each of the rates to the next."""
    for before, after in itertools.pairwise(rates):
        q = update(q, before, after, h)
    return q


def _rates(right: Equations, arcs: Arcs, method: Steps | None, steps: int) -> list[Floats]:
    """Return omega at the begin of the arcs and after each of so many steps."""
    answer, h = arcs.answer, arcs.spans / steps
    v = arcs.begin(answer.n)
    rows = [v]
    if method:
        for k in range(steps):
            rows.append(replay(answer, method.method, 1, right, rows[-1], arcs.since + k * h, h))
    else:
        spans, since = np.outer(np.arange(1, steps + 1), h).ravel(), np.tile(arcs.since, steps)
        ends = moved(answer, right, np.tile(v, steps), since, spans, arcs.steps)
        rows += np.split(ends, steps, axis=2)
    return [right.velocities(arcs.since + k * h, each)[:, -3:] for k, each in enumerate(rows)]


def _maps(right: Equations, update: Any, steps: int, method: Steps | None, arcs: Arcs) -> Floats:
    """Return the maps of q; an update is linear in q up to the length."""
    n = arcs.answer.n
    q = with_units(arcs.begin(n)[0])[:, n:]
    rates = _rates(right, arcs, method, steps)
    return _updated(update, q, rates, arcs.spans / steps).transpose(2, 1, 0)


# Attitudes that are set anew, or at rest for a part of the run.


def _in_pieces(answer: Answer, right: Equations, maps: Floats) -> Cause | None:
    """Return the cause of attitudes that are right from row to row but at few of them, given the motion."""
    q, n, arcs = answer.file.q, answer.n, row_to_row(answer)
    assert q is not None
    ends = arcs.ends(right, arcs.steps)
    turned = np.einsum("aij,aj->ai", maps, q[:-1])
    wrong = angles(q[1:], turned / np.linalg.norm(turned, axis=1, keepdims=True))
    # What turns more than the file's own omega lets it is no jump of the attitude alone.
    apart = np.linalg.norm(arcs.end[-3:] - ends[0, n - 3 : n], axis=0)
    by_omega = np.abs(arcs.spans) * apart
    bad = np.flatnonzero(wrong > max(_JUMP * answer.roundings["attitude"], _PART * np.max(wrong)))
    still = np.all(q[1:] == q[:-1], axis=1)
    if not len(bad) or bad[0] == 0 or np.all(wrong[bad] <= _TURNED * by_omega[bad]):
        return None
    if still[bad].all() and len(bad) >= _LAST and np.all(np.diff(bad) == 1):
        return _stands_still(answer, maps, bad)
    if len(bad) > min(_FEW_JUMPS, answer.count // _ONE_IN):
        return None
    begins = [0, *(int(row) + 1 for row in bad)]
    listed = ", ".join(f"{answer.times[row] + answer.right.start:.6g}" for row in begins[1:])
    words = (
        f"attitude set anew at t = {listed}: each piece follows the motion from its own first row"
    )
    is_start = angles(q[bad[:1] + 1], q[:1])[0] <= answer.roundings["attitude"]
    words += ", which is the attitude of the start" if is_start and len(bad) == 1 else ""
    return _proven(answer, maps, begins, words)


def _stands_still(answer: Answer, maps: Floats, bad: Places) -> Cause | None:
    """Return the cause of attitudes that do not change in one part of the run."""
    last = int(bad[-1]) + 1
    still = maps.copy()
    still[bad] = np.eye(4)
    times = answer.times + answer.right.start
    end = f" to {times[last]:.6g}" if last < answer.count - 1 else " on"
    where = f"from t = {times[bad[0]]:.6g}{end}"
    words = f"attitude stands still {where}, and follows the motion before"
    return _proven(answer, still, [0], words)


def _proven(answer: Answer, maps: Floats, begins: list[int], words: str) -> Cause | None:
    """Return the cause if each piece follows from its own first row."""
    left = _left(answer, maps, begins)
    return None if left is None else Cause(words, "attitude in pieces", {"attitude": left})


def _left(answer: Answer, maps: Floats, begins: list[int]) -> float | None:
    """Return what is left where each piece follows from its own first row, the first one from the start.

    It is None where that is too much for a proof.
    """
    q, start = answer.file.q, answer.start.q
    assert q is not None
    assert start is not None
    pieces = [
        chained(maps[begin : end - 1], q[begin] if begin else start[0])
        for begin, end in zip(begins, [*begins[1:], answer.count], strict=True)
    ]
    left = answer.leaves(Motion(answer.truth.v, np.concatenate(pieces))).get("attitude", np.inf)
    return None if left > may_leave(answer, ["attitude"]) else left
