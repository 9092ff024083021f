"""Readings of an attitude that the row at the start proves, whatever the dynamics are."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from taylor_verify.judge.causes.candidate import Candidate
from taylor_verify.judge.causes.flow import Floats
from taylor_verify.judge.causes.material import Material

# An attitude at the start that is off by more than the one, and by no more than the other read otherwise.
_OFF: Final = 1e-3
_PRINTED: Final = 1e-6


def attitude_reading(material: Material) -> tuple[list[Candidate], Material]:
    """Return the reading under which the attitude at the start is the scene's, and the answer so read."""
    q, rows = material.quaternions, np.flatnonzero(material.elapsed == 0)
    if q is None or not len(rows) or "attitude" not in material.failed:
        return [], material
    start, row = material.start_attitude, q[rows[0]]
    before = _apart(row, start)
    for name, why, read in (
        ("transposed attitude", "it takes space to body axes", _conjugate(q)),
        ("scalar last", "the quaternion has its scalar last", _rolled(q)),
        (
            "scalar last and transposed attitude",
            "the quaternion has its scalar last and takes space to body axes",
            _conjugate(_rolled(q)),
        ),
    ):
        after = _apart(read[rows[0]], start)
        if before > _OFF and after <= _PRINTED:
            said = f"{why}, by the row at the start"
            found = Candidate(name, "attitude", after / before, said)
            return [found], replace(material, quaternions=read)
    return [], material


def _conjugate(q: Floats) -> Floats:
    found: Floats = q * np.array([1, -1, -1, -1])
    return found


def _rolled(q: Floats) -> Floats:
    return np.roll(q, 1, axis=1)


def _apart(q: Floats, other: Floats) -> float:
    return min(float(np.linalg.norm(q - other)), float(np.linalg.norm(q + other)))
