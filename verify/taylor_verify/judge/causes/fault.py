"""Faults without numbers, and the natural sizes of the numbers of those that have some."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from taylor_verify.judge.causes.answer import Answer
from taylor_verify.judge.causes.equations import Changes
from taylor_verify.judge.causes.flow import Floats


@dataclass(frozen=True)
class Fault:
    """A change of the equations that has no number to fit."""

    name: str
    kind: str
    changes: Changes


@dataclass(frozen=True)
class Sizes:
    """Natural sizes of an answer: velocities, roots of inertia, loads, and the pace of turn."""

    nu: Floats
    inertia: Floats
    load: Floats
    pace: float

    @classmethod
    def of(cls, answer: Answer) -> Sizes:
        right, truth = answer.right, answer.truth.v
        nu = truth @ right.inverse.T if right.has_momenta else truth
        momentum = truth if right.has_momenta else truth @ right.mass
        span = float(np.max(np.abs(answer.times - answer.begins))) or 1.0
        pace = max(float(np.max(np.linalg.norm(nu[:, -3:], axis=1))), 1 / span)
        return cls(
            _largest(nu, 1e-6),
            np.sqrt(np.diag(right.mass)),
            _largest(momentum, 1.0) * pace,
            pace,
        )


def _largest(rows: Floats, least: float) -> Floats:
    """Return the largest size of each component, at least this part of its vector's."""
    vectors = np.linalg.norm(rows.reshape(len(rows), -1, 3), axis=2).max(axis=0)
    vectors = np.maximum(np.repeat(vectors, 3), 1e-300)
    return np.asarray(np.maximum(np.max(np.abs(rows), axis=0), least * vectors))


def of_body(mass: Floats) -> dict[str, Any]:
    """Return the changes of a body with another mass matrix."""
    return {"mass": mass, **of_coriolis(mass)}


def of_coriolis(matrix: Floats) -> Mapping[str, Any]:
    """Return the changes of Coriolis terms with another matrix than that of the acceleration."""
    own: dict[str, Any] = {"gyro": matrix[-3:]}
    if len(matrix) == 6:
        own |= {"turn": matrix[:3], "munk": matrix[:3]}
    return own
