"""Faults without numbers, and the natural sizes of the numbers of those that have some."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from taylor_verify.judge.causes.answer import Answer
from taylor_verify.judge.causes.equations import Changes, Equations
from taylor_verify.judge.causes.fit import Family
from taylor_verify.judge.causes.flow import Floats


@dataclass(frozen=True)
class Fault:
    """A change of the scene that has no number to fit."""

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


def linear(
    equations: Equations,
    name: str,
    kind: str,
    scale: Any,
    right: Any = None,
    labels: tuple[str, ...] = (),
    **along: Any,
) -> Family:
    """Return a family whose numbers change parameters linearly, each ``along`` a direction of its own.

    The numbers of the scene are ``right``, and 0 without it.
    """
    directions = {field: np.asarray(each, dtype=float) for field, each in along.items()}
    count = len(next(iter(directions.values())))
    own = np.zeros(count) if right is None else np.array(right, dtype=float)

    def changes(p: Floats) -> Changes:
        return {
            field: getattr(equations, field) + np.tensordot(p - own, each, axes=1)
            for field, each in directions.items()
        }

    scales = np.broadcast_to(np.asarray(scale, dtype=float), own.shape)
    return Family(name, kind, own, scales, changes, labels)


def both(equations: Equations, one: Family, other: Family) -> Family:
    """Return the family of the changes of two families together."""
    count = one.count

    def changes(p: Floats) -> Changes:
        first, second = one.changes(p[:count]), other.changes(p[count:])
        common = {
            field: first[field] + second[field] - getattr(equations, field)
            for field in first.keys() & second.keys()
        }
        return {**first, **second, **common}

    return Family(
        f"{one.name} and {other.name}",
        "pair",
        np.concatenate([one.right, other.right]),
        np.concatenate([one.scale, other.scale]),
        changes,
    )
