"""Terms of the equations that are left out or have the other sign: gyroscopic, Munk's, turns of axes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.candidate import Candidate
from taylor_verify.judge.causes.material import Material

_Terms = tuple[tuple[str, str, dict[str, Any]], ...]

# Words, the equation that is left, and the weights of its terms.
_RIGID: Final[_Terms] = (
    (
        "no gyroscopic term",
        "from row to row omega changes by I^-1 M alone, without omega x I omega",
        {"gyroscopic": 0},
    ),
    (
        "gyroscopic term with the other sign",
        "from row to row omega changes by I^-1 (M + omega x I omega)",
        {"gyroscopic": -1},
    ),
)
_FLUID: Final[_Terms] = (
    ("no Munk moment", "y' lacks x x U, the moment of the added mass", {"munk": 0}),
    ("Munk moment with the other sign", "y' has -x x U for x x U", {"munk": -1}),
    ("no gyroscopic term", "y' lacks y x W, the turn of the body's axes", {"gyroscopic": 0}),
    ("gyroscopic term with the other sign", "y' has -y x W for y x W", {"gyroscopic": -1}),
    ("linear impulse not turned", "x' lacks x x W, the turn of the body's axes", {"turning": 0}),
    (
        "turn of the linear impulse with the other sign",
        "x' has -x x W for x x W",
        {"turning": -1},
    ),
    (
        "motion back in time",
        "x' and y' have the other sign",
        {"gyroscopic": -1, "munk": -1, "turning": -1},
    ),
)


def wrong_terms(material: Material) -> Iterator[Candidate]:
    """Yield the equations without one of their terms, or with the other sign of it."""
    right = material.equations
    terms = _RIGID if right.is_rigid else _FLUID
    tried = [(name, why, replace(right, **weights)) for name, why, weights in terms]
    if not right.is_rigid:
        uncoupled = right.tensor.copy()
        uncoupled[:3, 3:] = uncoupled[3:, :3] = 0
        if np.any(right.tensor != uncoupled):
            why = "the body has no coupling B of impulses and velocities"
            tried.append(("coupling left out", why, replace(right, tensor=uncoupled)))
    yield from material.tried(tried)
