"""Terms of the equations that an answer leaves out or turns round: loads, Munk's moment, the turn of axes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from taylor_verify.judge.causes.candidate import Candidate
from taylor_verify.judge.causes.equations import Equations, with_tensor
from taylor_verify.judge.causes.material import Material

# Words, the term and its weight, and the equation that is left.
_FLUID: Final = (
    ("no Munk moment", {"munk": 0.0}, "y' lacks x x U, the moment of the added mass"),
    ("Munk moment with the other sign", {"munk": -1.0}, "y' has -x x U for x x U"),
    ("no gyroscopic term", {"gyroscopic": 0.0}, "y' lacks y x W, the turn of the body's axes"),
    ("gyroscopic term with the other sign", {"gyroscopic": -1.0}, "y' has -y x W for y x W"),
    ("linear impulse not turned", {"turning": 0.0}, "x' lacks x x W, the turn of the body's axes"),
    ("turn of the linear impulse with the other sign", {"turning": -1.0}, "x' has -x x W for x x W"),
)
_BOTH: Final = {"gyroscopic": -1.0, "munk": -1.0, "turning": -1.0}


def fluid_terms(material: Material) -> Iterator[Candidate]:
    """Yield Kirchhoff's equations without one of their terms, or with the other sign of it."""
    right = material.equations
    if right.is_rigid:
        return
    tried = [(name, why, replace(right, **weights)) for name, weights, why in _FLUID]
    back = "motion back in time"
    tried.append((back, "x' and y' have the other sign", replace(right, **_BOTH)))
    coupling = right.tensor.copy()
    coupling[:3, 3:] = coupling[3:, :3] = 0
    if np.any(right.tensor != coupling):
        why = "the body has no coupling B of impulses and velocities"
        tried.append(("coupling left out", why, with_tensor(right, coupling)))
    yield from tried_equations(material, tried)


def loads(material: Material) -> Iterator[Candidate]:
    """Yield the constant loads left out, or with the other sign."""
    right = material.equations
    parts = {"moment": slice(0, 3)} if right.is_rigid else {"force": slice(0, 3), "couple": slice(3, 6)}
    tried = []
    for noun, part in parts.items():
        if not np.any(right.load[part]):
            continue
        for weight, words in ((0.0, "left out"), (-1.0, "with the other sign")):
            load = right.load.copy()
            load[part] *= weight
            why = f"from row to row the {self_words(material)} changes as if the {noun} were "
            why += "zero" if weight == 0 else "of the other sign"
            tried.append((f"{noun} {words}", why, replace(right, load=load)))
    yield from tried_equations(material, tried)


def self_words(material: Material) -> str:
    """Return the noun of the states."""
    return "angular velocity" if material.equations.is_rigid else "impulse"


def tried_equations(
    material: Material, tried: list[tuple[str, str, Equations]]
) -> Iterator[Candidate]:
    """Yield a candidate for each of these equations: a name, the reason in words, the equations."""
    if not tried:
        return
    pairs = material.pairs
    for (name, why, _), states in zip(tried, pairs.moved([e for *_, e in tried]), strict=True):
        yield Candidate(name, material.quantity, pairs.left(states), why)
