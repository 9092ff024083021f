"""Impulses or velocities that a file has by the mass matrix of another body, beside a right motion."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from taylor_verify.judge.causes.candidate import Cause
from taylor_verify.judge.causes.changed_equations import Equations
from taylor_verify.judge.causes.fitted_bodies import entries
from taylor_verify.judge.causes.float_answer import Answer, Motion
from taylor_verify.judge.causes.inexact_conventions import SIGNED, axes, numbers
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.other_bodies import arm_of, faults_of_bodies
from taylor_verify.words.causes import with_numbers

# Directions in which the truth moves by less than this part tell no entry, and too few rows tell none.
_SEEN: Final = 1e-5
_FEWEST: Final = 18
# A right motion has attitude and centre that are wrong by this part of v; v itself by so many times that.
_SLIGHT: Final = 1e-4
_OF_FRAME: Final = 10.0
# Roundings of the file that a fit of all entries may leave, and the part by which a known body differs.
_ROUNDINGS: Final = 1.5
_SAME: Final = 1e-6
_ARITHMETIC: Final = 1e-12
# Of a matrix that is not symmetric no more entries are others.
_FEW: Final = 6


def printed_by_another_body(answer: Answer) -> Cause | None:
    """Return the body by whose mass matrix v is printed, where attitude or centre show a right motion."""
    wrong = [answer.worst[name] for name in ("attitude", "centre") if name in answer.failed]
    has_frame = answer.file.q is not None or answer.file.c is not None
    if answer.n != 6 or not has_frame or not answer.moving:
        return None
    if max(wrong, default=0.0) > _SLIGHT * max(answer.worst[name] for name in answer.moving):
        return None
    truth, file = answer.truth.v / answer.sizes, answer.file.v / answer.sizes
    singular = np.linalg.svd(truth, compute_uv=False)
    if answer.count < _FEWEST or singular[-1] < _SEEN * singular[0]:
        return None
    scaled = np.linalg.lstsq(truth, file, rcond=None)[0]
    own = _OF_FRAME * max(wrong, default=0.0)
    least = {
        name: max(_ROUNDINGS * answer.roundings[name], _ARITHMETIC, own) for name in answer.groups
    }

    def left(factors: Floats) -> dict[str, float] | None:
        """Return what v by some factors leaves; None if it is too much."""
        errors = answer.errors(Motion(answer.truth.v @ factors.T))
        if not all(np.max(errors[name]) <= least[name] for name in answer.groups):
            return None
        return {each: float(np.max(errors[each])) / answer.worst[each] for each in answer.moving}

    factors = answer.sizes[:, None] * scaled.T / answer.sizes
    leaves = left(factors)
    if leaves is None:
        return None
    right = "the motion is nearly right" if wrong else "the motion is right"
    if words := _of_vectors(answer, factors) or _of_axes(answer.right, factors):
        return Cause(f"{right}, and {words}", "convention", leaves)
    noun = "impulses" if answer.right.has_momenta else "velocities"
    name = f"{right}, and the {noun} are printed by the mass matrix of another body"
    for mass in _with_one_entry(answer):
        of_body = _factors(answer.right, mass)
        if (own_leaves := left(of_body)) is not None:
            words = _of_body(answer.right, of_body)
            return Cause(name, "convention", own_leaves, f"{name}: {words}")
    words = _of_body(answer.right, factors)
    return Cause(name, "convention", leaves, f"{name}: {words}") if words else None


def _factors(right: Equations, mass: Floats) -> Floats:
    """Return the factors of the true v in that of a file that a mass matrix prints."""
    if right.has_momenta:
        return np.asarray(mass @ right.inverse)
    return np.asarray(np.linalg.solve(mass, right.mass))


def _with_one_entry(answer: Answer) -> Iterator[Floats]:
    """Yield the scene's mass matrix with one entry that fits the rows best, each entry in its turn."""
    right = answer.right
    if right.has_momenta:
        velocities = answer.truth.v @ right.inverse
        more = answer.file.v - answer.truth.v
    else:
        velocities = answer.file.v
        more = (answer.truth.v - answer.file.v) @ right.mass
    for i, k in zip(*np.triu_indices(len(right.mass)), strict=True):
        one = np.zeros_like(right.mass)
        one[i, k] = one[k, i] = 1.0
        by_one = velocities @ one
        number = float(np.sum(by_one * more) / np.sum(by_one * by_one))
        yield right.mass + number * one


def _of_vectors(answer: Answer, factors: Floats) -> str:
    """Return what the two vectors of a file are, where no body makes them; empty for a body."""
    first, second = answer.groups
    size = np.sqrt(np.outer(answer.sizes, 1 / answer.sizes))
    if np.all(np.abs(factors - np.kron([[0, 1], [1, 0]], np.eye(3))) < _SAME * size):
        return f"{first} and {second} stand in each other's place"
    turn = factors - np.eye(6)
    arm = arm_of(turn)
    about = np.zeros((6, 6))
    about[3:, :3] = np.cross(arm, np.eye(3)).T
    if answer.right.has_momenta and np.all(np.abs(turn - about) < _SAME * size):
        return f"the impulsive couple y is that about the point {numbers(-arm)} of the body"
    return ""


def _of_axes(right: Equations, factors: Floats) -> str:
    """Return the axes of the other vectors, of which the file's are made by the right mass matrix."""
    mass, energy = right.mass, right.inverse
    made = energy @ factors @ mass if right.has_momenta else mass @ factors @ energy
    nouns = ("impulses", "velocities") if right.has_momenta else ("velocities", "impulses")
    near, parts = _SAME * np.max(np.abs(made)), list[str]()
    for words, part in (("linear", np.s_[:3]), ("angular", np.s_[3:])):
        rows = made[part].copy()
        own, rows[:, part] = rows[:, part].copy(), 0.0
        turned = next((P for P in SIGNED if np.max(np.abs(own - P)) < near), None)
        if turned is None or np.max(np.abs(rows)) > near:
            return ""
        if np.any(turned != np.eye(3)):
            parts.append(f"the {words} ones have other axes: {axes(turned)}")
    return f"the {nouns[0]} are made of {nouns[1]} of which {', and '.join(parts)}"


def _of_body(right: Equations, factors: Floats) -> str:
    """Return the body in words by the factors of the true v in that of the file; empty for none."""
    mass = factors @ right.mass if right.has_momenta else np.linalg.inv(factors @ right.inverse)
    near = _SAME * np.max(np.abs(mass))
    for family in faults_of_bodies(right):
        other = family.changes(family.right).get("mass")
        if family.kind == "body" and other is not None and np.max(np.abs(other - mass)) < near:
            return family.name
    if np.max(np.abs(mass - mass.T)) < near:
        return with_numbers("mass matrix", *entries(right.mass, (mass + mass.T) / 2))
    i, k = np.nonzero(np.abs(mass - right.mass) >= near)
    if len(i) > _FEW:
        return ""
    labels = [f"M_{row + 1}{column + 1}" for row, column in zip(i, k, strict=True)]
    return with_numbers("entries, which are not symmetric", labels, right.mass[i, k], mass[i, k])
