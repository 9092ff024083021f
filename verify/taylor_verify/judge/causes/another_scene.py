"""Shipped scenes that an answer fits, where its row at the start is not the scene's own."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from typing import Final

import numpy as np

from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Unsettled
from taylor_verify.judge.causes.candidate import Candidate
from taylor_verify.judge.causes.material import Material
from taylor_verify.judge.causes.readings import OFF, PRINTED
from taylor_verify.records.quantities import MOMENTA
from taylor_verify.scenes.library import names
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

# The first rows are compared with the exact motion of a scene that has the same start; to so much they fit.
_FIRST_ROWS: Final = 5
_FITS: Final = 1e-2
_DIGITS: Final = 20


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
    """The largest error of the rows about the start as an answer to a scene, over its largest state."""
    order = np.argsort(np.abs(material.elapsed))[:_FIRST_ROWS]
    elapsed = [Fraction(float(material.elapsed[k])) for k in order]
    try:
        exact = solution(replace(scene, track=frozenset())).evaluate(elapsed, _DIGITS)
    except Unsettled:
        return np.inf
    errors = []
    for i, name in enumerate(MOMENTA[scene.model]):
        right = exact[name].astype(float)
        got = material.states[order, 3 * i : 3 * i + 3]
        size = np.max(np.linalg.norm(right, axis=1)) or 1.0
        errors.append(float(np.max(np.linalg.norm(got - right, axis=1)) / size))
    return max(errors)
