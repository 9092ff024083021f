"""Precisions that can reach an error, by the errors that rounding alone leaves on the scene's orbit.

The judge's floor grows with the number of steps, which depends on the solver. Here it is taken for the
fewest possible steps, one rounding for each sample. Only a solver that computes in a wider precision than
that of its answer may do better.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from math import ceil, inf, log2
from typing import Final

import numpy as np

from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Unsettled
from taylor_verify.judge.errors.state import state_errors
from taylor_verify.judge.floor.attainable import floor
from taylor_verify.models.problem import NotRepresentable, pose
from taylor_verify.records.precisions import FORMATS
from taylor_verify.records.quantities import GATE_FACTOR
from taylor_verify.scenes.precision import Rung
from taylor_verify.scenes.precision import rung as rung_named
from taylor_verify.scenes.scene import Scene

# Of a truth that says only how large the motion is.
_DIGITS: Final = 15
_MOST_BITS: Final = 1000
# A floor is not quite proportional to the roundoff, because rounding the data beside an unstable motion
# moves the orbit too. Some more bits make up for it.
_MORE_BITS: Final = 8
_ATTEMPTS: Final = 8


@lru_cache(maxsize=64)
def least_error(scene: Scene, rung: Rung) -> float | None:
    """Return the largest attainable error of all tracked quantities and samples; None if unknown."""
    try:
        given = pose(scene, rung).given
        truth = solution(given).motion(given.clock.elapsed, _DIGITS)
        base = floor(given, scene, rung.unit_roundoff, 0)
    except (NotRepresentable, Unsettled):
        return None
    # Only the parts and their scales are asked for: the truth is compared with itself.
    states = state_errors(given, truth, truth)
    return float(max(np.max(base.of_state(errors)) for errors in states))


def left_out(scene: Scene, rungs: Iterable[Rung], error: float) -> dict[Rung, str]:
    """Return the rungs on which rounding alone leaves far more than an error, each with the reason.

    The floor is a model of random roundings. As the judge's gates allow GATE_FACTOR above it, a rung is
    left out only if its floor is GATE_FACTOR times the error.
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

    It is a type of the ladder if one suffices, else mpN. The result is None if no rung suffices, or if the
    floor is unknown.
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
