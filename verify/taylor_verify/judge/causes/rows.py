"""Hypotheses that rows belong to another time or to another scene."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from typing import Final

import numpy as np

from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Unsettled
from taylor_verify.judge.causes.material import Candidate, Material
from taylor_verify.judge.causes.readings import OFF, PRINTED
from taylor_verify.records.quantities import MOMENTA
from taylor_verify.records.reason import Kind
from taylor_verify.scenes.library import names
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

_FEWEST_ROWS: Final = 3
# Rows are evenly spaced if no interval differs by more than this part.
_EVEN: Final = 1e-6
# A shift is known to this part at best, and to a few times the error that remains after it.
_KNOWN: Final = 1e-6
_LEAVES_TIMES: Final = 3.0
# The shift must be known well enough to recognise a whole number of steps.
_WHOLE: Final = 0.05
# The first rows are compared with the exact motion of scenes that have the same start, to this accuracy.
_FIRST_ROWS: Final = 5
_FITS: Final = 1e-2
_DIGITS: Final = 20


def other_rows(material: Material) -> Iterator[Candidate]:
    """Yield the number of rows or of steps that equals a constant shift of time."""
    spaces = np.diff(material.elapsed)
    if len(spaces) < _FEWEST_ROWS - 1 or np.ptp(spaces) > _EVEN * np.max(np.abs(spaces)):
        return
    for quantity, verdict in material.failed.items():
        shift = verdict.time_shift
        if verdict.shift != Kind.CONSTANT.value or not shift or not verdict.max:
            continue
        leaves = (verdict.remains or 0.0) / verdict.max
        doubt = max(_KNOWN, _LEAVES_TIMES * leaves)
        # Negative if row k is too old.
        steps = -float(np.mean(spaces)) / shift
        whole = round(steps)
        if abs(abs(steps) - 1) <= min(doubt, _WHOLE):
            other = "k+1" if steps > 0 else "k-1"
            why = f"row k holds the state of row {other}"
            yield Candidate("one row off", quantity, leaves, why)
        elif whole > 1 and whole * doubt <= _WHOLE and abs(steps - whole) <= whole * doubt:
            why = (
                f"every row holds the state a step of {abs(shift):.6g} later, {whole} of which make "
                "the time from row to row"
            )
            yield Candidate("first row stepped already", quantity, leaves, why)


def another_scene(material: Material, scene: Scene) -> Iterator[Candidate]:
    """Yield the shipped scenes of the same model that begin as the answer does."""
    own = material.start_error
    if own is None or not own > OFF:
        return
    for other in map(load, names(scene.model)):
        begins = replace(material, start=np.array(other.initial.moving, dtype=float))
        error = begins.start_error
        if other.clock.start != scene.clock.start or error is None or not error <= PRINTED:
            continue
        within = _error(material, other)
        if within <= _FITS:
            why = f"the rows fit {other.name} better ({material.quantity} within {within:.2g})"
        else:
            why = f"the row at the start is that of {other.name} (within {error:.2g}), those after it not"
        yield Candidate(
            "another scene", material.quantity, error / own, why, is_sure=within <= _FITS
        )


def _error(material: Material, scene: Scene) -> float:
    """Return the largest relative error of the rows near the start, as an answer to a scene."""
    order = np.argsort(np.abs(material.elapsed))[:_FIRST_ROWS]
    elapsed = [Fraction(float(material.elapsed[k])) for k in order]
    try:
        exact = solution(replace(scene, track=frozenset())).evaluate(elapsed, _DIGITS)
    except Unsettled:
        return np.inf
    errors = []
    for i, name in enumerate(MOMENTA[scene.model]):
        right = exact[name].astype(float)
        answer = material.states[order, 3 * i : 3 * i + 3]
        size = np.max(np.linalg.norm(right, axis=1)) or 1.0
        errors.append(float(np.max(np.linalg.norm(answer - right, axis=1)) / size))
    return max(errors)
