"""The precisions that can reach an error at all, by what rounding alone leaves on the scene's own orbit.

The judge's floor grows with the number of steps, which is a solver's own affair. So it is taken for the
fewest there can be, one rounding a sample: no arithmetic of that precision is asked for less. Only a
solver that computes on another precision than it answers on may do better.
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
# A floor is not quite in proportion to the roundoff: beside an unstable motion, rounding the data moves
# the orbit too. Some bits more make up for it.
_MORE_BITS: Final = 8
_ATTEMPTS: Final = 8


@lru_cache(maxsize=64)
def least_error(scene: Scene, rung: Rung) -> float | None:
    """Return the largest attainable error of all tracked quantities and samples; None if not known."""
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
    """Return the rungs on which rounding alone leaves far more than an error, each with that in words.

    The floor is a model of random roundings: as the judge's gates leave GATE_FACTOR above it, so it takes
    GATE_FACTOR here before a rung is given up unmeasured.
    """
    reasons = {}
    for rung in dict.fromkeys(rungs):
        least = least_error(scene, rung)
        if least is not None and least > GATE_FACTOR * error:
            beyond = "" if least < 1 else ", more than the motion's own size"
            reasons[rung] = f"on {rung.name} rounding alone leaves {least:.2g}{beyond}"
    return reasons


def narrowest(scene: Scene, error: float) -> tuple[Rung, float] | None:
    """Return the narrowest rung on which rounding alone leaves no more than an error, and how much.

    A type of the ladder where one will do, else mpN; None where no rung does, or nothing is known.
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
