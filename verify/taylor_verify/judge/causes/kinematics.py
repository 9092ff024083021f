"""Causes in the attitude, given the moving part: wrong sides, factors, and replayed updates."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache, partial
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.answer import Answer, Motion
from taylor_verify.judge.causes.arcs import Arcs, moved, row_to_row
from taylor_verify.judge.causes.attitude_pieces import attitude_in_pieces
from taylor_verify.judge.causes.candidate import Cause
from taylor_verify.judge.causes.equations import AFTER, Equations, outer, rotations, to_space
from taylor_verify.judge.causes.fault import linear
from taylor_verify.judge.causes.flow import Floats, flow
from taylor_verify.judge.causes.methods import UPDATES
from taylor_verify.judge.causes.proof import BETTER, LEAVES, chained, may_leave, with_units
from taylor_verify.judge.causes.replays import replay
from taylor_verify.scenes.instants import evenly
from taylor_verify.words.causes import with_numbers

_ARCS: Final = 16
_CLEAR: Final = 20.0
# What a hypothesis without numbers leaves of the defects.
_REPLAYED: Final = 1e-2
_MOST: Final = 256

# The weights (b, a) of q' = (b W q + a q W) / 2.
_WRONG: Final = (
    ("attitude kinematics in the wrong axes: R' = [omega]x R with omega in body axes", (1.0, 0.0)),
    ("attitude turned backwards: R' = -R [omega]x", (0.0, -1.0)),
    ("transposed attitude: R' = -[omega]x R", (-1.0, 0.0)),
    ("attitude stands still: R' = 0", (0.0, 0.0)),
    ("attitude turns twice as fast: q' = q omega, where q' = q omega / 2", (0.0, 2.0)),
    ("attitude turns half as fast: q' = q omega / 4, where q' = q omega / 2", (0.0, 0.5)),
)


@dataclass(frozen=True)
class _Tried:
    """A hypothesis: the part of the defects that it leaves, and its maps of q over arcs."""

    name: str
    kind: str
    left: float
    maps: Callable[[Arcs], Floats]
    numbers: Floats | None = None

    @property
    def count(self) -> int:
        return 0 if self.numbers is None else len(self.numbers)

    @property
    def text(self) -> str:
        return self.name if self.numbers is None else with_numbers(self.name, (), (), self.numbers)


def kinematics(answer: Answer, right: Equations, method: Any = None) -> Cause | None:
    """Return the proven cause of a wrong attitude by equations that are right for the moving part.

    A ``method`` of the moving part, with its number of steps, is taken for that part.
    """
    answer = answer.with_start(right.mass)
    rows = np.array(evenly(answer.count - 1, _ARCS))
    arcs = Arcs(answer, rows, rows + 1)
    assert answer.file.q is not None
    ends = answer.file.q[rows + 1].T
    exact = _turned(right, arcs)
    size, floor = _apart(ends, exact), max(answer.noise[1], 1e-16) * np.sqrt(ends.size)
    in_pieces = None if method else attitude_in_pieces(answer, right)
    if in_pieces is not None or size < _CLEAR * floor:
        return in_pieces
    tried = list(_replays(right, arcs, ends, exact, method))
    if method is None:
        tried += [*_wrong(right, arcs, ends, size), *_fits(right, arcs, ends, size)]
    near = [
        each
        for each in tried
        if each.left < max(LEAVES if each.count else _REPLAYED, 30 * floor / size)
    ]
    return _settled(answer, sorted(near, key=lambda each: (each.count, each.left)))


def _settled(answer: Answer, near: list[_Tried]) -> Cause | None:
    every = row_to_row(answer)
    for each in near:
        simpler = [other for other in near if other.count < each.count]
        if any(other.left < BETTER * each.left for other in simpler):
            continue
        assert answer.start.q is not None
        q = chained(each.maps(every), answer.start.q[0])
        left = answer.leaves(Motion(answer.truth.v, q)).get("attitude", np.inf)
        if left <= may_leave(answer, ["attitude"], each.count):
            same = [other for other in near if other.count == each.count and other is not each]
            alike = tuple(other.text for other in same if other.left < 3 * each.left)
            return Cause(each.name, each.kind, {"attitude": left}, each.text, alike)
    return None


def _apart(ends: Floats, q: Floats) -> float:
    """Return the size of the difference of quaternions."""
    apart = float(np.linalg.norm(_rest(ends, q)))
    return apart if np.isfinite(apart) else np.inf


def _rest(ends: Floats, q: Floats) -> Floats:
    """Return the difference of quaternions; q and -q are one attitude."""
    unit = q / np.linalg.norm(q, axis=0)
    return np.asarray(ends * np.sign(np.sum(ends * unit, axis=0)) - unit)


def _turned(right: Equations, arcs: Arcs) -> Floats:
    """Return q at the ends of the arcs by the equations."""
    n = arcs.answer.n
    return np.asarray(arcs.ends(right, arcs.steps, n + 4)[0, n : n + 4])


def _weighted(changed: Equations, arcs: Arcs) -> Floats:
    """Return the maps of q over the arcs by equations of the attitude."""
    n, begin = arcs.answer.n, with_units(arcs.begin(arcs.answer.n)[0])
    ends = moved(arcs.answer, changed, begin, arcs.since, arcs.spans, arcs.steps)
    return np.asarray(ends[:, n:].transpose(2, 1, 0))


def _wrong(right: Equations, arcs: Arcs, ends: Floats, size: float) -> Iterator[_Tried]:
    for name, weights in _WRONG:
        changed = right.changed({"turns": np.array(weights)})
        left = _apart(ends, _turned(changed, arcs)) / size
        yield _Tried(name, "kinematics", left, partial(_weighted, changed))
    assert arcs.answer.file.q is not None
    by_space = np.einsum("aij,aj->ia", _by_space(right, arcs), arcs.answer.file.q[arcs.first])
    name = "attitude kinematics with omega in space axes: R' = R [omega]x, which is for body axes"
    yield _Tried(name, "kinematics", _apart(ends, by_space) / size, partial(_by_space, right))


def _by_space(right: Equations, arcs: Arcs) -> Floats:
    """Return the maps of q by q' = q omega / 2 with the components of the true omega in space axes."""
    n, truth = arcs.answer.n, arcs.answer.truth.q
    assert truth is not None
    true = np.broadcast_to(truth[arcs.first].T, (4, 4, len(arcs.first)))
    own = with_units(arcs.begin(n)[0])
    begin = np.concatenate([own[:, :n], true, own[:, n:]], axis=1)

    def rates(time: Floats, z: Floats) -> Floats:
        in_space = to_space(rotations(z[:, n : n + 4]), _omega(right, z[:, :n]))
        turned = AFTER @ outer(z[:, n + 4 :], in_space)
        return np.concatenate([right.rates(time, z[:, : n + 4]), turned], axis=1)

    ends = flow(rates, begin, arcs.since, arcs.spans, arcs.steps)
    return np.asarray(ends[:, n + 4 :].transpose(2, 1, 0))


