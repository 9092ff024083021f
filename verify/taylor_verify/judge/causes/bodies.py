"""Families and faults of another body: tensors and mass matrices, whole or in the Coriolis terms alone."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import combinations, permutations
from typing import Any, Final, NamedTuple

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


def _misread_tensors(right: Equations) -> Iterator[tuple[str, Any]]:
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


def _misread_masses(right: Equations) -> Iterator[tuple[str, Any]]:
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


# Families.


def families_of_bodies(right: Equations, sizes: Sizes) -> Iterator[Family]:
    """Yield the families of mass matrices: a factor, entries, diagonals, another centre of mass, all."""
    n, mass = right.size, right.mass
    if not is_up_to_a_factor(right):
        one = np.ones(1)
        name = "factor of the inertia" if n == 3 else "factor of the mass matrix"
        yield Family(name, "body", one, one, lambda p: of_body(p[0] * mass))
    scale = np.outer(sizes.inertia, sizes.inertia)
    upper = [(i, k) for i in range(n) for k in range(i, n)]
    for place in upper:
        if n == 3 or place[0] == place[1] or mass[place]:
            yield from _both(_label(n, *place), mass, _of_entries(mass, scale, [place]))
    # A free motion does not show a common factor.
    lacks = 1 if is_up_to_a_factor(right) and not right.damping else 0
    diagonal = [(i, i) for i in range(n)]
    if n == 3:
        numbers = _of_entries(mass, scale, diagonal[: 3 - lacks])
        yield _of_mass("moments of inertia", "body", mass, numbers, of_body)
        numbers = _of_entries(mass, scale, upper[: 6 - lacks])
        yield _of_mass("inertia tensor", "body", mass, numbers, of_body)
        for name, places in (("moments of inertia", diagonal), ("tensor", upper)):
            numbers, title = (
                _of_entries(mass, scale, places),
                f"{name} in the gyroscopic term alone",
            )
            yield _of_mass(title, "Coriolis matrix", mass, numbers, of_coriolis)
        yield Family(
            "another centre of mass: I + m (c.c 1 - c c^T), with c sqrt(m)",
            "body",
            np.zeros(3),
            np.full(3, sizes.inertia[2]),
            lambda p: of_body(mass + p @ p * np.eye(3) - np.outer(p, p)),
        )
        return
    masses, moments = (_of_entries(mass, scale, places) for places in (diagonal[:3], diagonal[3:]))
    arm = _of_arm(mass, scale[0, 3])
    for name, numbers in (
        ("three masses", masses),
        ("three moments of inertia", moments),
        ("six diagonal masses", masses + moments),
        ("coupling by the centre of mass (m r)", arm),
        ("another centre of mass (m r and three moments of inertia)", arm + moments),
        ("masses, m r and moments of inertia", masses + arm + moments),
    ):
        yield from _both(name, mass, numbers)
    name = "three masses in the Munk moment alone"
    yield _of_mass(name, "Coriolis matrix", mass, masses, lambda other: {"munk": other[:3]})
    numbers = _of_entries(mass, scale, upper[: 21 - lacks])
    yield _of_mass("mass matrix", "body", mass, numbers, of_body)
    numbers = _of_entries(mass, scale, upper)
    name = "mass matrix of the Coriolis terms alone"
    yield _of_mass(name, "Coriolis matrix", mass, numbers, of_coriolis)


class _Number(NamedTuple):
    """A number of a mass matrix: its label, value and scale, and the matrix that it multiplies."""

    label: str
    value: float
    scale: float
    along: Floats


def _both(name: str, mass: Floats, numbers: list[_Number]) -> Iterator[Family]:
    """Yield the family of another body, and that of other Coriolis terms alone."""
    term = "gyroscopic term" if len(mass) == 3 else "Coriolis terms"
    yield _of_mass(name, "body", mass, numbers, of_body)
    yield _of_mass(f"{name} in the {term} alone", "Coriolis matrix", mass, numbers, of_coriolis)


def _of_mass(name: str, kind: str, mass: Floats, numbers: list[_Number], put: _Put) -> Family:
    right = np.array([number.value for number in numbers])
    along = np.array([number.along for number in numbers])
    scale = np.array([number.scale for number in numbers])

    def changes(p: Floats) -> Changes:
        return put(mass + np.tensordot(p - right, along, axes=1))

    return Family(name, kind, right, scale, changes, tuple(number.label for number in numbers))


def _label(n: int, i: int, k: int) -> str:
    return f"{'I' if n == 3 else 'M'}_{i + 1}{k + 1}"


def _of_entries(mass: Floats, scale: Floats, places: list[tuple[int, int]]) -> list[_Number]:
    numbers = []
    for i, k in places:
        along = np.zeros_like(mass)
        along[i, k] = along[k, i] = 1.0
        numbers.append(_Number(_label(len(mass), i, k), mass[i, k], scale[i, k], along))
    return numbers


def _of_arm(mass: Floats, scale: float) -> list[_Number]:
    """Return m r, the antisymmetric part of the coupling."""
    numbers = []
    for i, axis in enumerate(np.eye(3)):
        along, cross = np.zeros((6, 6)), np.cross(np.eye(3), axis)
        along[3:, :3], along[:3, 3:] = cross, cross.T
        value = float(np.sum(along * mass)) / 4
        numbers.append(_Number(f"m r_{i + 1}", value, scale, along))
    return numbers


def is_up_to_a_factor(right: Equations) -> bool:
    """Return True if a motion does not show a common factor of the mass matrix."""
    loads = right.acting is not None or np.any(right.load) or np.any(right.rotor)
    return not (loads or right.has_momenta)


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
