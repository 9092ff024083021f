"""Weight and buoyancy otherwise: left out, at other points, fixed in body axes, or written as texts."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Final

import numpy as np

from taylor_verify.judge.causes.changed_texts import added
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.texts import HANGING, decimal
from taylor_verify.judge.causes.vectors_of_texts import (
    BY_R,
    BY_TRANSPOSED,
    cross,
    turned,
)
from taylor_verify.numbers.tensors import ZERO_VECTOR, Vector, scaled
from taylor_verify.scenes.loads.loads import Hung, Loads

# A point is the centre of mass if it is no farther from it than by this part, for the rounding of doubles.
_NEAR: Final = 1e-12


def hung_otherwise(loads: Loads) -> Iterator[tuple[str, Loads]]:
    """Yield weight and buoyancy, each and both, left out, at other points, or in other axes."""
    has_force = [k for k, hung in enumerate(loads.hung) if any(hung.force)]
    points = [hung.at for hung in loads.hung]
    if len(has_force) > 1 and points[0] != points[1]:
        pairs = zip(loads.hung, reversed(points), strict=True)
        exchanged = tuple(Hung(hung.force, at) for hung, at in pairs)
        yield "points of weight and buoyancy exchanged", replace(loads, hung=exchanged)
    for some in [*([k] for k in has_force), *[has_force] * (len(has_force) > 1)]:
        noun = " and ".join(HANGING[k] for k in some)
        without = with_hung(loads, some, lambda hung: Hung(ZERO_VECTOR))
        yield f"{noun} left out", without
        if any(any(loads.hung[k].at) for k in some):
            yield f"{noun} at the origin", with_hung(loads, some, lambda hung: Hung(hung.force))
            if loads.model == "kirchhoff":
                # Of a rigid body weight is a moment, and no more.
                words = f"couple of {noun} with the other sign"
                yield words, with_hung(loads, some, _turned_round)
        for words, texts_of in _OTHERWISE.items():
            other = without
            for k in some:
                other = added(other, texts_of(loads.hung[k]))
            yield f"{noun} {words}", other


def hung_at_centre(loads: Loads | None, centre: Floats, factor: int) -> Loads | None:
    """Return the loads with what hangs at the centre of mass at this factor of it; None if nothing does."""
    every = () if loads is None else loads.hung
    some = [k for k, hung in enumerate(every) if any(hung.at) and _is_near(hung.at, centre)]
    if loads is None or not some:
        return None
    return with_hung(loads, some, lambda hung: Hung(hung.force, scaled(Fraction(factor), hung.at)))


def _is_near(at: Vector, centre: Floats) -> bool:
    size = float(np.max(np.abs(centre)))
    return bool(np.all(np.abs(np.array(at, dtype=float) - centre) <= _NEAR * size))


def with_hung(loads: Loads, some: Sequence[int], change: Callable[[Hung], Hung]) -> Loads:
    """Return the loads with a change of weight, buoyancy, or both."""
    hung = (change(each) if k in some else each for k, each in enumerate(loads.hung))
    return replace(loads, hung=tuple(hung))


def _turned_round(hung: Hung) -> Hung:
    """Return a force whose couple has the other sign: it acts at the opposite point."""
    return Hung(hung.force, scaled(Fraction(-1), hung.at))


def written_out(loads: Loads) -> Loads:
    """Return the same loads with weight and buoyancy as texts of force and couple."""
    for hung in loads.hung:
        loads = added(loads, _texts_of(hung))
    return replace(loads, hung=())


_Texts = dict[str, list[str]]


def _texts_of(hung: Hung) -> _Texts:
    """Return the force and the couple of a hung force, in body axes."""
    return _at(hung, turned(map(decimal, hung.force), BY_TRANSPOSED))


def _at(hung: Hung, force: Sequence[str]) -> _Texts:
    """Return a force at the point of a hung one with its couple: the moment of a rigid body."""
    couple = cross([*map(decimal, hung.at)], force)
    return {"force": [*force], "couple": couple, "moment": couple}


def _with_arm_in_space(hung: Hung) -> _Texts:
    """Return a hung force whose point is fixed in space axes, from the origin."""
    couple = turned(_at(hung, [*map(decimal, hung.force)])["couple"], BY_TRANSPOSED)
    return _texts_of(hung) | {"couple": couple, "moment": couple}


_OTHERWISE: Final[dict[str, Callable[[Hung], _Texts]]] = {
    "fixed in body axes": lambda hung: _at(hung, [*map(decimal, hung.force)]),
    "turned the wrong way, by R": lambda hung: _at(hung, turned(map(decimal, hung.force), BY_R)),
    "at an arm that is not turned with the body": _with_arm_in_space,
}
