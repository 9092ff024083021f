"""Weight and buoyancy otherwise: left out, at other points, fixed in body axes, or written as texts."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction

from taylor_verify.judge.causes.changed_texts import added, decimal, sum_of
from taylor_verify.judge.causes.texts import HANGING
from taylor_verify.numbers.tensors import ZERO_VECTOR, scaled
from taylor_verify.scenes.loads.loads import Hung, Loads


def hung_otherwise(loads: Loads) -> Iterator[tuple[str, Loads]]:
    """Yield weight and buoyancy, each and both, left out, at the origin, or fixed in body axes."""
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
        fixed = without
        for k in some:
            fixed = added(fixed, _texts_of(loads.hung[k], is_in_body=True))
        yield f"{noun} fixed in body axes", fixed


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


def _texts_of(hung: Hung, is_in_body: bool = False) -> dict[str, list[str]]:
    """Return the force and the couple of a hung force; with ``is_in_body`` it is fixed in body axes.

    The couple is the moment of a rigid body, whose origin is held.
    """
    force = [
        decimal(hung.force[i])
        if is_in_body
        else sum_of(
            (f"r{k}{i + 1}", decimal(f)) for k, f in zip((1, 2, 3), hung.force, strict=True)
        )
        for i in range(3)
    ]
    places = ((1, 2), (2, 0), (0, 1))
    couple = [
        sum_of(
            [(f"({decimal(hung.at[j])})", force[k]), (f"({decimal(hung.at[k], '-')})", force[j])]
        )
        for j, k in places
    ]
    return {"force": force, "couple": couple, "moment": couple}
