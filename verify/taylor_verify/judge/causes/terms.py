"""Terms of the equations that are left out or have the other sign: loads, Munk's moment, turns of axes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.candidate import Candidate
from taylor_verify.judge.causes.equations import Equations, with_tensor
from taylor_verify.judge.causes.material import Material

# Words, the term and its weight, and the equation that is left.
_FLUID: Final[tuple[tuple[str, dict[str, Any], str], ...]] = (
    ("no Munk moment", {"munk": 0.0}, "y' lacks x x U, the moment of the added mass"),
    ("Munk moment with the other sign", {"munk": -1.0}, "y' has -x x U for x x U"),
    ("no gyroscopic term", {"gyroscopic": 0.0}, "y' lacks y x W, the turn of the body's axes"),
    ("gyroscopic term with the other sign", {"gyroscopic": -1.0}, "y' has -y x W for y x W"),
    ("linear impulse not turned", {"turning": 0.0}, "x' lacks x x W, the turn of the body's axes"),
    (
        "turn of the linear impulse with the other sign",
        {"turning": -1.0},
        "x' has -x x W for x x W",
    ),
)
_BACK: Final[dict[str, Any]] = {"gyroscopic": -1.0, "munk": -1.0, "turning": -1.0}


def fluid_terms(material: Material) -> Iterator[Candidate]:
    """Yield Kirchhoff's equations without one of their terms, or with the other sign of it."""
    right = material.equations
    if right.is_rigid:
        return
    tried = [(name, why, replace(right, **weights)) for name, weights, why in _FLUID]
    back = "motion back in time"
    tried.append((back, "x' and y' have the other sign", replace(right, **_BACK)))
    coupling = right.tensor.copy()
    coupling[:3, 3:] = coupling[3:, :3] = 0
    if np.any(right.tensor != coupling):
        why = "the body has no coupling B of impulses and velocities"
        tried.append(("coupling left out", why, with_tensor(right, coupling)))
    yield from tried_equations(material, tried)


def loads(material: Material) -> Iterator[Candidate]:
    """Yield the constant loads left out, or with the other sign: each of them, and both."""
    right = material.equations
    parts = {"moment": [0]} if right.is_rigid else {"force": [0], "couple": [1], "loads": [0, 1]}
    vectors = right.load.reshape(-1, 3)
    tried = []
    for noun, rows in parts.items():
        if not all(np.any(vectors[row]) for row in rows):
            continue
        for weight, words in ((0.0, "left out"), (-1.0, "with the other sign")):
            load = vectors.copy()
            load[rows] *= weight
            be = "zero" if weight == 0 else "of the other sign"
            why = f"from row to row the {material.quantity} changes as if the {noun} were {be}"
            tried.append((f"{noun} {words}", why, replace(right, load=load.ravel())))
    yield from tried_equations(material, tried)


def tried_equations(
    material: Material, tried: list[tuple[str, str, Equations]]
) -> Iterator[Candidate]:
    """Yield a candidate for each of these equations: a name, the reason in words, the equations."""
    if not tried:
        return
    pairs = material.pairs
    for (name, why, _), states in zip(tried, pairs.moved([e for *_, e in tried]), strict=True):
        yield Candidate(name, material.quantity, pairs.left(states), why)
