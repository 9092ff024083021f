"""Families and faults of another body: tensors and mass matrices, whole or in the Coriolis terms alone."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import combinations, permutations
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.equations import Changes, Equations
from taylor_verify.judge.causes.fault import Fault, Sizes, of_body, of_coriolis
from taylor_verify.judge.causes.fit import Family
from taylor_verify.judge.causes.flow import Floats

_Put = Callable[[Floats], Changes]
_SAME: Final = 1e-9
# Entries whose ratios differ by less than this are unchanged together.
_UNCHANGED: Final = 1e-3
_NEAR: Final = 1e-6
_ARM: Final = ("m r_1", "m r_2", "m r_3")
_DIAGONAL: Final = tuple(f"M_{i}{i}" for i in range(1, 7))


def faults_of_bodies(right: Equations) -> Iterator[Fault]:
    """Yield bodies that result from misreading the scene's, each once."""
    known = [right.mass]
    misread = _misread_tensors(right) if right.size == 3 else _misread_masses(right)
    for name, mass in misread:
        size = _SAME * np.max(np.abs(right.mass))
        is_new = all(np.max(np.abs(mass - other)) > size for other in known)
        if is_new and np.all(np.linalg.eigvalsh(mass) > 0):
            known.append(mass)
            yield Fault(name, "body", of_body(mass))
    if right.size == 6:
        yield from _coupling_in_one(right.mass)


def _misread_tensors(right: Equations) -> Iterator[tuple[str, Floats]]:
    inertia, inverse = right.mass, right.inverse
    diagonal = np.diag(np.diag(inertia))
    yield "products of inertia left out", diagonal
    yield "products of inertia with the other sign", 2 * diagonal - inertia
    for i, k in combinations(range(3), 2):
        for words, factor in (("with the other sign", -1.0), ("left out", 0.0)):
            other = inertia.copy()
            other[i, k] = other[k, i] = factor * inertia[i, k]
            yield f"I_{i + 1}{k + 1} {words}", other
    yield "products of the inverse tensor left out", np.diag(1 / np.diag(inverse))
    is_free = not np.any(right.rotor) and not np.any(right.load) and right.acting is None
    scale = np.cbrt(np.linalg.det(inertia)) ** 2 if is_free else 1.0
    yield "inverse of the tensor used for the tensor", scale * inverse
    for order in permutations(range(3)):
        listed = " ".join(str(i + 1) for i in order)
        yield f"moments of inertia in another order ({listed})", inertia[np.ix_(order, order)]
    moments, axes = np.linalg.eigh(inertia)
    for order in permutations(range(3)):
        yield "principal axes dropped", np.diag(moments[list(order)])
    for order in permutations(range(3)):
        for signs in ((1, 1, 1), (1, 1, -1), (1, -1, 1), (-1, 1, 1)):
            turned = axes[:, list(order)] * np.array(signs)
            back = turned.T @ np.diag(moments[list(order)]) @ turned
            yield "principal axes turned the wrong way", back
    yield "tensor of a sphere", np.eye(3) * np.trace(inertia) / 3
    yield "inertia in float32", inertia.astype(np.float32).astype(float)


def _misread_masses(right: Equations) -> Iterator[tuple[str, Floats]]:
    mass, energy = right.mass, right.inverse
    for words, factor in (("left out", 0.0), ("with the other sign", -1.0)):
        yield f"coupling B of the energy {words}", np.linalg.inv(_coupled(energy, factor))
    swapped = energy.copy()
    swapped[:3, 3:], swapped[3:, :3] = energy[3:, :3], energy[:3, 3:]
    yield "coupling B of the energy transposed", np.linalg.inv(swapped)
    yield "off-diagonal masses left out", np.diag(np.diag(mass))
    yield "coupling left out", _coupled(mass, 0.0)
    yield "coupling with the other sign", _coupled(mass, -1.0)
    yield "inverse masses cut to their diagonal", np.diag(1 / np.diag(right.inverse))


def _coupled(mass: Floats, factor: float) -> Floats:
    other = mass.copy()
    other[:3, 3:] *= factor
    other[3:, :3] *= factor
    return other


def _coupling_in_one(mass: Floats) -> Iterator[Fault]:
    if not np.any(mass[:3, 3:]):
        return
    uncoupled = _coupled(mass, 0.0)
    name = "coupling (centre of mass) in the mass matrix and not in the Coriolis terms"
    yield Fault(name, "Coriolis matrix", of_coriolis(uncoupled))
    name = "coupling (centre of mass) in the Coriolis terms and not in the mass matrix"
    yield Fault(name, "Coriolis matrix", {"mass": uncoupled})


