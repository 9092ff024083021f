"""Families of faults in the terms of the equations: clock, gyroscopic term, wheels, loads, drag."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.answer import Answer
from taylor_verify.judge.causes.equations import Changes, Equations
from taylor_verify.judge.causes.fault import Fault, Sizes, of_coriolis
from taylor_verify.judge.causes.fit import Family
from taylor_verify.judge.causes.flow import Floats

_TERMS: Final = (("Munk moment", "munk"), ("term x x W", "turn"), ("term y x W", "gyro"))


def faults_of_terms(right: Equations) -> Iterator[Fault]:
    """Yield terms left out, of the other sign, or in other axes."""
    nothing = 0 * right.rotor
    word = "gyroscopic term" if right.size == 3 else "Coriolis terms"
    for name, factor in ((f"no {word}", 0.0), (f"{word} with the other sign", -1.0)):
        changes = {**of_coriolis(factor * right.mass), "rotor": factor * right.rotor}
        yield Fault(name, "gyroscopic term", changes)
    if np.any(right.rotor):
        yield Fault(
            "gyroscopic term of the wheels alone", "gyroscopic term", {"gyro": 0 * right.gyro}
        )
        yield Fault("wheels left out", "wheels", {"rotor": nothing})
        yield Fault("wheels with the other sign", "wheels", {"rotor": -right.rotor})
        yield from _single_wheels(right)
    yield from _faults_of_loads(right)
    if right.damping:
        yield Fault("damping left out", "damping", {"damping": 0.0})
        yield Fault("damping with the other sign", "damping", {"damping": -right.damping})
        linear = np.full(right.size, float(right.damping))
        yield Fault("damping of the velocity", "damping", {"damping": 0.0, "linear": linear})
    if right.size == 6:
        yield from _fluid_terms(right)


def _single_wheels(right: Equations) -> Iterator[Fault]:
    if np.count_nonzero(right.rotor) < 2:
        return
    for i in np.flatnonzero(right.rotor):
        for words, factor in (("left out", 0.0), ("with the other sign", -1.0)):
            rotor = right.rotor.copy()
            rotor[i] *= factor
            yield Fault(f"wheel {i + 1} {words}", "wheels", {"rotor": rotor})


def _faults_of_loads(right: Equations) -> Iterator[Fault]:
    n = right.size
    if right.acting is None and not np.any(right.load):
        return
    noun = "moment" if n == 3 else "loads"
    for words, factor in (("left out", 0.0), ("with the other sign", -1.0), ("twice", 2.0)):
        yield Fault(f"{noun} {words}", "load", {"weights": np.full(n, factor)})
    yield Fault(f"{noun} in space axes", "load", {"in_space": 1.0})
    if n == 6:
        for (name, part), (words, factor) in product(
            (("force", np.s_[:3]), ("couple", np.s_[3:])),
            (("left out", 0.0), ("with the other sign", -1.0)),
        ):
            weights = np.ones(6)
            weights[part] = factor
            yield Fault(f"{name} {words}", "load", {"weights": weights})
    if right.acting is None:
        yield from _faults_of_constant_loads(right)


def _faults_of_constant_loads(right: Equations) -> Iterator[Fault]:
    names = load_names(right.size)
    if right.size == 3:
        load = right.mass @ right.load
        yield Fault("moment not divided by the inertia", "load", {"load": load})
    if np.count_nonzero(right.load) > 1:
        for i, (words, factor) in product(
            np.flatnonzero(right.load), (("left out", 0.0), ("with the other sign", -1.0))
        ):
            load = right.load.copy()
            load[i] *= factor
            yield Fault(f"{names[i]} {words}", "load", {"load": load})
    for first, order in product(range(0, right.size, 3), ((1, 0, 2), (0, 2, 1), (2, 1, 0))):
        load = right.load.copy()
        load[first : first + 3] = load[first : first + 3][list(order)]
        if np.any(load != right.load):
            noun = names[first].split()[0]
            yield Fault(f"components of the {noun} exchanged", "load", {"load": load})


def _fluid_terms(right: Equations) -> Iterator[Fault]:
    for name, part in _TERMS:
        rows = getattr(right, part)
        yield Fault(f"no {name}", "Coriolis terms", {part: 0 * rows})
        yield Fault(f"{name} with the other sign", "Coriolis terms", {part: -rows})
        yield Fault(f"{name} twice", "Coriolis terms", {part: 2 * rows})


def load_names(n: int) -> list[str]:
    """Return the names of the components of the loads."""
    nouns = ("moment",) if n == 3 else ("force", "couple")
    return [f"{noun} {i}" for noun in nouns for i in (1, 2, 3)]


def families_of_terms(answer: Answer, sizes: Sizes) -> Iterator[Family]:
    """Yield the families of terms: clock, gyroscopic term, wheels, loads, drag and damping."""
    right, n = answer.right, answer.n
    yield _family("clock", "clock", "clock", 1.0, 1.0)
    word = "gyroscopic term" if n == 3 else "Coriolis terms"
    one = np.ones(1)

    def factor(p: Floats) -> Changes:
        return {**of_coriolis(p[0] * right.mass), "rotor": p[0] * right.rotor}

    yield Family(f"factor of the {word}", "gyroscopic term", one, one, factor)
    if np.any(right.rotor):
        yield from _wheels(right)
    if right.acting is not None or np.any(right.load):
        noun = "moment" if n == 3 else "loads"
        yield _family(f"factor of the {noun}", "load", "weights", np.ones(n), 1.0, np.ones((1, n)))
    if right.acting is not None:
        yield _family("loads late", "load", "late", 0.0, 0.1 / sizes.pace)
    yield from _loads(right, sizes)
    yield _family("damping", "damping", "damping", right.damping, sizes.pace)
    yield from _drags(n, sizes)
    if right.damping:
        yield from _damping_steps(right)
    if n == 6:
        for name, part in _TERMS:
            rows = getattr(right, part)
            title = f"factor of the {name}"
            yield _family(title, "Coriolis terms", part, rows, 1.0, rows[None], np.ones(1))


def _family(
    name: str,
    kind: str,
    field: str,
    base: Any,
    scale: Any,
    directions: Floats | None = None,
    right: Floats | None = None,
) -> Family:
    """Return a family that changes one parameter linearly, along one or more directions.

    Without ``right`` the numbers are the components of the ``base`` along the directions.
    """
    base = np.asarray(base, dtype=float)
    along = np.ones((1, *base.shape)) if directions is None else directions
    if right is None:
        flat = along.reshape(len(along), -1)
        right = flat @ base.ravel() / np.sum(flat**2, axis=1)
    scales = np.broadcast_to(np.asarray(scale, dtype=float), right.shape)

    def changes(p: Floats) -> Changes:
        return {field: base + np.tensordot(p - right, along, axes=1)}

    return Family(name, kind, right, scales, changes)


def _wheels(right: Equations) -> Iterator[Family]:
    size, unit = np.linalg.norm(right.rotor), np.eye(3)
    along = right.rotor[None]
    yield _family("factor of the wheels", "wheels", "rotor", right.rotor, 1.0, along)
    for i in range(3):
        yield _family(f"wheel {i + 1}", "wheels", "rotor", right.rotor, size, unit[[i]])
    yield _family("wheels", "wheels", "rotor", right.rotor, size, unit)


def _loads(right: Equations, sizes: Sizes) -> Iterator[Family]:
    n, unit, names = right.size, np.eye(right.size), load_names(right.size)
    in_space = (("load", "body axes", right.load), ("space", "space axes", np.zeros(n)))
    for field, axes, base in in_space:
        kind = "load" if field == "load" else "load in space axes"
        for i, name in enumerate(names):
            yield _family(f"{name}, {axes}", kind, field, base, sizes.load[i], unit[[i]])
        for first in range(0, n, 3):
            part, noun = slice(first, first + 3), names[first].split()[0]
            yield _family(f"{noun} in {axes}", kind, field, base, sizes.load[part], unit[part])
    if n == 6:
        yield _family("force and couple in body axes", "load", "load", right.load, sizes.load, unit)
    name, arms = "couple r x R^T e3 (weight and buoyancy)", sizes.load[-3:]
    for title, axes_ in ((f"{name}, r along axis 3", [2]), (name, [0, 1, 2])):
        along = np.eye(3)[axes_]
        yield _family(title, "restoring couple", "arm", np.zeros(3), arms[axes_], along)


def _drags(n: int, sizes: Sizes) -> Iterator[Family]:
    zeros, unit, names = np.zeros(n), np.eye(n), load_names(n)
    turns = np.concatenate([np.zeros(n - 3), np.ones(3)])
    least = sizes.pace * np.min(sizes.inertia[-3:]) ** 2
    name = "one drag on all rates of turn"
    yield _family(name, "linear drag", "linear", zeros, least, turns[None])
    for field, power in (("linear", 1), ("quadratic", 2)):
        scale, kind = sizes.load / sizes.nu**power, f"{field} drag"
        for i in range(n):
            yield _family(f"{kind} on axis {i + 1}", kind, field, zeros, scale[i], unit[[i]])
        for first in range(0, n, 3):
            part, noun = slice(first, first + 3), names[first].split()[0]
            yield _family(f"{kind}, {noun}", kind, field, zeros, scale[part], unit[part])
        if n == 6:
            yield _family(kind, kind, field, zeros, scale, unit)


# The factor of one step as a function of x = c h.
_FACTORS: Final = (
    ("explicit damping step", "1 - c h", lambda x: 1 - x),
    ("implicit damping step", "1/(1 + c h)", lambda x: 1 / (1 + x)),
    ("exponential damping step", "exp(-c h)", lambda x: np.exp(-x)),
)


def _damping_steps(right: Equations) -> Iterator[Family]:
    """Yield damping by a factor f once in each step h, after the motion of the step or before it.

    With f = e^(-c' h) such an engine solves P' = k (terms of second order) - c' P exactly, where
    k = c' h/(1 - f) for a factor after the motion, and f times that for one before it. The attitude turns
    by k omega.
    """
    if np.any(right.load) or np.any(right.rotor) or right.acting is not None:
        return
    h = np.array([0.05 / abs(right.damping)])
    for (name, words, factor), place in product(_FACTORS, ("after", "before")):

        def changes(p: Floats, factor: Any = factor, place: str = place) -> Changes:
            step = float(p[0]) or 1e-9
            f = factor(right.damping * step)
            damping = -np.log(f) / step if f > 0 else np.nan
            k = damping * step / (1 - f) * (1.0 if place == "after" else f)
            turns = np.array([0.0, k])
            return {**of_coriolis(k * right.mass), "damping": damping, "turns": turns}

        title = f"{name}: the momentum times {words} {place} the motion of each step, with h"
        yield Family(title, "damping step", 1e-3 * h, h, changes)
