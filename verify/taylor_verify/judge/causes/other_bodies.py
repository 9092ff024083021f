"""Families and faults of another body: tensors and mass matrices, whole or in the Coriolis terms alone."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from itertools import combinations, permutations
from typing import Any, Final, NamedTuple

import numpy as np

from taylor_verify.judge.causes.basis import coriolis, coriolis_of
from taylor_verify.judge.causes.changed_equations import Changes, Equations
from taylor_verify.judge.causes.fit import Family, Sizes, fault, linear
from taylor_verify.judge.causes.float_answer import Answer
from taylor_verify.judge.causes.hung_loads import hung_at_centre
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.terms import load_names

AND_REST: Final = "of a rigid body, and a factor of the rest"
_REST: Final = "factor of the rest"
_KIND: Final = "Coriolis matrix"
# Another centre of mass is a factor of its place.
_OF_CENTRE: Final = {"centre of mass at the origin": 0, "centre of mass on the other side": -1}
_ADDED: Final = (("left out", 0.0), ("with the other sign", -1.0), ("twice", 2.0))


def faults_of_bodies(right: Equations) -> Iterator[Family]:
    """Yield bodies that result from misreading the scene's, whole and in one of the two matrices alone."""
    misread = _misread_tensors(right) if right.size == 3 else _misread_masses(right)
    bodies = [right.mass]
    for name, mass in misread:
        if any(np.array_equal(mass, body) for body in bodies):
            continue
        bodies.append(mass)
        extra = right.basis.factors(products=coriolis_of(mass - right.mass))
        is_body = np.all(np.linalg.eigvalsh(mass) > 0)
        if is_body:
            yield fault(name, "body", {"mass": mass})
            factor = _OF_CENTRE.get(name)
            loads = None if factor is None else hung_at_centre(right.loads, _centre(right), factor)
            if loads is not None and right.acting is not None:
                changes = {"mass": mass, "acting": right.acting.of(loads)}
                yield fault(f"{name}, in the weight too", "body", changes)
        # Wrong axes are wrong in both.
        if not (name.startswith("principal axes") or np.allclose(coriolis_of(mass), 0.0)):
            yield fault(f"{name} in the {_term(right)} alone", "Coriolis matrix", {"extra": extra})
        if is_body and (right.size == 6 or name.startswith(("products", "I_"))):
            changes = {"mass": mass, "extra": -extra}
            where = "mass matrix" if right.size == 6 else "tensor that divides"
            yield fault(f"{name} in the {where} alone", "Coriolis matrix", changes)


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
    is_free = not np.any(right.rotor) and not right.has_loads
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
    if right.added is not None:
        yield from _misread_parts(mass, right.added)
    for words, factor in (("left out", 0.0), ("with the other sign", -1.0)):
        yield f"coupling B of the energy {words}", np.linalg.inv(_coupled(energy, factor))
    swapped = energy.copy()
    swapped[:3, 3:], swapped[3:, :3] = energy[3:, :3], energy[:3, 3:]
    yield "coupling B of the energy transposed", np.linalg.inv(swapped)
    yield "off-diagonal masses left out", np.diag(np.diag(mass))
    yield "coupling left out", _coupled(mass, 0.0)
    yield "coupling with the other sign", _coupled(mass, -1.0)
    yield "inverse masses cut to their diagonal", np.diag(1 / np.diag(right.inverse))
    if right.energy is not None:
        yield "energy in float32", np.linalg.inv(energy.astype(np.float32).astype(float))
    yield "mass matrix in float32", mass.astype(np.float32).astype(float)


def _misread_parts(mass: Floats, added: Floats) -> Iterator[tuple[str, Any]]:
    """Yield misread mass matrices of a rigid body and the added mass that the scene has apart."""
    for words, factor in _ADDED:
        yield f"added mass {words}", mass + (factor - 1) * added
    diagonal = np.diag(np.diag(added))
    if np.any(added != diagonal):
        yield "added mass cut to its diagonal", mass - added + diagonal
    yield "rigid body left out", added
    rigid = mass - added
    arm, central = rigid[3:, :3] / rigid[0, 0], rigid.copy()
    central[3:, 3:] += rigid[0, 0] * arm @ arm
    yield "centre of mass at the origin", _coupled(central, 0.0) + added
    yield "centre of mass on the other side", _coupled(rigid, -1.0) + added
    yield "inertia about the centre of mass taken for that about the origin", central + added


def _coupled(mass: Floats, factor: float) -> Floats:
    other = mass.copy()
    other[:3, 3:] *= factor
    other[3:, :3] *= factor
    return other


# C_A is the Coriolis matrix of Fossen (Handbook of Marine Craft Hydrodynamics, 2nd ed., 6.3.1): the terms
# of A are -C_A(nu) nu, with the blocks [[0, -S(p)], [-S(p), -S(l)]] of (p, l) = A nu.


