"""Conserved quantities of a motion under written loads, each with its value, scale and sensitivity.

They are made of the quantities of the free body: a momentum along some directions, and T + V.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from taylor_verify.exact.conserved.conservation import ENERGY, Conservation, conservation
from taylor_verify.exact.conserved.potential import Potential
from taylor_verify.exact.conserved.wheels import with_wheels
from taylor_verify.exact.invariant import Array, Invariant
from taylor_verify.exact.registry import kind_of
from taylor_verify.exact.row_arithmetic import nonzero, norms, size
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Vector, identity
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.mpfr import real
from taylor_verify.scenes.scene import Scene

_ENERGY: Final = "T"
# Components of a momentum in space, by the name of the whole.
_ALONG: Final = {"H_space": "H_along", "x_space": "x_along", "y_space": "y_along"}
_AXES: Final = ("H_axis", "y_axis")
_BODY_AXES: Final = {f"y{k + 1}": axis for k, axis in enumerate(identity(3))}


def under_loads(scene: Scene, free: Sequence[Invariant]) -> tuple[Invariant, ...]:
    """Return the quantities of the free body, those marked that the loads conserve, and T + V and the like.

    What the tracked quantities do not determine is left out.
    """
    loads, proven = scene.body.loads, conservation(scene)
    if loads is not None and loads.rotor:
        free = [free[0], *with_wheels(scene, loads)]
    axes = tuple(axis for name in _AXES for axis in proven.directions.get(name, ()))
    steady = {each.name for each in free if _is_along(each.name, axes)} | proven.steady
    marked = [
        replace(each, because=f"{each.name} = constant")
        if each.name in steady
        else replace(each, is_conserved=False)
        for each in free
    ]
    known = {each.name for each in marked if each.is_conserved}
    more = [each for each in _more(scene, marked, proven) if each.name not in known]
    replaced = {each.name for each in more}
    return (*(each for each in marked if each.name not in replaced), *more)


def _is_along(name: str, axes: Sequence[Vector]) -> bool:
    """True for the component about a body axis that is in the span of orthogonal vectors."""
    if name not in _BODY_AXES:
        return False
    unit = _BODY_AXES[name]
    return sum(tensors.dot(unit, axis) ** 2 / tensors.dot(axis, axis) for axis in axes) == 1


def _more(scene: Scene, free: Sequence[Invariant], proven: Conservation) -> Iterator[Invariant]:
    by_name = {each.name: each for each in free}
    if proven.potential is not None and (
        energy := _energy(scene, by_name[_ENERGY], proven.potential)
    ):
        yield energy
    for whole, name in _ALONG.items():
        if whole in proven.directions and whole in by_name:
            yield _along(by_name[whole], name, proven.directions[whole])
    for name in _AXES:
        directions = proven.directions.get(name, ())
        if directions and not any(each.name in _BODY_AXES and each.is_conserved for each in free):
            yield _about(scene, name, directions)


def _energy(scene: Scene, kinetic: Invariant, potential: Potential) -> Invariant | None:
    """T + V; None where it depends on more than the scene tracks."""
    needed = {"attitude", "centre"} if potential.has_centre else {"attitude"}
    if not needed <= scene.track:
        return None

    def value(motion: Motion) -> Array:
        total: Array = kinetic.value(motion) + potential.value(motion)
        return total

    def sensitivity(motion: Motion) -> Mapping[str, Array]:
        parts = {**kinetic.sensitivity(motion), "attitude": potential.by_turn(motion)}
        if potential.has_centre:
            parts["centre"] = potential.by_centre(motion)
        return parts

    return Invariant(
        ENERGY, value, kinetic.scale, sensitivity, because=f"T + V = constant, V = {potential}"
    )


def _along(whole: Invariant, name: str, directions: Sequence[Vector]) -> Invariant:
    """The components of a vector along orthogonal directions."""

    def value(motion: Motion) -> Array:
        rows = whole.value(motion)
        components: Array = rows @ _units(directions, rows).T
        return components

    because = f"{whole.name} . n = constant, n = {_written(directions)}"
    return replace(whole, name=name, value=value, is_conserved=True, because=because)


def _about(scene: Scene, name: str, directions: Sequence[Vector]) -> Invariant:
    """The components of H or y, without wheels, about orthogonal axes of the body."""
    kind, body = kind_of(scene.body), scene.body

    def momentum(motion: Motion) -> Array:
        rows: Array = kind.momentum_rows(body, motion)[:, -3:]
        return rows

    def value(motion: Motion) -> Array:
        rows = momentum(motion)
        components: Array = rows @ _units(directions, rows).T
        return components

    def sensitivity(motion: Motion) -> Mapping[str, Array]:
        rows = momentum(motion)
        units = _units(directions, rows)
        return {kind.momenta[-1]: np.tile(norms(units.T), (len(rows), 1))}

    because = f"{name[0]} . n = constant, n = {_written(directions)} in body axes"
    return Invariant(
        name, value, lambda motion: nonzero(size(momentum(motion))), sensitivity, because=because
    )


def _units(directions: Sequence[Vector], like: Array) -> Array:
    """The directions as unit vectors, in the numbers of an array."""
    rows = real(directions, like)
    units: Array = rows / norms(rows)[:, None]
    return units


def _written(directions: Sequence[Vector]) -> str:
    return " and ".join(f"({', '.join(map(str, n))})" for n in directions)
