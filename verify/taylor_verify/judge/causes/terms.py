"""Faults and families in the terms of the equations: clock, gyroscopic term, wheels, loads, drag."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from itertools import permutations, product
from typing import Final

import numpy as np

from taylor_verify.judge.causes.basis import coriolis, coriolis_of, crossed
from taylor_verify.judge.causes.changed_equations import Equations
from taylor_verify.judge.causes.fit import Family, Sizes, fault, linear
from taylor_verify.judge.causes.many_flows import Floats

_WRONG: Final = (("left out", 0.0), ("with the other sign", -1.0))
_OFTEN_WRONG: Final = (*_WRONG, ("twice", 2.0))
_DEGREE: Final = np.pi / 180
_PER_DEGREE: Final = (
    ("of omega in degrees", 1 / _DEGREE),
    ("of omega in radians for degrees", _DEGREE),
)


def faults_of_terms(right: Equations) -> Iterator[Family]:
    """Yield terms left out, of the other sign, or in other axes."""
    products = coriolis_of(right.mass)
    word = "gyroscopic term" if right.size == 3 else "Coriolis terms"
    for name, factor in ((f"no {word}", 0.0), (f"{word} with the other sign", -1.0)):
        extra = right.basis.factors(products=(factor - 1) * products)
        yield fault(name, "gyroscopic term", {"extra": extra, "rotor": factor * right.rotor})
    if np.any(right.rotor):
        yield from _faults_of_wheels(right)
    if right.has_loads:
        yield from _faults_of_loads(right)
    if right.damping:
        for words, factor in (*_WRONG, *_PER_DEGREE):
            yield fault(f"damping {words}", "damping", {"damping": factor * right.damping})
        drag = right.basis.factors(velocities=-float(right.damping) * np.eye(right.size))
        yield fault("damping of the velocity", "damping", {"damping": 0.0, "extra": drag})
    for name, rows in _coriolis_terms(right):
        for words, factor in _OFTEN_WRONG:
            extra = right.basis.factors(products=(factor - 1) * rows)
            title = f"no {name}" if not factor else f"{name} {words}"
            yield fault(title, "Coriolis terms", {"extra": extra})


def _faults_of_wheels(right: Equations) -> Iterator[Family]:
    alone = right.basis.factors(products=-coriolis_of(right.mass))
    yield fault("gyroscopic term of the wheels alone", "gyroscopic term", {"extra": alone})
    for words, factor in _WRONG:
        yield fault(f"wheels {words}", "wheels", {"rotor": factor * right.rotor})
    turning = crossed(right.rotor)
    for i, (words, factor) in product(np.flatnonzero(np.any(turning, axis=1)), _WRONG):
        rows = (factor - 1) * turning * np.eye(3)[i][:, None]
        title = f"gyroscopic term of the wheels {words} on axis {i + 1}"
        extra = {"extra": right.basis.factors(velocities=rows)}
        yield fault(title, "gyroscopic term", extra)
    for i, (words, factor) in product(np.flatnonzero(right.rotor), _WRONG):
        rotor = right.rotor * np.where(np.arange(3) == i, factor, 1.0)
        yield fault(f"wheel {i + 1} {words}", "wheels", {"rotor": rotor})


def _faults_of_loads(right: Equations) -> Iterator[Family]:
    n, names = right.size, load_names(right.size)
    weighted, unit = right.basis.factors, np.eye(n)
    noun = "moment" if n == 3 else "loads"
    for words, factor in _OFTEN_WRONG:
        yield fault(f"{noun} {words}", "load", {"extra": weighted(loads=(factor - 1) * unit)})
    turned = weighted(loads=-unit, turned_loads=unit)
    yield fault(f"{noun} in space axes", "load", {"extra": turned})
    if right.acting is None:
        by_R = np.vstack([np.kron(np.eye(3), vector) for vector in right.load.reshape(-1, 3)])
        changes = {"extra": weighted(loads=-unit, frame=by_R)}
        yield fault(f"{noun} turned the wrong way, by R", "load", changes)
    some = [("force", np.r_[1, 1, 1, 0, 0, 0]), ("couple", np.r_[0, 0, 0, 1, 1, 1])] * (n == 6)
    for (name, part), (words, factor) in product([*some, *zip(names, unit, strict=True)], _WRONG):
        yield fault(
            f"{name} {words}", "load", {"extra": weighted(loads=(factor - 1) * np.diag(part))}
        )
    if n == 3:
        undivided = weighted(loads=right.mass - unit)
        yield fault("moment not divided by the inertia", "load", {"extra": undivided})
    for first, order in product(range(0, n, 3), [*permutations(range(3))][1:]):
        places = np.arange(n)
        places[first : first + 3] = first + np.array(order)
        title = f"components of the {names[first].split()[0]} exchanged"
        yield fault(title, "load", {"extra": weighted(loads=unit[places] - unit)})


def _coriolis_terms(right: Equations) -> Iterator[tuple[str, Floats]]:
    """Yield the terms of the Coriolis terms in a fluid, each with its factors of the products."""
    if right.size == 6:
        gyro, turn, none = right.mass[3:], right.mass[:3], 0 * right.mass[:3]
        yield "Munk moment", coriolis(none, none, turn)
        if np.any(turn[:, 3:]):
            masses = np.hstack([turn[:, :3], none[:, :3]])
            yield "Munk moment of the masses", coriolis(none, none, masses)
        yield "term x x W", coriolis(none, turn)
        yield "term y x W", coriolis(gyro)
        yield "couple y x W + x x U", coriolis(gyro, none, turn)


def load_names(n: int) -> list[str]:
    """Return the names of the components of the loads."""
    nouns = ("moment",) if n == 3 else ("force", "couple")
    return [f"{noun} {i}" for noun in nouns for i in (1, 2, 3)]


def families_of_terms(right: Equations, sizes: Sizes) -> Iterator[Family]:
    """Yield the families of terms: clock, gyroscopic term, wheels, loads, drag and damping."""
    n = right.size
    family, factors = partial(linear, right), right.basis.factors
    yield family("clock", "clock", 1.0, [1], clock=[1])
    word = "gyroscopic term" if n == 3 else "Coriolis terms"
    title, extra = f"factor of the {word}", [factors(products=coriolis_of(right.mass))]
    yield family(title, "gyroscopic term", 1.0, [1], extra=extra, rotor=[right.rotor])
    if n == 3:
        yield from _wheels(right, sizes)
    if right.has_loads:
        title = f"factor of the {'moment' if n == 3 else 'loads'}"
        yield family(title, "load", 1.0, [1], extra=[factors(loads=np.eye(n))])
    if right.acting is not None:
        yield loads_late(right, sizes)
    yield from _loads(right, sizes)
    yield family("damping", "damping", sizes.pace, [right.damping], damping=[1])
    yield from _drags(right, sizes)
    for name, rows in _coriolis_terms(right):
        extra = [factors(products=rows)]
        yield family(f"factor of the {name}", "Coriolis terms", 1.0, [1], extra=extra)


def loads_late(right: Equations, sizes: Sizes) -> Family:
    """Return the family of loads that are those of another time."""
    return linear(right, "loads late", "load", 0.1 / sizes.pace, late=[1])


def _wheels(right: Equations, sizes: Sizes) -> Iterator[Family]:
    """Yield other wheels; a scene without them may lack some."""
    unit, size = np.eye(3), float(np.linalg.norm(right.rotor))
    if size:
        yield linear(right, "factor of the wheels", "wheels", 1.0, [1], rotor=right.rotor[None])
        title, products = "factor of the tensor in the gyroscopic term", coriolis_of(right.mass)
        extra = [right.basis.factors(products=products)]
        yield linear(right, title, "gyroscopic term", 1.0, [1], extra=extra)
    size = size or float(np.max(sizes.load)) / sizes.pace
    for i in range(3):
        name = f"wheel {i + 1}"
        yield linear(right, name, "wheels", size, right.rotor[[i]], rotor=unit[[i]])
    yield linear(right, "wheels", "wheels", size, right.rotor, rotor=unit)


def _loads(right: Equations, sizes: Sizes) -> Iterator[Family]:
    n, names, unit = right.size, load_names(right.size), np.eye(right.size)
    in_body = [right.basis.factors(constants=row[:, None]) for row in unit]
    in_space = [right.basis.factors(frame=_of_space(n, i)) for i in range(n)]
    for axes, kind, own, along in (
        ("body axes", "load", right.load, in_body),
        ("space axes", "load in space axes", 0 * right.load, in_space),
    ):
        for places in _single_and_vectors(n):
            noun = (
                names[places[0]] + "," if len(places) == 1 else names[places[0]].split()[0] + " in"
            )
            title = f"{noun} {axes}"
            extra = [along[i] for i in places]
            yield linear(right, title, kind, sizes.load[places], own[places], extra=extra)
    if n == 6:
        name = "force and couple in body axes"
        yield linear(right, name, "load", sizes.load, right.load, extra=in_body)
    name, arms = "couple r x R^T e3 (weight and buoyancy)", [_of_arm(n, axis) for axis in np.eye(3)]
    for title, axes_ in ((f"{name}, r along axis 3", [2]), (name, [0, 1, 2])):
        extra = [right.basis.factors(frame=arms[i]) for i in axes_]
        yield linear(right, title, "restoring couple", sizes.load[-3:][axes_], extra=extra)


def _single_and_vectors(n: int) -> list[list[int]]:
    """Return the places of each component, and then of each vector."""
    return [[i] for i in range(n)] + [[i, i + 1, i + 2] for i in range(0, n, 3)]


def _of_space(n: int, i: int) -> Floats:
    """Return the factors of r11 ... r33 in R^T e for the unit load e of component i, space axes."""
    rows, k = np.zeros((n, 9)), i % 3
    rows[i - k : i - k + 3, 3 * k : 3 * k + 3] = np.eye(3)
    return rows


def _of_arm(n: int, axis: Floats) -> Floats:
    """Return the factors of r11 ... r33 in the couple axis x R^T e3."""
    rows = np.zeros((n, 9))
    rows[-3:, 6:] = np.cross(np.eye(3), axis)
    return rows


def _drags(right: Equations, sizes: Sizes) -> Iterator[Family]:
    n, names, factors = right.size, load_names(right.size), right.basis.factors
    turns = np.diag(np.r_[np.zeros(n - 3), np.ones(3)])
    least = sizes.pace * np.min(sizes.inertia[-3:]) ** 2
    name = "one drag on all rates of turn"
    yield linear(right, name, "linear drag", least, extra=[factors(velocities=-turns)])
    for first in range(0, n, 3):
        places = [first, first + 1, first + 2]
        drag, letter = np.diag(np.isin(range(n), places) * 1.0), "w" if first == n - 3 else "u"
        title = f"{names[first].split()[0]} -k |{letter}| {letter}, with k"
        size = float(np.max(sizes.load[places]) / np.max(sizes.nu[places]) ** 2)
        yield linear(right, title, "drag by the speed", size, extra=[factors(speeds=-drag)])
    for field, power in (("linear", 1), ("quadratic", 2)):
        scale, kind = sizes.load / sizes.nu**power, f"{field} drag"
        group = "velocities" if power == 1 else "squares"
        along = [factors(**{group: -np.diag(row)}) for row in np.eye(n)]
        for places in [*_single_and_vectors(n), *[list(range(6))] * (n == 6)]:
            of_vector = f"{kind}, {names[places[0]].split()[0]}" if len(places) == 3 else kind
            title = f"{kind} on axis {places[0] + 1}" if len(places) == 1 else of_vector
            extra = [along[i] for i in places]
            yield linear(right, title, kind, scale[places], extra=extra)
