"""Hypotheses of wrong terms: left out, of the wrong sign, or loads that are fixed in space."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.equations import Equations
from taylor_verify.judge.causes.flow import Floats, bilinear, flow
from taylor_verify.judge.causes.material import Candidate, Material
from taylor_verify.judge.causes.readings import to_body

_Terms = tuple[tuple[str, str, dict[str, Any]], ...]

# Words, the remaining equation, and the weights of its terms.
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
    """Yield the equations without one of their terms, or with its sign changed."""
    right = material.equations
    terms = _RIGID if right.is_rigid else _FLUID
    tried = [(name, why, replace(right, **weights)) for name, why, weights in terms]
    if any(right.rotor):
        opposite = tuple(-entry for entry in right.rotor)
        why = "from row to row omega changes by I^-1 (M - omega x I omega), without h x omega"
        tried.append(("wheels left out", why, replace(right, rotor=(0.0, 0.0, 0.0))))
        why = "from row to row omega changes as if the wheels had the momentum -h"
        tried.append(("wheels with the other sign", why, replace(right, rotor=opposite)))
    if not right.is_rigid:
        uncoupled = right.tensor.copy()
        uncoupled[:3, 3:] = uncoupled[3:, :3] = 0
        if np.any(right.tensor != uncoupled):
            why = "the body has no coupling B of impulses and velocities"
            tried.append(("coupling left out", why, replace(right, tensor=uncoupled)))
    yield from material.tried(tried)


def loads(material: Material) -> Iterator[Candidate]:
    """Yield the equations with constant loads left out or of the other sign: each load, and both."""
    right = material.equations
    parts = {"moment": [0]} if right.is_rigid else {"force": [0], "couple": [1], "loads": [0, 1]}
    vectors = right.load.reshape(-1, 3)
    tried = []
    for noun, rows in parts.items():
        if not all(np.any(vectors[row]) for row in rows):
            continue
        for weight, words, be in (
            (0.0, "left out", "zero"),
            (-1.0, "with the other sign", "of the other sign"),
        ):
            load = vectors.copy()
            load[rows] *= weight
            why = f"from row to row the {material.quantity} changes as if the {noun} were {be}"
            tried.append((f"{noun} {words}", why, replace(right, load=load.ravel())))
    yield from material.tried(tried)


def space_loads(material: Material) -> Iterator[Candidate]:
    """Yield the equations whose loads are constant in space, by the answer's own attitude."""
    right, pairs = material.equations, material.pairs
    if pairs.turned is None or not np.any(right.load):
        return
    count = len(pairs.begin)
    vectors = [
        to_body(pairs.turned, np.broadcast_to(load, (count, 3)))
        for load in right.load.reshape(-1, 3)
    ]
    begin = np.column_stack([pairs.begin, *vectors, np.ones(count)])
    sizes = np.concatenate([pairs.sizes, np.full(right.moving + 1, np.linalg.norm(right.load))])
    (moved,) = flow(_map(right)[None], begin, pairs.spans, sizes)
    noun = "moment" if right.is_rigid else "load"
    why = f"from row to row the {material.quantity} changes as if the {noun} stood still in space"
    yield material.candidate(f"{noun} in space axes", why, moved[:, : right.moving])


def _map(right: Equations) -> Floats:
    """Return Q for z = (states, their loads, 1), where loads turn backwards in body axes: v' = v x W."""
    count, free = right.moving, replace(right, load=np.zeros_like(right.load))

    def rate(z: Floats) -> Floats:
        load, unit = z[:, count:-1], z[:, -1:]
        state = np.column_stack([z[:, :count], unit])
        omega = right.omega(state)
        driven = unit * (load @ right.inverse if right.is_rigid else load)
        turned = [np.cross(load[:, i : i + 3], omega) for i in range(0, count, 3)]
        return np.column_stack([free.rates(state)[:, :-1] + driven, *turned, np.zeros(len(z))])

    return bilinear(rate, 2 * count + 1)
