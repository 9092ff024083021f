"""Equations in a current that take the velocity over ground, where the scene has that through the water.

With c = R^T V, the current in body axes, the velocity through the water is nu_r = nu - (c, 0). As V is
constant, c' = -W x c, and M nu_r' = M nu' + M (W x c, 0). The Coriolis terms of the rigid part are the same
with nu and nu_r (Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed., 8.1); those of an added mass A
are p x W and q x W + p x U, where (p, q) = A (U, W).
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Final

from taylor_verify.judge.causes.changed_equations import Equations
from taylor_verify.judge.causes.changed_texts import (
    added,
    alone_and_together,
    decimal,
    plus,
    renamed,
    rewritten,
    sum_of,
    turned_entry,
)
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.scenes.loads.loads import Loads

_Vector = tuple[str, str, str]
_U: Final[_Vector] = ("u1", "u2", "u3")
_W: Final[_Vector] = ("w1", "w2", "w3")


def over_ground(right: Equations) -> Iterator[tuple[str, Loads]]:
    """Yield the loads that make of a scene's equations those over ground, with what is over ground."""
    loads = right.loads
    if loads is None or right.size == 3 or not any(loads.current):
        return
    one, two, three = (turned_entry(loads.current, "r{1}{0}", i) for i in (1, 2, 3))
    current = (one, two, three)
    ground = {f"u{i}": f"(u{i} + {own})" for i, own in enumerate(current, 1)}
    words = "the loads take the velocity over ground, not that through the water"
    yield from alone_and_together(loads, words, partial(renamed, names=ground))
    for words, entry in (
        ("not turned into body axes", ""),
        ("turned the wrong way, by R", "r{0}{1}"),
    ):
        others = (
            turned_entry(loads.current, entry, i) if entry else f"({decimal(own)})"
            for i, own in enumerate(loads.current, 1)
        )
        pairs = zip(ground.items(), others, strict=True)
        names = {name: f"({text} - {other})" for (name, text), other in pairs}
        other = rewritten(loads, partial(renamed, names=names))
        yield f"the current in the loads is {words}", other
    rate = "the rate of the current in body axes is left out"
    yield (
        f"{rate}: nu' over ground for that through the water",
        _with(loads, *_accelerated(right.mass, current)),
    )
    if right.added is None:
        return
    slow, turning = _accelerated(right.added, current), _coriolis(right.added, current)
    yield f"{rate} of the added mass: M_A nu' for M_A nu_r'", _with(loads, *slow)
    yield (
        "the Coriolis terms of the added mass take the velocity over ground",
        _with(loads, *turning),
    )
    both = (_plus(a, b) for a, b in zip(slow, turning, strict=True))
    name = "the added mass moves over ground, not through the water: M_A nu' and C_A(nu) nu"
    yield name, _with(loads, *both)


def _accelerated(mass: Floats, current: _Vector) -> tuple[_Vector, _Vector]:
    """Return force and couple M (W x c, 0)."""
    rate = _cross(_W, current)
    return _times(mass[:3, :3], rate), _times(mass[3:, :3], rate)


def _coriolis(mass: Floats, current: _Vector) -> tuple[_Vector, _Vector]:
    """Return what the Coriolis terms of an added mass are more with U + c than with U."""
    p, more = (
        _plus(_times(mass[:3, :3], _U), _times(mass[:3, 3:], _W)),
        _times(mass[:3, :3], current),
    )
    couple = _plus(_cross(_times(mass[3:, :3], current), _W), _cross(p, current))
    return _cross(more, _W), _plus(couple, _cross(more, _plus(_U, current)))


def _with(loads: Loads, force: _Vector, couple: _Vector) -> Loads:
    return added(loads, {"force": force, "couple": couple})


def _times(matrix: Floats, vector: _Vector) -> _Vector:
    one, two, three = (
        sum_of(
            (repr(float(factor)), text) for factor, text in zip(row, vector, strict=True) if factor
        )
        for row in matrix
    )
    return one, two, three


def _cross(a: _Vector, b: _Vector) -> _Vector:
    one, two, three = (
        sum_of([(f"({a[j]})", b[k]), (f"({sum_of([('-1', a[k])])})", b[j])])
        for j, k in ((1, 2), (2, 0), (0, 1))
    )
    return one, two, three


def _plus(a: _Vector, b: _Vector) -> _Vector:
    one, two, three = map(plus, a, b)
    return one, two, three