# Families.


def families_of_bodies(answer: Answer, sizes: Sizes) -> Iterator[Family]:
    """Yield the families of mass matrices: a factor, entries, diagonals, another centre of mass, all."""
    right = answer.right
    n, mass = right.size, right.mass
    if not answer.is_up_to_a_factor:
        noun = "inertia" if n == 3 else "mass matrix"
        yield linear(right, f"factor of the {noun}", "body", 1.0, [1], mass=mass[None])
    scale = np.outer(sizes.inertia, sizes.inertia)
    upper = [(i, k) for i in range(n) for k in range(i, n)]
    diagonal = [(i, i) for i in range(n)]
    for i, k in upper:
        if n == 3 or i == k or mass[i, k]:
            yield from _each(right, _label(n, i, k), _of_entries(mass, scale, [(i, k)]))
    # A free motion does not show a common factor.
    lacks = 1 if answer.is_up_to_a_factor and not right.damping else 0
    if n == 3:
        for of_body, of_term, places in (
            ("moments of inertia", "moments of inertia", diagonal),
            ("inertia tensor", "tensor", upper),
        ):
            numbers = _of_entries(mass, scale, places)
            yield _of_body(right, of_body, numbers[: len(numbers) - lacks])
            yield _of_coriolis(right, f"{of_term} in the gyroscopic term alone", numbers)
        name = "another centre of mass: I + m (c.c 1 - c c^T), with c sqrt(m)"
        zeros, sizes_ = np.zeros(3), np.full(3, sizes.inertia[2])
        yield Family(name, "body", zeros, sizes_, partial(_with_another_centre, mass))
        return
    masses, moments = (_of_entries(mass, scale, places) for places in (diagonal[:3], diagonal[3:]))
    arm, entries = _of_arm(mass, scale[0, 3]), _of_entries(mass, scale, upper)
    if right.added is not None:
        yield from _of_parts(right, right.added)
    for name, numbers in (
        ("three masses", masses),
        ("three moments of inertia", moments),
        ("six diagonal masses", masses + moments),
        ("coupling by the centre of mass (m r)", arm),
        ("another centre of mass (m r and three moments of inertia)", arm + moments),
        ("masses, m r and moments of inertia", masses + arm + moments),
    ):
        yield from _each(right, name, numbers)
    yield _of_mass_alone(right, "coupling by the centre of mass (m r)", arm)
    munk = [coriolis(0 * mass[:3], munk=number.along[:3]) for number in masses]
    yield _of_coriolis(right, "three masses in the Munk moment alone", masses, munk)
    yield from _rigid_alone(right, scale)
    yield _of_body(right, "mass matrix", entries[: len(entries) - lacks])
    yield _of_coriolis(right, "mass matrix of the Coriolis terms alone", entries)
    yield from _single_terms(right)


def _rigid_alone(right: Equations, scale: Floats) -> Iterator[Family]:
    """Yield the terms of a rigid body, and a factor of all that is none in the mass matrix.

    They are all Coriolis terms, of which the moments of inertia are known up to a common number, or the
    Munk moment.
    """
    mass, masses = right.mass, np.diag([1.0, 1, 1, 0, 0, 0])
    heavy = _Number("mass", float(np.trace(mass[:3, :3])) / 3, scale[0, 0], masses)
    lower = [(i, k) for i in (3, 4, 5) for k in range(i, 6)]
    arm, inertia = _of_arm(mass, scale[0, 3]), _of_entries(mass, scale, lower)
    rest = mass - sum(number.value * number.along for number in (heavy, *arm, *inertia))
    factor = _Number(_REST, 1.0, 1.0, rest)
    yield _of_coriolis(right, f"Coriolis terms {AND_REST}", [factor, heavy, *arm, *inertia])
    munk = [coriolis(0 * mass[:3], munk=number.along[:3]) for number in (factor, *arm)]
    yield _of_coriolis(right, f"Munk moment {AND_REST}", [factor, *arm], munk)


def _single_terms(right: Equations) -> Iterator[Family]:
    """Yield the terms that a diagonal mass matrix has in the Coriolis terms: one alone, and all."""
    own, zeros, pairs = coriolis_of(right.mass), np.zeros_like, right.basis.pairs
    scale, names = float(np.max(np.abs(right.mass))), load_names(6)
    labels, along, values = list[str](), list[Floats](), list[float]()
    for i, column in np.argwhere(coriolis_of(np.diag([1.0, 2, 3, 4, 5, 6]))):
        unit = zeros(own)
        unit[i, column] = 1.0
        text = right.basis.texts[right.basis.groups["products"]][column]
        labels.append(f"{text} in {names[i]} ({_entries_with(i, pairs[column])})")
        along.append(right.basis.factors(products=unit))
        values.append(float(own[i, column]))
    kind, name = "Coriolis matrix", "single terms of the Coriolis matrix"
    for k, label in enumerate(labels):
        one = slice(k, k + 1)
        yield linear(right, label, kind, scale, values[one], (label,), extra=along[one])
    yield linear(right, name, kind, scale, values, tuple(labels), extra=along)


