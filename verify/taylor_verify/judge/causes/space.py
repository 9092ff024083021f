"""Vectors in space axes: an omega, by the answer's own attitude, and loads that stand still in space."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from taylor_verify.judge.causes.candidate import Candidate
from taylor_verify.judge.causes.equations import Equations
from taylor_verify.judge.causes.flow import Floats, bilinear, flow
from taylor_verify.judge.causes.material import Material
from taylor_verify.judge.errors.shift import LEAVES

# An omega at the start that is off by more than the one, and by no more than the other in other axes.
_OFF: Final = 1e-3
_PRINTED: Final = 1e-6


@dataclass(frozen=True)
class SpaceReading:
    """An answer with its omega taken from space axes to body axes, and the words that say so."""

    material: Material
    words: str = ""

    def candidate(self, leaves: float) -> Candidate:
        """Return the reading as a candidate for the cause of a wrong omega."""
        why = f"by the answer's own attitude it is taken to body axes{self.words}"
        return Candidate("omega in space axes", "omega", leaves, why)

    def is_refuted(self, plain: Material) -> bool:
        """Return True if the row at the start is right as it stands, and wrong so read."""
        before, after = plain.start_error, self.material.start_error
        return before is not None and after is not None and before <= _OFF < after

    def leaves(self, plain: Material, tried: list[Candidate], telling: bool) -> float | None:
        """Return the part of the error that the reading leaves; None if it is not proven.

        The row at the start proves or refutes it. Where that is right in both axes, as with an attitude
        of 1, the motion proves it: it must be exact, or have a cause with at most one fitted number.
        """
        before, after = plain.start_error, self.material.start_error
        if before is not None and after is not None and max(before, after) > _OFF:
            return after / before if before > _OFF and after <= _PRINTED else None
        if not telling:
            return None
        causes = [one.leaves for one in tried if one.fitted <= 1]
        found = min(1.0, *causes) * self.material.pairs.largest / plain.pairs.largest
        return found if found <= LEAVES else None


def space_readings(material: Material) -> Iterator[SpaceReading]:
    """Yield the answer read so, by its attitude and by the transposed one; nothing without an attitude."""
    q = material.quaternions
    if q is None or not material.equations.is_rigid:
        return
    yield SpaceReading(material.with_states(_to_body(q, material.states)))
    words = ", if that is the transposed one"
    transposed = q * np.array([1, -1, -1, -1])
    yield SpaceReading(material.with_states(_to_body(transposed, material.states)), words)


def space_loads(material: Material) -> Iterator[Candidate]:
    """Yield the equations whose loads keep their components in space, by the answer's own attitude."""
    right, pairs = material.equations, material.pairs
    if pairs.turned is None or not np.any(right.load):
        return
    vectors = [
        _to_body(pairs.turned, np.broadcast_to(load, (len(pairs.begin), 3)))
        for load in right.load.reshape(-1, 3)
    ]
    begin = np.column_stack([pairs.begin, *vectors, np.ones(len(pairs.begin))])
    sizes = np.concatenate([pairs.sizes, np.full(right.moving + 1, np.linalg.norm(right.load))])
    (moved,) = flow(_map(right)[None], begin, pairs.spans, sizes)
    noun = "moment" if right.is_rigid else "load"
    why = f"from row to row the {material.quantity} changes as if the {noun} stood still in space"
    left = pairs.left(moved[:, : right.moving])
    yield Candidate(f"{noun} in space axes", material.quantity, left, why)


def _map(right: Equations) -> Floats:
    """Q of z = (states, their loads, 1), where loads turn backwards in body axes: v' = v x W."""
    count = right.moving

    def rate(z: Floats) -> Floats:
        state, load, one = z[:, :count], z[:, count:-1], z[:, -1:]
        omega = right.omega(np.column_stack([state, one]))
        made = right.free.rates(np.column_stack([state, one]))[:, :-1]
        driven = one * (load @ right.inverse if right.is_rigid else load)
        turned = [np.cross(load[:, i : i + 3], omega) for i in range(0, count, 3)]
        return np.column_stack([made + driven, *turned, np.zeros(len(z))])

    return bilinear(rate, 2 * count + 1)


def _to_body(q: Floats, vectors: Floats) -> Floats:
    """R(q)^T v for every row."""
    scalar, axis = q[:, :1], -q[:, 1:]
    twice = 2 * np.cross(axis, vectors)
    return vectors + scalar * twice + np.cross(axis, twice)
