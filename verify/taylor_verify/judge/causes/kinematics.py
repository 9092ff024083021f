"""Hypotheses of wrong attitude kinematics: in the wrong axes, backwards, or at another rate.

R' = R [omega]x is correct. Between two rows the answer's own omega is used: the exact flow from the first
row, plus the defect of omega, spread evenly over the time. So a wrong omega does not count as an error of
the attitude's kinematics.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from taylor_verify.judge.causes.equations import Equations
from taylor_verify.judge.causes.flow import Floats, bilinear, flow
from taylor_verify.judge.causes.material import FEWEST_PAIRS, Candidate, Material

_NOISE: Final = 1e-13


# The weights (b, a) of q' = (b W q + a q W) / 2, where W is the angular velocity in body axes.
_RIGHT: Final = (0.0, 1.0)
_WRONG: Final = (
    (
        "attitude kinematics in the wrong axes",
        "R' = [omega]x R is integrated with omega in body axes, where R' = R [omega]x",
        (1.0, 0.0),
    ),
    (
        "attitude turned backwards",
        "R' = -R [omega]x is integrated, where R' = R [omega]x",
        (0.0, -1.0),
    ),
    (
        "transposed attitude",
        "it turns by R' = -[omega]x R with omega in body axes, as the transposed one does",
        (-1.0, 0.0),
    ),
    ("attitude stands still", "R' = 0, though the body turns", (0.0, 0.0)),
    (
        "attitude turns twice as fast",
        "q' = q omega is integrated, where q' = q omega / 2",
        (0.0, 2.0),
    ),
    (
        "attitude turns half as fast",
        "q' = q omega / 4 is integrated, where q' = q omega / 2",
        (0.0, 0.5),
    ),
)


def kinematics(material: Material) -> Iterator[Candidate]:
    """Yield each wrong kinematics with the part of the attitude's defects that it leaves."""
    if len(material.places) < FEWEST_PAIRS:
        return
    pairs = material.pairs
    if pairs.turned is None or pairs.turned_end is None:
        return
    maps = [_map(pairs.equations, *weights) for weights in (_RIGHT, *(w for *_, w in _WRONG))]
    drift = pairs.defect / pairs.spans[:, None]
    begin = np.column_stack([pairs.begin, drift, np.ones(len(drift)), pairs.turned])
    sizes = np.concatenate([pairs.sizes, np.full(len(drift[0]) + 1, np.inf), np.ones(4)])
    turned = flow(np.stack(maps), begin, pairs.spans, sizes)[:, :, -4:]
    right, *others = (_angle(pairs.turned_end, rows) for rows in turned)
    if not right > _NOISE:
        return
    for (name, why, _), left in zip(_WRONG, others, strict=True):
        yield Candidate(name, "attitude", left / right, why)


def _map(equations: Equations, before: float, after: float) -> Floats:
    """Return Q for z = (states, their constant drift, 1, q)."""
    count = equations.moving

    def rate(z: Floats) -> Floats:
        drift, unit, q = z[:, count : 2 * count], z[:, 2 * count : 2 * count + 1], z[:, -4:]
        state = np.column_stack([z[:, :count], unit])
        states = equations.rates(state)[:, :-1] + unit * drift
        omega = equations.omega(state)
        turned = (before * _times(omega, q, 1) + after * _times(omega, q, -1)) / 2
        return np.column_stack([states, np.zeros((len(z), count + 1)), turned])

    return bilinear(rate, 2 * count + 5)


def _times(omega: Floats, q: Floats, sign: int) -> Floats:
    """Return the quaternion product omega q for sign +1, q omega for -1."""
    scalar, vector = q[:, :1], q[:, 1:]
    return np.column_stack(
        [-np.sum(omega * vector, axis=1), scalar * omega + sign * np.cross(omega, vector)]
    )


def _angle(q: Floats, other: Floats) -> float:
    """Return the largest angle between attitudes; q and -q are the same attitude."""
    other = other / np.linalg.norm(other, axis=1, keepdims=True)
    apart = np.minimum(np.linalg.norm(q - other, axis=1), np.linalg.norm(q + other, axis=1))
    largest = float(np.max(apart))
    return 4 * np.arcsin(min(largest / 2, 1.0)) if np.isfinite(largest) else np.inf