def _entries_with(i: int, pair: tuple[int, int]) -> str:
    """Return the entries of the Coriolis matrix that have a product in row i: one, or two alike."""
    columns = [k for k in pair if i > 2 or k > 2]
    return " or ".join(f"C_{i + 1}{k + 1}" for k in columns)


def _of_parts(right: Equations, added: Floats) -> Iterator[Family]:
    """Yield other values of the keys of a rigid body beside its added mass: mass, and centre of mass."""
    rigid = right.mass - added
    heavy, arm = float(rigid[0, 0]), _centre(right)
    size = np.sqrt(np.trace(rigid[3:, 3:]) / heavy)
    about_centre = rigid[3:, 3:] - _steiner(heavy, arm)

    def changes(p: Floats, places: list[int]) -> Changes:
        values = np.r_[heavy, arm]
        values[places] = p
        return {"mass": added + _rigid(values[0], about_centre, values[1:])}

    name = "factor of the added mass"
    yield linear(right, name, "part of the body", 1.0, [1], mass=added[None])
    values, scales = np.r_[heavy, arm], np.r_[heavy, size, size, size]
    names = ("mass", *(f"centre_of_mass {i}" for i in (1, 2, 3)))
    for name, places in (
        *((each, [k]) for k, each in enumerate(names)),
        ("centre_of_mass", [1, 2, 3]),
    ):
        labels = tuple(names[k] for k in places)
        own = partial(changes, places=places)
        yield Family(name, "part of the body", values[places], scales[places], own, labels)


def _centre(right: Equations) -> Floats:
    """Return the centre of mass of a scene that has its added mass apart."""
    assert right.added is not None
    rigid = right.mass - right.added
    return np.asarray(arm_of(rigid) / rigid[0, 0])


def arm_of(matrix: Floats) -> Floats:
    """Return r of a matrix whose lower left block is r x."""
    return np.array([matrix[5, 1], matrix[3, 2], matrix[4, 0]])


def _steiner(mass: float, arm: Floats) -> Floats:
    """Return m (r.r 1 - r r^T), what a tensor about another point has more."""
    return np.asarray(mass * (arm @ arm * np.eye(3) - np.outer(arm, arm)))


def _rigid(mass: float, about_centre: Floats, arm: Floats) -> Floats:
    """Return the mass matrix of a rigid body about a point from which its centre of mass is at ``arm``."""
    turn = mass * np.cross(arm, np.eye(3))
    return np.block([[mass * np.eye(3), turn], [turn.T, about_centre + _steiner(mass, arm)]])


def _with_another_centre(mass: Floats, p: Floats) -> Changes:
    return {"mass": mass + _steiner(1.0, p)}


class _Number(NamedTuple):
    """A number of a mass matrix: its label, value and scale, and the matrix that it multiplies."""

    label: str
    value: float
    scale: float
    along: Floats


def _each(right: Equations, name: str, numbers: list[_Number]) -> Iterator[Family]:
    """Yield the family of another body, and that of other Coriolis terms alone."""
    yield _of_body(right, name, numbers)
    yield _of_coriolis(right, f"{name} in the {_term(right)} alone", numbers)


def _term(right: Equations) -> str:
    return "gyroscopic term" if right.size == 3 else "Coriolis terms"


def _of_body(right: Equations, name: str, numbers: list[_Number]) -> Family:
    labels, values, scales, along = zip(*numbers, strict=True)
    return linear(right, name, "body", scales, values, labels, mass=along)


def _of_coriolis(
    right: Equations, name: str, numbers: list[_Number], products: list[Floats] | None = None
) -> Family:
    labels, values, scales, along = zip(*numbers, strict=True)
    own = products or [coriolis_of(each) for each in along]
    extra = [right.basis.factors(products=each) for each in own]
    return linear(right, name, "Coriolis matrix", scales, values, labels, extra=extra)


def _of_mass_alone(right: Equations, name: str, numbers: list[_Number]) -> Family:
    """Return the family of another mass matrix beside the right Coriolis terms."""
    labels, values, scales, along = zip(*numbers, strict=True)
    extra = [-right.basis.factors(products=coriolis_of(each)) for each in along]
    words = f"{name} in the mass matrix alone"
    return linear(right, words, _KIND, scales, values, labels, mass=along, extra=extra)


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
