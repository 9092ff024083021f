"""Readings of an answer in other axes or another order, proven by its first row or by its motion."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Final

import numpy as np

from taylor_verify.judge.causes.flow import Floats
from taylor_verify.judge.causes.material import Candidate, Material
from taylor_verify.judge.errors.shift import LEAVES

# A relative error of the start above OFF means another start; up to PRINTED it is the same start.
OFF: Final = 1e-3
PRINTED: Final = 1e-6
_CONJUGATE: Final = np.array([1, -1, -1, -1])


def attitude_reading(material: Material) -> tuple[list[Candidate], Material]:
    """Return the reading that makes the attitude at the start correct, and the answer read in that way."""
    q, row = material.quaternions, material.start_row
    if q is None or row is None or "attitude" not in material.failed:
        return [], material
    first = np.roll(q, 1, axis=1)
    before = _apart(q[row], material.start_attitude)
    for name, why, read in (
        ("transposed attitude", "it takes space to body axes", q * _CONJUGATE),
        ("scalar last", "the quaternion has its scalar last", first),
        (
            "scalar last and transposed attitude",
            "the quaternion has its scalar last and takes space to body axes",
            first * _CONJUGATE,
        ),
    ):
        after = _apart(read[row], material.start_attitude)
        if before > OFF and after <= PRINTED:
            reason = f"{why}, by the row at the start"
            candidate = Candidate(name, "attitude", after / before, reason)
            return [candidate], replace(material, quaternions=read)
    return [], material


def _apart(q: Floats, other: Floats) -> float:
    return min(float(np.linalg.norm(q - other)), float(np.linalg.norm(q + other)))


def omega_reading(
    material: Material, dynamics: Callable[[Material], list[Candidate]]
) -> tuple[list[Candidate], Material, list[Candidate]]:
    """Return a proven reading of omega in space axes, the answer read in that way, and its ``dynamics``.

    The answer's own attitude, or its transpose, converts the axes. The row at the start proves or refutes
    the reading. If that row is correct in both axes, as for the identity attitude, the motion decides:
    after the reading it must be exact, or have a cause with at most one fitted number; without the
    reading it must have no cause.
    """
    plain, q = dynamics(material), material.quaternions
    if q is None or not material.equations.is_rigid or "omega" not in material.failed:
        return [], material, plain
    by_motion = bool(plain) and not any(candidate.leaves <= LEAVES for candidate in plain)
    for turn, words in ((q, ""), (q * _CONJUGATE, ", if that is the transposed one")):
        read = replace(material, states=to_body(turn, material.states))
        before, after = material.start_error, read.start_error
        leaves = np.inf
        if before is not None and after is not None and max(before, after) > OFF:
            if not (before > OFF and after <= PRINTED):
                continue
            leaves, tried = after / before, dynamics(read)
        elif by_motion:
            tried = dynamics(read)
            simple = [1.0, *(candidate.leaves for candidate in tried if candidate.fitted <= 1)]
            leaves = min(simple) * read.pairs.largest / material.pairs.largest
        if leaves <= LEAVES:
            why = f"by the answer's own attitude it is taken to body axes{words}"
            return [Candidate("omega in space axes", "omega", leaves, why)], read, tried
    return [], material, plain


def to_body(q: Floats, vectors: Floats) -> Floats:
    """Return R(q)^T v for every row."""
    scalar, axis = q[:, :1], -q[:, 1:]
    twice = 2 * np.cross(axis, vectors)
    return vectors + scalar * twice + np.cross(axis, twice)