def faults_of_added_mass(mass: Floats, added: Floats) -> Iterator[Fault]:
    """Yield faults of the Coriolis terms of the added mass, which is a part of the mass matrix."""
    for words, factor in (("missing", 0.0), ("with the other sign", -1.0), ("twice", 2.0)):
        changes = of_coriolis(mass - added + factor * added)
        yield Fault(f"Coriolis terms of the added mass {words}", "Coriolis matrix", changes)
        other = mass - added + factor * added
        if np.all(np.linalg.eigvalsh(other) > 0):
            yield Fault(f"added mass {words}", "body", of_body(other))
    name = "Coriolis terms of the rigid body missing"
    yield Fault(name, "Coriolis matrix", of_coriolis(added))
    rows = (mass - added)[:3]
    yield Fault("Munk moment of the added mass missing", "Coriolis matrix", {"munk": rows})


# Families.


def families_of_bodies(right: Equations, sizes: Sizes) -> Iterator[Family]:
    """Yield the families of mass matrices, one number first."""
    yield from _factor_of_inertia(right)
    yield from _entries(right, sizes)
    yield from _tensors(right, sizes) if right.size == 3 else _masses(right, sizes)


def is_up_to_a_factor(right: Equations) -> bool:
    """Return True if a motion does not show a common factor of the mass matrix."""
    loads = right.acting is not None or np.any(right.load) or np.any(right.rotor)
    return not (loads or right.has_momenta)


def _factor_of_inertia(right: Equations) -> Iterator[Family]:
    if is_up_to_a_factor(right):
        return
    one = np.ones(1)
    name = "factor of the inertia" if right.size == 3 else "factor of the mass matrix"
    yield Family(name, "body", one, one, lambda p: of_body(p[0] * right.mass))


def _entries(right: Equations, sizes: Sizes) -> Iterator[Family]:
    n, mass = right.size, right.mass
    for i, k in zip(*np.triu_indices(n), strict=True):
        if n == 6 and i != k and not mass[i, k]:
            continue
        unit = np.zeros((n, n))
        unit[i, k] = unit[k, i] = 1.0
        scale = np.array([sizes.inertia[i] * sizes.inertia[k]])
        name = f"I_{i + 1}{k + 1}" if n == 3 else f"M_{i + 1}{k + 1}"
        for kind, words, put in (
            ("body", name, of_body),
            ("Coriolis matrix", f"{name} in the {_term(n)} alone", of_coriolis),
        ):
            yield Family(
                words,
                kind,
                mass[[i], [k]],
                scale,
                lambda p, put=put, unit=unit, i=i, k=k: put(mass + (p[0] - mass[i, k]) * unit),
                (name,),
            )


def _term(n: int) -> str:
    return "gyroscopic term" if n == 3 else "Coriolis terms"


def _tensors(right: Equations, sizes: Sizes) -> Iterator[Family]:
    inertia, scale = right.mass, np.outer(sizes.inertia, sizes.inertia)
    lacks = 1 if is_up_to_a_factor(right) and not right.damping else 0
    moments = [(0, 0), (1, 1), (2, 2)][: 3 - lacks]
    upper = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)][: 6 - lacks]
    for places, name in ((moments, "moments of inertia"), (upper, "inertia tensor")):
        yield _symmetric(name, "body", inertia, scale, places, of_body)
    for places, name in (
        ([(0, 0), (1, 1), (2, 2)], "moments of inertia in the gyroscopic term alone"),
        ([(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)], "tensor in the gyroscopic term alone"),
    ):
        yield _symmetric(name, "Coriolis matrix", inertia, scale, places, of_coriolis)
    yield Family(
        "another centre of mass: I + m (c.c 1 - c c^T), with c sqrt(m)",
        "body",
        np.zeros(3),
        np.full(3, sizes.inertia[2]),
        lambda p: of_body(inertia + p @ p * np.eye(3) - np.outer(p, p)),
    )


def _symmetric(
    name: str, kind: str, mass: Floats, scale: Floats, places: list[tuple[int, int]], put: _Put
) -> Family:
    rows, columns = np.transpose(places)

    def changes(p: Floats) -> Changes:
        other = mass.copy()
        other[rows, columns] = other[columns, rows] = p
        return put(other)

    letter = "I" if len(mass) == 3 else "M"
    labels = tuple(f"{letter}_{i + 1}{k + 1}" for i, k in places)
    return Family(name, kind, mass[rows, columns], scale[rows, columns], changes, labels)


