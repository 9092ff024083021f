"""Families of faults in the terms of the equations: clock, gyroscopic term, wheels, loads, drag."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.answer import Answer
from taylor_verify.judge.causes.equations import Equations
from taylor_verify.judge.causes.fault import Fault, Sizes, of_coriolis
from taylor_verify.judge.causes.fit import Family
from taylor_verify.judge.causes.flow import Floats


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
    for name, part in (("Munk moment", "munk"), ("term x x W", "turn"), ("term y x W", "gyro")):
        rows = getattr(right, part)
        yield Fault(f"no {name}", "Coriolis terms", {part: 0 * rows})
        yield Fault(f"{name} with the other sign", "Coriolis terms", {part: -rows})
        yield Fault(f"{name} twice", "Coriolis terms", {part: 2 * rows})


def load_names(n: int) -> list[str]:
    """Return the names of the components of the loads."""
    nouns = ("moment",) if n == 3 else ("force", "couple")
    return [f"{noun} {i}" for noun in nouns for i in (1, 2, 3)]


def families_of_terms(answer: Answer, sizes: Sizes) -> Iterator[Family]:
    """Yield the families of terms, one number first."""
    right, n, one = answer.right, answer.n, np.ones(1)
    yield Family("clock", "clock", one, one, lambda p: {"clock": p[0]})
    word = "gyroscopic term" if n == 3 else "Coriolis terms"

    def factor(p: Floats) -> dict[str, Floats]:
        return {**of_coriolis(p[0] * right.mass), "rotor": p[0] * right.rotor}

    yield Family(f"factor of the {word}", "gyroscopic term", one, one, factor)
    if np.any(right.rotor):
        yield from _wheels(right)
    if right.acting is not None or np.any(right.load):
        yield Family(
            "factor of the moment" if n == 3 else "factor of the loads",
            "load",
            *(one, one),
            lambda p: {"weights": np.full(n, p[0])},
        )
    if right.acting is not None:
        late = np.array([0.1 / sizes.pace])
        yield Family("loads late", "load", 0 * one, late, lambda p: {"late": p[0]})
    yield from _loads(right, sizes)
    yield from _drags(right, sizes)
    if right.damping:
        yield from _damping_steps(right)
    if n == 6:
        yield from _factors_in_fluid(right)


def _wheels(right: Equations) -> Iterator[Family]:
    scale, one = np.full(3, np.linalg.norm(right.rotor)), np.ones(1)
    yield Family(
        "factor of the wheels", "wheels", one, one, lambda p: {"rotor": p[0] * right.rotor}
    )
    for i in range(3):
        unit = np.eye(3)[i]
        yield Family(
            f"wheel {i + 1}",
            "wheels",
            right.rotor[[i]],
            scale[:1],
            lambda p, i=i, unit=unit: {"rotor": right.rotor + (p[0] - right.rotor[i]) * unit},
        )
    yield Family("wheels", "wheels", right.rotor, scale, lambda p: {"rotor": p})


def _loads(right: Equations, sizes: Sizes) -> Iterator[Family]:
    n, zeros = right.size, np.zeros(right.size)
    for i, name in enumerate(load_names(n)):
        unit = np.eye(n)[i]
        yield Family(
            f"{name}, body axes",
            "load",
            right.load[[i]],
            sizes.load[[i]],
            lambda p, i=i, unit=unit: {"load": right.load + (p[0] - right.load[i]) * unit},
        )
        yield Family(
            f"{name}, space axes",
            "load in space axes",
            np.zeros(1),
            sizes.load[[i]],
            lambda p, unit=unit: {"space": p[0] * unit},
        )
    for first in range(0, n, 3):
        part, noun = slice(first, first + 3), load_names(n)[first].split()[0]
        yield Family(
            f"{noun} in body axes",
            "load",
            right.load[part],
            sizes.load[part],
            lambda p, part=part: {"load": _placed(right.load, part, p)},
        )
        yield Family(
            f"{noun} in space axes",
            "load in space axes",
            np.zeros(3),
            sizes.load[part],
            lambda p, part=part: {"space": _placed(zeros, part, p)},
        )
    arms, axis = sizes.load[-3:], np.eye(3)[2]
    yield Family(
        "couple r x R^T e3 (weight and buoyancy), r along axis 3",
        "restoring couple",
        np.zeros(1),
        arms[2:],
        lambda p: {"arm": p[0] * axis},
    )
    yield Family(
        "couple r x R^T e3 (weight and buoyancy)",
        "restoring couple",
        np.zeros(3),
        arms,
        lambda p: {"arm": p},
    )
    if n == 6:
        yield Family(
            "force and couple in body axes", "load", right.load, sizes.load, lambda p: {"load": p}
        )


def _placed(vector: Floats, part: slice, values: Floats) -> Floats:
    changed = vector.copy()
    changed[part] = values
    return changed


def _drags(right: Equations, sizes: Sizes) -> Iterator[Family]:
    n, zero = right.size, np.zeros(1)
    pace = np.array([sizes.pace])
    yield Family("damping", "damping", zero + right.damping, pace, lambda p: {"damping": p[0]})
    turns = np.concatenate([np.zeros(n - 3), np.ones(3)])
    yield Family(
        "one drag on all rates of turn",
        "drag",
        zero,
        pace * np.min(sizes.inertia[-3:]) ** 2,
        lambda p: {"linear": p[0] * turns},
    )
    for name, power in (("linear", 1), ("quadratic", 2)):
        scale = sizes.load / sizes.nu**power
        kind = f"{name} drag"
        for i in range(n):
            unit = np.eye(n)[i]
            yield Family(
                f"{name} drag on axis {i + 1}",
                kind,
                zero,
                scale[[i]],
                lambda p, name=name, unit=unit: {name: p[0] * unit},
            )
        for first in range(0, n, 3):
            part = slice(first, first + 3)
            noun = load_names(n)[first].split()[0]
            yield Family(
                f"{name} drag, {noun}",
                kind,
                np.zeros(3),
                scale[part],
                lambda p, name=name, part=part: {name: _placed(np.zeros(n), part, p)},
            )
        if n == 6:
            yield Family(f"{name} drag", kind, np.zeros(6), scale, lambda p, name=name: {name: p})


def _factors_in_fluid(right: Equations) -> Iterator[Family]:
    one = np.ones(1)
    for name, part in (("Munk moment", "munk"), ("term x x W", "turn"), ("term y x W", "gyro")):
        rows = getattr(right, part)
        yield Family(
            f"factor of the {name}",
            "Coriolis terms",
            *(one, one),
            lambda p, part=part, rows=rows: {part: p[0] * rows},
        )


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

        def changes(p: Floats, factor: Any = factor, place: str = place) -> dict[str, Any]:
            step = float(p[0]) or 1e-9
            f = factor(right.damping * step)
            damping = -np.log(f) / step if f > 0 else np.nan
            k = damping * step / (1 - f) * (1.0 if place == "after" else f)
            turns = np.array([0.0, k])
            return {**of_coriolis(k * right.mass), "damping": damping, "turns": turns}

        title = f"{name}: the momentum times {words} {place} the motion of each step, with h"
        yield Family(title, "damping step", 1e-3 * h, h, changes)
