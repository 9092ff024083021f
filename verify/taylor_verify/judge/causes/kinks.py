"""Arcs on which a load has a kink, as abs, min, max and clip have: stepped to the kink, and on from there.

A step over a kink is wrong by the square of its length, however high its order. So is a step a little past
the kink, but by the square of that little: it tells where the kink is.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import lru_cache
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.arcs import Arcs, moved
from taylor_verify.judge.causes.budget import Spent
from taylor_verify.judge.causes.changed_equations import Equations
from taylor_verify.judge.causes.float_answer import Answer, Places
from taylor_verify.judge.causes.limits import arguments
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.texts import places
from taylor_verify.models.acting import Acting
from taylor_verify.scenes.loads.vocabulary import VECTORS

_CALL: Final = re.compile(r"\b(abs|clip|max|min)\(")
# Of more arcs with a kink none is stepped to it, nor over more kinks of one arc.
_MOST: Final = 12
_MOST_OF_ARC: Final = 8
_ROUNDS: Final = 8
# A part of the motion by which no step over a kink matters.
_NOTHING: Final = 1e-9
# Of what may be spent yet, this part may be spent on kinks at once.
_SHARE: Final = 0.2
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
    with suppress(Spent), answer.budget.at_most(_SHARE * answer.budget.left):
        for k in _over_kinks(equations, arcs, begin[:1], ends[:1], steps):
            first = _of_arcs(equations, np.s_[k : k + 1])
            arc = begin[0, :, k], float(arcs.since[k]), float(arcs.spans[k])
            ends[:, :, k] += _through_kinks(answer, first, *arc, steps) - ends[0, :, k]
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


def _through_kinks(
    answer: Answer, equations: Equations, begin: Floats, since: float, span: float, steps: int
) -> Floats:
    """Return the end of one arc from a state (components,), in so many steps and some more at kinks."""
    z, now, left, kinks = begin, since, span, 0
    while left:
        h = span / steps if abs(left) > abs(span / steps) * (1 + _AT) else left
        end = _step(answer, equations, z, now, h)
        part = _to_kink(answer, equations, z, now, h, end) if kinks < _MOST_OF_ARC else None
        if part is not None:
            kinks, h = kinks + 1, part
            end = _step(answer, equations, z, now, h)
        z, now, left = end, now + h, left - h
    return z


def _step(answer: Answer, equations: Equations, z: Floats, since: float, h: float) -> Floats:
    ends = moved(answer, equations, z[None, :, None], np.array([since]), np.array([h]), 1)
    return np.asarray(ends[0, :, 0])


def _to_kink(
    answer: Answer, equations: Equations, z: Floats, since: float, h: float, end: Floats
) -> float | None:
    """Return the part of a step after which the first kink comes, by the secant method; None of none."""
    first, last = _at(equations, z, since), _at(equations, end, since + h)
    size = np.maximum(np.abs(first), np.abs(last))
    crossed = np.flatnonzero((first * last < 0) & (np.abs(first) > _AT * size))
    if not len(crossed):
        return None
    k = min(crossed, key=lambda k: first[k] / (first[k] - last[k]))
    a, b, at_a, at_b = 0.0, h, float(first[k]), float(last[k])
    for _ in range(_ROUNDS):
        if at_b == at_a:
            break
        guess = float(np.clip(b - at_b * (b - a) / (at_b - at_a), min(0.0, h), max(0.0, h)))
        a, at_a, b = b, at_b, guess
        if abs(b - a) <= _AT * abs(h):
            break
        at_b = float(_at(equations, _step(answer, equations, z, since, b), since + b)[k])
    is_inside = _AT * abs(h) < abs(b) < (1 - _AT) * abs(h)
    return b if is_inside else None


def _at(equations: Equations, z: Floats, time: float) -> Floats:
    return _values(equations, z[None, :, None], np.array([time]))[:, 0]


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
    for call in _CALL.finditer(text):
        yield from _of_call(call.group(1), arguments(text, call.start())[0])


def _of_call(name: str, inside: Sequence[str]) -> Iterator[str]:
    first, *others = inside
    if name == "abs":
        yield first
    for other in others:
        yield f"({first}) - ({other})"
