"""The error that Euler angles carry near their singularity, where two of their axes are nearly one.

A program makes angles of a matrix or a quaternion. Each entry is rounded by u, and the angles by u over
the cosine of the second angle (its sine where the sequence begins and ends with one axis). The attitude of
three such angles is off by as much.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from taylor_verify.judge.floor.rounded_input import InputRounding
from taylor_verify.records.quantities import CONSERVED_QUANTITIES
from taylor_verify.solvers.files.columns.forms import SEQUENCES
from taylor_verify.solvers.files.file import TrajectoryFile
from taylor_verify.solvers.files.made import MadeRows

_ANGLES: Final = 3**0.5
# Farther from the singularity nothing is said.
_NEAR: Final = 0.1


def with_angles_rounded(
    inputs: InputRounding, file: TrajectoryFile, places: Sequence[int], roundoff: float
) -> InputRounding:
    """Return the rounding of the input, and of the angles of a file at these places."""
    rows = file.groups.get("quaternion")
    if file.form not in SEQUENCES or not isinstance(rows, MadeRows):
        return inputs
    second = rows.sources[0].doubles(places)[:, 1]
    leverage = np.abs(np.sin(second) if file.form[0] == file.form[2] else np.cos(second))
    with np.errstate(divide="ignore"):
        errors = np.minimum(_ANGLES * roundoff / leverage, np.pi)
    moved = {
        name: np.hypot(inputs.at_samples.get(name, 0.0), errors)
        for name in ("attitude", *CONSERVED_QUANTITIES)
        if name == "attitude" or "attitude" in CONSERVED_QUANTITIES[name].needs
    }
    words, least = inputs.moved, float(np.min(leverage))
    if least < _NEAR:
        words += (
            f", and the angles of the file, each rounding multiplied by up to {1 / least:.2g} near the "
            f"singularity of the sequence {file.form}"
        )
    return replace(inputs, moved=words, at_samples={**inputs.at_samples, **moved})
