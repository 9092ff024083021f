"""Precisions that can reach an error, by the errors that rounding alone leaves on the scene's orbit.

The judge's floor grows with the number of steps, which depends on the solver. The floor here is that of the
fewest possible steps: one rounding for each sample. Only a solver that computes in a wider precision than
that of its answer can have a smaller error.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from math import ceil, inf, log2
from typing import Any, Final

import numpy as np

from taylor_verify.exact.conditioning.loaded import truth
from taylor_verify.exact.solution import Unsettled
from taylor_verify.judge.errors.state import state_errors
from taylor_verify.judge.floor.arithmetic import truth_digits
from taylor_verify.judge.floor.attainable import floor
from taylor_verify.models.problem import NotRepresentable, pose
from taylor_verify.numbers.precision import Rung
from taylor_verify.numbers.precision import rung as rung_named
from taylor_verify.records.precisions import FORMATS
from taylor_verify.records.quantities import GATE_FACTOR
from taylor_verify.scenes.scene import Scene

Floats = np.ndarray[Any, np.dtype[np.float64]]

# Digits of a truth that only shows how large the motion is.
_DIGITS: Final = 15
_MOST_BITS: Final = 1000
# A floor is not quite proportional to the roundoff: near an unstable motion the rounding of the data
# changes the orbit too. Each attempt has at least so many bits more than the one before.
_MORE_BITS: Final = 8
_ATTEMPTS: Final = 8


@lru_cache(maxsize=64)
def least_error(scene: Scene, rung: Rung) -> float | None:
    """Return the largest attainable error of all tracked quantities and samples; None if unknown."""
    try:
        given = pose(scene, rung).given
        return float(np.max(floors(given, scene, rung, 0)))
    except (NotRepresentable, Unsettled):
        return None


def floors(given: Scene, scene: Scene, rung: Rung, steps: int) -> Floats:
    """Return the largest attainable error of all tracked quantities at each sample of ``given``.

    ``given`` is ``scene`` as the rung rounds it. Raises Unsettled if the conditioning of the orbit cannot
    be computed.
    """
    digits = truth_digits(rung.bits)
    motion = truth(given, digits).motion(given.clock.elapsed, min(digits, _DIGITS))
    base = floor(given, scene, rung.unit_roundoff, steps)
    # The motion is compared with itself, because only the names and the scales of the errors are needed.
    states = state_errors(given, motion, motion)
    worst: Floats = np.max([base.of_state(errors) for errors in states], axis=0).astype(float)
    return worst


def left_out(scene: Scene, rungs: Iterable[Rung], error: float) -> dict[Rung, str]:
    """Return the rungs on which rounding alone leaves far more than an error, each with the reason.

    The floor is a model of random roundings, and the judge's gates allow GATE_FACTOR times the floor. So a
    rung is left out only if its floor is more than GATE_FACTOR times the error.
    """
    reasons = {}
    for rung in dict.fromkeys(rungs):
        least = least_error(scene, rung)
        if least is not None and least > GATE_FACTOR * error:
            beyond = "" if least < 1 else ", more than the motion's own size"
            reasons[rung] = f"on {rung.name} rounding alone leaves {least:.2g}{beyond}"
    return reasons


def narrowest(scene: Scene, error: float) -> tuple[Rung, float] | None:
    """Return the narrowest rung on which rounding alone leaves at most an error, and its floor.

    It is one of the formats f32 to f128 if one suffices, else mpN. The result is None if no rung suffices,
    or if the floor is unknown.
    """
    names = [*FORMATS]
    for attempt in range(len(FORMATS) + _ATTEMPTS):
        rung = rung_named(names[attempt])
        least = least_error(scene, rung)
        if least is not None and least <= error:
            return rung, least
        if attempt >= len(FORMATS) - 1:
            if least is None or not least < inf:
                return None
            bits = rung.bits + max(ceil(log2(least / error)), _MORE_BITS)
            if not bits <= _MOST_BITS:
                return None
            names.append(f"mp{bits}")
    return None
