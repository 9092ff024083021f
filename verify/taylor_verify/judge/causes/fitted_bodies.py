"""Words for a body that was fitted: its entries beside those of the scene, and how they come about."""

from __future__ import annotations

from typing import Final

import numpy as np

from taylor_verify.judge.causes.candidate import Candidate
from taylor_verify.judge.causes.changed_equations import Changes, Equations
from taylor_verify.judge.causes.changed_texts import names_inertia
from taylor_verify.judge.causes.energies import coefficients
from taylor_verify.judge.causes.fit import Family
from taylor_verify.judge.causes.float_answer import Answer
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.other_bodies import AND_REST
from taylor_verify.words.causes import with_numbers

_SAME: Final = 1e-9
# Entries are unchanged together as far as their ratios agree, at best and at worst to this part.
_UNCHANGED: Final = (1e-9, 1e-3)
_NEAR: Final = 1e-6
# What an added mass is that has this factor.
_ADDED: Final = {0.0: "is missing", 2.0: "is there twice", -1.0: "has the other sign"}


def described(answer: Answer, candidate: Candidate) -> tuple[str, Changes]:
    """Return a candidate in words, with its changes; a body has the factor that changes the least."""
    right, changes = answer.right, candidate.changes
    if candidate.kind == "body" and candidate.count > 1:
        mass, free = changes["mass"], ""
        if answer.is_up_to_a_factor:
            mass, free = nearest_factor(right, mass), ", all entries known up to one factor"
        if not candidate.are_seen:
            free += ", not all of which this motion shows"
        if right.energy is None or candidate.family.labels[0].startswith("M_"):
            both = entries(right.mass, mass)
        else:
            both = coefficients(right.energy, mass)
        words = with_numbers(candidate.family.name + free, *both)
        return words, {"mass": mass}
    words = structure(candidate.family, candidate.numbers)
    named = ": ".join(filter(None, (words, candidate.text)))
    if "mass" in changes and names_inertia(right.loads):
        named += ", and not in the texts of the loads"
    return named, changes


def nearest_factor(right: Equations, mass: Floats) -> Floats:
    """Return a mass matrix, known up to a factor, with the factor that leaves most entries unchanged."""
    own, other = right.mass, mass
    if right.energy is not None:
        own, other = right.energy, np.asarray(np.linalg.inv(mass))
    upper = np.triu_indices(len(mass))
    is_seen = np.abs(own[upper]) > _SAME * np.max(np.abs(own))
    ratios = other[upper][is_seen] / own[upper][is_seen]
    ratios = np.sort(ratios[ratios > _NEAR])
    apart = np.abs(ratios[:, None] / ratios - 1)
    unchanged = -np.sum(np.log(np.clip(apart, *_UNCHANGED)), axis=0)
    factor = ratios[int(np.argmax(unchanged))] if len(ratios) else 1.0
    return mass / factor if other is mass else mass * factor


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


def structure(family: Family, numbers: Floats) -> str:
    """Return in words how the masses of the Coriolis terms follow from the body's; empty if they do not.

    With an added mass A = M - m 1 that enters f times, they are m + f A: a straight line.
    """
    if family.name.endswith(AND_REST):
        free = ", moments of inertia known up to a common number" * ("mass" in family.labels)
        near = [words for value, words in _ADDED.items() if abs(numbers[0] - value) < _NEAR]
        return f"the added mass {near[0]}{free}" if near else ""
    is_diagonal = family.labels[:3] == ("M_11", "M_22", "M_33") and family.kind != "body"
    own, other = family.right[:3], numbers[:3]
    if not is_diagonal or "Munk" in family.name or np.ptp(own) < _SAME * np.max(own):
        return ""
    factor, offset = np.polyfit(own, other, 1)
    if np.any(np.abs(other - factor * own - offset) > _NEAR * np.max(own)):
        return ""
    nice = {0.0: "lack the added mass", 2.0: "have the added mass twice"}
    nice |= {-1.0: "have the added mass with the other sign", 1.0: "lack the rigid body"}
    near = [words for value, words in nice.items() if abs(factor - value) < _NEAR]
    of_body = offset / (1 - factor) if abs(factor - 1) > _NEAR else -offset
    if not near or not 0 < of_body <= np.min(own) * (1 + _NEAR):
        return ""
    return f"the Coriolis terms {near[0]} (a rigid body of mass {of_body:.6g})"