def _fits(right: Equations, arcs: Arcs, ends: Floats, size: float) -> Iterator[_Tried]:
    omega = arcs.answer.truth.v[:, -3:]
    pace = 1.0 if right.has_momenta else float(np.max(np.linalg.norm(omega, axis=1)))
    turns, name = right.changed({"turns": np.array([0.0, 1.0])}), "attitude turns by a factor"
    families = (
        linear(right, "attitude by the rate of another moment", "late rate", 0.1 / pace, ahead=[1]),
        linear(turns, name, "kinematics", 1.0, [1], turns=[[0, 1]]),
    )
    for family in families:
        numbers = family.right.copy()
        for _ in range(4):
            rest = [
                _rest(ends, _turned(right.changed(changes), arcs))
                for changes in (family.changes(numbers), *family.around(numbers))
            ]
            slopes = family.slopes(np.array(rest[1:]))
            numbers = numbers - np.linalg.lstsq(slopes, rest[0].ravel(), rcond=1e-9)[0]
        if f"{numbers[0]:.6g}" == "1":
            continue
        changed = right.changed(family.changes(numbers))
        left = _apart(ends, _turned(changed, arcs)) / size
        yield _Tried(family.name, family.kind, left, partial(_weighted, changed), numbers)


def _replays(
    right: Equations, arcs: Arcs, ends: Floats, exact: Floats, method: Any
) -> Iterator[_Tried]:
    n = arcs.answer.n
    if right.coupled > n:
        return
    q, size = arcs.begin(n + 4)[:, n:], _apart(ends, exact)
    unit = exact / np.linalg.norm(exact, axis=0)
    rates = cache(partial(_rates, right, arcs, method))
    for name, (order, update) in UPDATES.items():

        def apart(rows: Floats, steps: int, update: Any = update) -> float:
            return _apart(rows, _updated(update, q, rates(steps), arcs.spans / steps)[0])

        steps = method[1] if method else _steps(order, partial(apart, unit), size)
        some = {steps} if method else {max(1, steps - 1), steps, steps + 1}
        tried = {k: apart(ends, k) / size for k in some}
        best = min(tried, key=lambda k: tried[k])
        h = float(np.median(np.abs(arcs.spans))) / best
        words = f"attitude {name}" + ("" if method else f", h = {h:.6g}")
        yield _Tried(
            words, "attitude step", tried[best], partial(_maps, right, update, best, method)
        )


def _steps(order: int, error: Callable[[int], float], size: float) -> int:
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


def _rates(right: Equations, arcs: Arcs, method: Any, steps: int) -> list[Floats]:
    """Return omega at the begin of the arcs and after each of so many steps."""
    answer, h = arcs.answer, arcs.spans / steps
    v = arcs.begin(answer.n)
    rows = [v]
    if method:
        for k in range(steps):
            rows.append(replay(answer, method[0], right, rows[-1], arcs.since + k * h, h, 1))
    else:
        spans, since = np.outer(np.arange(1, steps + 1), h).ravel(), np.tile(arcs.since, steps)
        ends = moved(answer, right, np.tile(v, steps), since, spans, arcs.steps)
        rows += np.split(ends, steps, axis=2)
    return [_omega(right, each) for each in rows]


def _omega(right: Equations, v: Floats) -> Floats:
    return (right.inverse @ v if right.has_momenta else v)[:, -3:]


def _maps(right: Equations, update: Any, steps: int, method: Any, arcs: Arcs) -> Floats:
    """Return the maps of q; an update is linear in q up to the length."""
    n = arcs.answer.n
    q = with_units(arcs.begin(n)[0])[:, n:]
    rates = _rates(right, arcs, method, steps)
    return _updated(update, q, rates, arcs.spans / steps).transpose(2, 1, 0)
