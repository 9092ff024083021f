"""Equations in a current that take the velocity over ground, where the scene has that through the water.

With c = R^T V, the current in body axes, the velocity through the water is nu_r = nu - (c, 0). As V is
constant, c' = -W x c, and M nu_r' = M nu' + M (W x c, 0). The Coriolis terms of the rigid part are the same
with nu and nu_r (Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed., 8.1); those of an added mass A
are p x W and q x W + p x U, where (p, q) = A (U, W).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import Final

import numpy as np

from taylor_verify.judge.causes.changed_equations import Equations
from taylor_verify.judge.causes.changed_texts import added, by_component, renamed, rewritten
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.texts import decimal
from taylor_verify.judge.causes.vectors_of_texts import (
    BY_R,
    BY_TRANSPOSED,
    cross,
    plus,
    sum_of,
    turned,
)
from taylor_verify.scenes.loads.loads import Loads

_U: Final = ("u1", "u2", "u3")
_W: Final = ("w1", "w2", "w3")
# A mass is rounded to this part.
_ROUNDED: Final = 1e-15


def over_ground(right: Equations) -> Iterator[tuple[str, Loads]]:
    """Yield the loads that make of a scene's equations those over ground, with what is over ground."""
    loads = right.loads
    if loads is None or right.size == 3 or not any(loads.current):
        return
    numbers = [decimal(entry) for entry in loads.current]
    current = [f"({text})" for text in turned(numbers, BY_TRANSPOSED)]
    ground = {f"u{i}": f"(u{i} + {own})" for i, own in enumerate(current, 1)}
    words = "the loads take the velocity over ground, not that through the water"
    yield from by_component(loads, words, partial(renamed, names=ground))
    for words, others in (
        ("not turned into body axes", numbers),
        ("turned the wrong way, by R", turned(numbers, BY_R)),
    ):
        pairs = zip(ground.items(), others, strict=True)
        names = {name: f"({text} - ({other}))" for (name, text), other in pairs}
        other = rewritten(loads, partial(renamed, names=names))
        yield f"the current in the loads is {words}", other
    mass, rate = _without_roundings(right.mass), "the rate of the current in body axes"
    for words, factor in (("has the other sign", 2), ("is taken twice", -1)):
        yield f"{rate} {words}", _with(loads, *_accelerated(factor * mass, current))
    rate = f"{rate} is left out"
    yield (
        f"{rate}: nu' over ground for that through the water",
        _with(loads, *_accelerated(mass, current)),
    )
    if right.added is None:
        return
    slow, turning = _accelerated(right.added, current), _coriolis(right.added, current)
    yield f"{rate} of the added mass: M_A nu' for M_A nu_r'", _with(loads, *slow)
    yield (
        "the Coriolis terms of the added mass take the velocity over ground",
        _with(loads, *turning),
    )
    both = (_sums(a, b) for a, b in zip(slow, turning, strict=True))
    name = "the added mass moves over ground, not through the water: M_A nu' and C_A(nu) nu"
    yield name, _with(loads, *both)


def _without_roundings(mass: Floats) -> Floats:
    """Return a mass matrix with zeros for entries that are roundings of others."""
    size = np.sqrt(np.diag(mass))
    return np.where(np.abs(mass) > _ROUNDED * np.outer(size, size), mass, 0.0)


def _accelerated(mass: Floats, current: Sequence[str]) -> tuple[list[str], list[str]]:
    """Return force and couple M (W x c, 0)."""
    rate = cross(_W, current)
    return _times(mass[:3, :3], rate), _times(mass[3:, :3], rate)


def _coriolis(mass: Floats, current: Sequence[str]) -> tuple[list[str], list[str]]:
    """Return what the Coriolis terms of an added mass are more with U + c than with U."""
    p = _sums(_times(mass[:3, :3], _U), _times(mass[:3, 3:], _W))
    more, of_couple = _times(mass[:3, :3], current), _times(mass[3:, :3], current)
    couple = _sums(cross(of_couple, _W), cross(p, current))
    return cross(more, _W), _sums(couple, cross(more, _sums(_U, current)))


def _sums(one: Sequence[str], other: Sequence[str]) -> list[str]:
    return [plus(a, b) for a, b in zip(one, other, strict=True)]


def _with(loads: Loads, force: Sequence[str], couple: Sequence[str]) -> Loads:
    return added(loads, {"force": force, "couple": couple})


def _times(matrix: Floats, vector: Sequence[str]) -> list[str]:
    """Return a matrix of numbers times a vector."""
    rows = (zip(map(float, row), vector, strict=True) for row in matrix)
    return [sum_of((repr(factor), text) for factor, text in row if factor) for row in rows]
