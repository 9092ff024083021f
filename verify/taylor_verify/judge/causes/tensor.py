"""Hypotheses of another body: a tensor cut to its diagonal, with other axes, or slightly wrong."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import permutations, product
from typing import Final

import numpy as np

from taylor_verify.judge.causes.equations import Equations
from taylor_verify.judge.causes.fit import fitted
from taylor_verify.judge.causes.flow import Floats
from taylor_verify.judge.causes.material import Candidate, Material, Pairs
from taylor_verify.judge.errors.shift import LEAVES

# Tensors nearer than this are equal.
_SAME: Final = 1e-13
# A body is fitted only if the data have this many numbers for each parameter.
_EQUATIONS_PER_NUMBER: Final = 6
# Defects across the orbit must be at least this part of all defects to indicate another body.
_ACROSS: Final = 1e-3
# Many parameters fit much by themselves, so a body must leave at most a hundredth of the error.
_LEAVES: Final = LEAVES**2
# Axes are compared if the principal moments differ by this many times the difference of the tensors.
_APART: Final = 10.0
# The signs of axes that differ by a half turn.
_TURNS: Final = ((1, 1, 1), (1, 1, -1), (1, -1, 1), (-1, 1, 1))


def other_tensors(material: Material) -> Iterator[Candidate]:
    """Yield the tensors that result from misreading the scene's tensor; none has a number to fit."""
    right = material.equations
    tried: list[tuple[str, str, Equations]] = []
    for name, why, tensor in _misread(right):
        known = [right.tensor, *(other.tensor for *_, other in tried)]
        if all(_distance(tensor, other) > _SAME for other in known):
            tried.append((name, why, replace(right, tensor=tensor)))
    yield from material.tried([hypothesis for hypothesis in tried if hypothesis[2].is_possible])


def _distance(tensor: Floats, other: Floats) -> float:
    return float(np.linalg.norm(tensor - other) / np.linalg.norm(other))


def _misread(right: Equations) -> Iterator[tuple[str, str, Floats]]:
    """Yield name, reason and tensor of each way to misread the scene's tensor."""
    tensor, diagonal = right.tensor, np.diag(right.tensor)
    noun = "inertia tensor" if right.is_rigid else "energy"
    yield (
        f"{noun} cut to its diagonal",
        "the body moves as if the other entries were zero",
        np.diag(diagonal),
    )
    inverse = np.diag(1 / np.diag(right.inverse))
    why = "the body moves as if the other entries of the inverse were zero"
    yield f"{noun} cut to its diagonal", why, inverse
    if not right.is_rigid:
        return
    moments, axes = np.linalg.eigh(tensor)
    orders = [list(order) for order in permutations(range(3))]
    is_diagonal = np.array_equal(tensor, np.diag(diagonal))
    if is_diagonal:
        name, why = (
            "principal moments in another order",
            "its principal moments about axes 1 2 3 were",
        )
        moments = diagonal
    else:
        name, why = "principal axes dropped", "its axes were principal, with the moments"
    for order in orders:
        listed = ", ".join(f"{moment:.6g}" for moment in moments[order])
        yield name, f"the body moves as if {why} {listed}", np.diag(moments[order])
    for order, signs in () if is_diagonal else product(orders, _TURNS):
        turned = axes[:, order] * np.array(signs)
        why = "the body moves as if the turn to its principal axes were taken backwards"
        back = turned.T @ np.diag(moments[order]) @ turned
        yield "principal axes turned the wrong way", why, back
    single = tensor.astype(np.float32).astype(float)
    yield "inertia in float32", "the body's moments were rounded to 24 bits", single
    rounded = right.inverse.astype(np.float32).astype(float)
    why = "the inverse of the inertia tensor was rounded to 24 bits"
    yield "inertia in float32", why, np.linalg.inv(rounded)


# The tensor that explains an answer.


def another_body(material: Material) -> Iterator[Candidate]:
    """Yield the body that fits best, if the answer has more data than such a body has parameters.

    It must also explain the defects across the exact orbit, because any error of the clock explains those
    along it.
    """
    right, pairs = material.equations, material.pairs
    rows, columns = np.triu_indices(right.moving)
    if pairs.end.size < _EQUATIONS_PER_NUMBER * len(rows):
        return
    across = _across(pairs, pairs.defect)
    if not pairs.size(across) > _ACROSS * pairs.largest:
        return
    scale = np.sqrt(np.outer(np.diag(right.tensor), np.diag(right.tensor)))

    def tensor(parameters: Floats) -> Floats:
        change = np.zeros_like(right.tensor)
        change[rows, columns] = change[columns, rows] = parameters
        return right.tensor + scale * change

    def model(parameters: Floats) -> Floats:
        bodies = [replace(right, tensor=tensor(p)) for p in parameters]
        if not all(body.is_possible for body in bodies):
            return np.full((len(bodies), *pairs.end.shape), np.nan)
        return pairs.moved(bodies)

    best, states = fitted(model, pairs.end, pairs.sizes, np.zeros(len(rows)))
    if not np.all(np.isfinite(states)):
        return
    left = pairs.size(_across(pairs, pairs.end - states)) / pairs.size(across)
    why = _difference(right, tensor(best))
    name = "another inertia tensor" if right.is_rigid else "other coefficients of the energy"
    left = max(left, pairs.left(states))
    if left <= _LEAVES:
        yield Candidate(name, material.quantity, left, why, len(best))


def _across(pairs: Pairs, defects: Floats) -> Floats:
    """Return the part of the defects perpendicular to the exact motion, at the second row of every pair."""
    ahead = np.column_stack([pairs.flow, np.ones(len(pairs.flow))])
    along = pairs.equations.rates(ahead)[:, :-1] / pairs.sizes
    length = np.linalg.norm(along, axis=1, keepdims=True)
    along = np.divide(along, length, out=np.zeros_like(along), where=length > 0)
    scaled = defects / pairs.sizes
    across: Floats = (scaled - np.sum(scaled * along, axis=1, keepdims=True) * along) * pairs.sizes
    return across


def _difference(right: Equations, tensor: Floats) -> str:
    """Return the relative difference of a tensor and the turn of its axes, in words."""
    if not np.any(right.load):  # a free motion does not tell the scale of a tensor
        tensor = tensor * (np.sum(tensor * right.tensor) / np.sum(tensor**2))
    difference = _distance(tensor, right.tensor)
    if not right.is_rigid:
        return f"the energy that explains this answer differs by {difference:.2g} (relative)"
    words = f"the inertia tensor that explains this answer differs by {difference:.2g} (relative)"
    (moments, axes), (_, others) = np.linalg.eigh(right.tensor), np.linalg.eigh(tensor)
    if np.min(np.diff(moments)) <= _APART * difference * moments[-1]:
        return words
    signs = np.sign(np.sum(axes * others, axis=0))
    angle = 2 * np.arcsin(min(float(np.linalg.norm(axes - others * signs)) / 8**0.5, 1.0))
    return f"{words}, its axes turned by {angle:.2g} rad"
