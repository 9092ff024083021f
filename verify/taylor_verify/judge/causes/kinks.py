"""Arcs on which a load has a kink, as abs, min, max and clip have: stepped to the kink, and on from there.

A step over a kink is wrong by the square of its length, however high its order. So is a step a little past
the kink, but by the square of that little: it tells where the kink is.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import combinations, product
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.arcs import Arcs, moved
from taylor_verify.judge.causes.changed_equations import Equations
from taylor_verify.judge.causes.float_answer import Places
from taylor_verify.judge.causes.limits import calls
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.texts import places
from taylor_verify.models.acting import Acting
from taylor_verify.scenes.loads.vocabulary import VECTORS

# Of more arcs with a kink none is stepped to it, nor over more kinks of one arc.
_MOST: Final = 128
_MOST_OF_ARC: Final = 8
_ROUNDS: Final = 8
# A part of the motion by which no step over a kink matters.
_NOTHING: Final = 1e-9
# Of what may be spent yet, this part may be spent on kinks at once.
_SHARE: Final = 0.4
# A step ends at a kink if it comes to this part of the step.
_AT: Final = 1e-9


def has_kinks(equations: Equations) -> bool:
    """Return True if the texts of the loads have kinks."""
    return equations.acting is not None and bool(_kinks(equations.acting))


def moved_through(arcs: Arcs, equations: Equations, begin: Floats, steps: int) -> Floats:
    """Return the ends of arcs from states (sets, components, arcs), through the kinks of the first set.

    The other sets differ from it as steps over the kinks say. Where all kinks cost too much, some arcs are
    as steps over them say.
    """
    ends, answer = arcs.moved(equations, begin, steps), arcs.answer
    if answer.stepping is not None or not has_kinks(equations):
        return ends
    with answer.budget.share(_SHARE):
        over = _over_kinks(equations, arcs, begin[:1], ends[:1], steps)
        if len(over):
            some = replace(arcs, first=arcs.first[over], last=arcs.last[over])
            through = _Stepped(some, _of_arcs(equations, over)).through(begin[0, :, over].T, steps)
            ends[:, :, over] += through - ends[0, :, over].T
    return ends


def _of_arcs(equations: Equations, some: Any) -> Equations:
    """Return the equations of the first set for some arcs, which may each have a load of their own."""
    load = np.asarray(equations.load)
    return equations if load.ndim < 3 else replace(equations, load=load[:1, :, some])


def _over_kinks(equations: Equations, arcs: Arcs, begin: Floats, end: Floats, steps: int) -> Places:
    """Return the arcs that steps over a kink get wrong, from states to others; none of many.

    States have the axes (1, components, arcs).
    """
    first = _values(equations, begin, arcs.since)
    last = _values(equations, end, arcs.since + arcs.spans)
    over = np.flatnonzero(np.any(first * last < 0, axis=0))
    if not len(over) or len(over) > _MOST:
        return over[:0]
    n, few = arcs.answer.n, replace(arcs, first=arcs.first[over], last=arcs.last[over])
    finer = few.moved(_of_arcs(equations, over), begin[:, :, over], 2 * steps)[0, :n]
    off = np.abs(finer - end[0, :n, over].T) / arcs.answer.sizes[:, None]
    least = np.maximum(0.1 * arcs.answer.rounding, _NOTHING)[:, None]
    return over[np.any(off > least, axis=0)]


@dataclass(frozen=True)
class _Stepped:
    """Arcs that are stepped to their kinks at once. States have the axes (components, arcs)."""

    arcs: Arcs
    equations: Equations

    def through(self, begin: Floats, steps: int) -> Floats:
        """Return the ends of the arcs in so many steps, and some more at kinks."""
        spans = self.arcs.spans
        z, now, left = begin.copy(), self.arcs.since.copy(), spans.copy()
        count = np.zeros(len(spans), dtype=int)
        while len(some := np.flatnonzero(left)):
            whole = spans[some] / steps
            h = np.where(np.abs(left[some]) > np.abs(whole) * (1 + _AT), whole, left[some])
            end = self._moved(some, z[:, some], now[some], h)
            part = self._to_kinks(some, z[:, some], now[some], h, end)
            at = np.flatnonzero(np.isfinite(part) & (count[some] < _MOST_OF_ARC))
            if len(at):
                short = some[at]
                count[short] += 1
                h[at] = part[at]
                end[:, at] = self._moved(short, z[:, short], now[short], h[at])
            z[:, some], now[some], left[some] = end, now[some] + h, left[some] - h
        return z

    def _moved(self, some: Places, z: Floats, since: Floats, h: Floats) -> Floats:
        equations = _of_arcs(self.equations, some)
        return np.array(moved(self.arcs.answer, equations, z[None], since, h, 1)[0])

    def _at(self, some: Places, z: Floats, times: Floats) -> Floats:
        return _values(_of_arcs(self.equations, some), z[None], times)

    def _to_kinks(self, some: Places, z: Floats, since: Floats, h: Floats, end: Floats) -> Floats:
        """Return the parts of steps after which their first kinks come, by secants; NaN of none."""
        first, last = self._at(some, z, since), self._at(some, end, since + h)
        size = np.maximum(np.abs(first), np.abs(last))
        is_crossed = (first * last < 0) & (np.abs(first) > _AT * size)
        parts, at = np.full(len(h), np.nan), np.flatnonzero(np.any(is_crossed, axis=0))
        if not len(at):
            return parts
        with np.errstate(all="ignore"):
            early = np.where(is_crossed, first / (first - last), np.inf)[:, at]
        k = np.argmin(early, axis=0), np.arange(len(at))
        h, z, since, some = h[at], z[:, at], since[at], some[at]
        a, b, at_a, at_b = np.zeros(len(at)), h.copy(), first[:, at][k], last[:, at][k]
        for _ in range(_ROUNDS):
            with np.errstate(all="ignore"):
                step = at_b * (b - a) / (at_b - at_a)
            guess = np.clip(
                b - np.where(np.isfinite(step), step, 0.0), np.minimum(0, h), np.maximum(0, h)
            )
            if np.all(np.abs(guess - b) <= _AT * np.abs(h)):
                b = guess
                break
            a, at_a, b = b, at_b, guess
            at_b = self._at(some, self._moved(some, z, since, b), since + b)[k]
        is_inside = (_AT * np.abs(h) < np.abs(b)) & (np.abs(b) < (1 - _AT) * np.abs(h))
        parts[at] = np.where(is_inside, b, np.nan)
        return parts


def _values(equations: Equations, states: Floats, times: Floats) -> Floats:
    """Return what changes its sign at the kinks of the loads, (kinks, arcs)."""
    assert equations.acting is not None
    nu, none = equations.velocities(times, states), np.zeros(equations.size)
    values = [
        replace(equations, acting=acting, load=none).loads_at(times, states, nu)[0]
        for acting in _kinks(equations.acting)
    ]
    return np.concatenate(values)


@lru_cache(maxsize=32)
def _kinks(acting: Acting) -> tuple[Acting, ...]:
    """Return the loads whose entries are zero at the kinks of others."""
    loads = acting.written
    texts = [*dict.fromkeys(t for place in places(loads) for t in _of_text(str(place.entry)))]
    names, size = VECTORS[loads.model], 3 * len(VECTORS[loads.model])
    others = list[Acting]()
    for first in range(0, len(texts), size):
        entries = [*texts[first : first + size], *["0"] * size]
        vectors = tuple((name, tuple(entries[3 * k : 3 * k + 3])) for k, name in enumerate(names))
        others.append(acting.of(replace(loads, vectors=vectors, hung=())))
    return tuple(others)


def _of_text(text: str) -> Iterator[str]:
    """Yield what is zero at the kinks of a text."""
    for name, inside in calls(text):
        yield from _of_call(name, inside)


def _of_call(name: str, inside: Sequence[str]) -> Iterator[str]:
    if name == "abs":
        yield inside[0]
    # The ends of a clip do not meet.
    pairs = product(inside[:1], inside[1:]) if name == "clip" else combinations(inside, 2)
    for one, other in pairs:
        yield f"({one}) - ({other})"