def _masses(right: Equations, sizes: Sizes) -> Iterator[Family]:
    mass, scale = right.mass, np.outer(sizes.inertia, sizes.inertia)
    lacks = 1 if is_up_to_a_factor(right) and not right.damping else 0
    three, moments = [(i, i) for i in range(3)], [(i, i) for i in range(3, 6)]
    upper = list(zip(*(index.tolist() for index in np.triu_indices(6)), strict=True))
    for name, places in (
        ("three masses", three),
        ("three moments of inertia", moments),
        ("six diagonal masses", three + moments),
    ):
        yield _symmetric(name, "body", mass, scale, places, of_body)
        words = f"{name} in the Coriolis terms alone"
        yield _symmetric(words, "Coriolis matrix", mass, scale, places, of_coriolis)
    arm, unit = _arm(mass), np.full(3, scale[0, 3])
    for name, kind, put in (
        ("", "body", of_body),
        (" in the Coriolis terms alone", "Coriolis matrix", of_coriolis),
    ):
        yield Family(
            f"coupling by the centre of mass (m r){name}",
            kind,
            arm,
            unit,
            lambda p, put=put: put(_with_arm(mass, p)),
            _ARM,
        )
        yield Family(
            f"another centre of mass (m r and three moments of inertia){name}",
            kind,
            np.concatenate([arm, np.diag(mass)[3:]]),
            np.concatenate([unit, np.diag(mass)[3:]]),
            lambda p, put=put: put(_with_diagonal(_with_arm(mass, p[:3]), slice(3, 6), p[3:])),
            (*_ARM, *_DIAGONAL[3:]),
        )
        yield Family(
            f"masses, m r and moments of inertia{name}",
            kind,
            np.concatenate([np.diag(mass)[:3], arm, np.diag(mass)[3:]]),
            np.concatenate([np.diag(mass)[:3], unit, np.diag(mass)[3:]]),
            lambda p, put=put: put(
                _with_diagonal(_with_arm(mass, p[3:6]), slice(0, 6), np.r_[p[:3], p[6:]])
            ),
            (*_DIAGONAL[:3], *_ARM, *_DIAGONAL[3:]),
        )
    yield Family(
        "three masses in the Munk moment alone",
        "Coriolis matrix",
        np.diag(mass)[:3],
        np.diag(mass)[:3],
        lambda p: {"munk": _with_diagonal(mass, slice(0, 3), p)[:3]},
        _DIAGONAL[:3],
    )
    yield _symmetric("mass matrix", "body", mass, scale, upper[: 21 - lacks], of_body)
    name = "mass matrix of the Coriolis terms alone"
    yield _symmetric(name, "Coriolis matrix", mass, scale, upper, of_coriolis)


def _arm(mass: Floats) -> Floats:
    """Return m r, the antisymmetric part of the coupling."""
    block = mass[3:, :3]
    return (
        np.array([block[2, 1] - block[1, 2], block[0, 2] - block[2, 0], block[1, 0] - block[0, 1]])
        / 2
    )


def _with_arm(mass: Floats, arm: Floats) -> Floats:
    other, change = mass.copy(), np.cross(np.eye(3), arm - _arm(mass))
    other[3:, :3] += change
    other[:3, 3:] += change.T
    return other


def _with_diagonal(mass: Floats, part: slice, values: Any) -> Floats:
    other, places = mass.copy(), range(6)[part]
    other[places, places] = values
    return other


# Words for a body that was fitted.


def nearest_factor(right: Equations, mass: Floats) -> Floats:
    """Return a mass matrix, known up to a factor, with the factor that leaves most entries unchanged."""
    if not is_up_to_a_factor(right):
        return mass
    own, upper = right.mass, np.triu_indices(right.size)
    is_seen = np.abs(own[upper]) > _SAME * np.max(np.abs(own))
    ratios = mass[upper][is_seen] / own[upper][is_seen]
    ratios = np.sort(ratios[ratios > _NEAR])
    unchanged = [np.count_nonzero(np.abs(ratios / ratio - 1) < _UNCHANGED) for ratio in ratios]
    return mass / ratios[int(np.argmax(unchanged))] if len(ratios) else mass


def entries(right: Floats, mass: Floats) -> tuple[tuple[str, ...], Floats, Floats]:
    """Return the labels of the entries that one of two mass matrices has, and both of their values."""
    letter, size = "I" if len(mass) == 3 else "M", _SAME * np.max(np.abs(right))
    places = [
        (i, k)
        for i, k in zip(*np.triu_indices(len(mass)), strict=True)
        if max(abs(right[i, k]), abs(mass[i, k])) > size
    ]
    rows, columns = np.transpose(places)
    labels = tuple(f"{letter}_{i + 1}{k + 1}" for i, k in places)
    return labels, right[rows, columns], mass[rows, columns]


def structure(right: Floats, changes: Changes) -> str:
    """Return in words how the masses of the Coriolis terms follow from the body's; empty if they do not.

    With an added mass A = M - m 1 that enters f times, they are m + f A: a straight line.
    """
    if len(right) == 3 or "mass" in changes or "turn" not in changes:
        return ""
    own, other = np.diag(right)[:3], np.diag(changes["turn"])
    if np.ptp(own) < _SAME * np.max(own):
        return ""
    (factor, offset), _rest, *_ = np.polyfit(own, other, 1, full=True)
    if np.any(np.abs(other - factor * own - offset) > _NEAR * np.max(own)):
        return ""
    nice = {0.0: "lack the added mass", 2.0: "have the added mass twice"}
    nice |= {-1.0: "have the added mass with the other sign", 1.0: "lack the rigid body"}
    near = [words for value, words in nice.items() if abs(factor - value) < _NEAR]
    of_body = offset / (1 - factor) if abs(factor - 1) > _NEAR else -offset
    if not near or not 0 < of_body <= np.min(own) * (1 + _NEAR):
        return ""
    return f"the Coriolis terms {near[0]} (a rigid body of mass {of_body:.6g})"
