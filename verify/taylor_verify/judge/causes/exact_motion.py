"""The exact motion of a scene as rows of float64."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Any, Final

import numpy as np

from taylor_verify.exact.route import solution
from taylor_verify.judge.causes.answer import Motion, steady_signs
from taylor_verify.judge.conventions.axes import quaternion_columns
from taylor_verify.records.quantities import MOMENTA
from taylor_verify.scenes.scene import Scene

_DIGITS: Final = 20


class ExactMotion:
    """The exact motion of a scene with its attitude, and with its centre if it ``has_centre``."""

    def __init__(self, scene: Scene, has_centre: bool) -> None:
        self._scene = scene
        track = frozenset({"attitude", *["centre"] * has_centre})
        self._exact = solution(replace(scene, track=track))

    @property
    def has_closed_form(self) -> bool:
        return self._exact.route != "taylor"

    def at(self, elapsed: list[Fraction], has_momenta: bool) -> Motion:
        """Return the rows at these times since the start, with momenta or velocities. Raises Unsettled."""
        rows = self._exact.evaluate(elapsed, _DIGITS)
        q = steady_signs(quaternion_columns(rows["attitude"].astype(float)))
        c = rows["centre"].astype(float) if "centre" in rows else None
        return Motion(self._moving(rows, has_momenta), q, c)

    def _moving(self, rows: Mapping[str, Any], has_momenta: bool) -> Any:
        scene = self._scene
        v = np.hstack([rows[name].astype(float) for name in MOMENTA[scene.model]])
        if scene.model == "kirchhoff" and not has_momenta:
            return v @ np.array(scene.body.energy_matrix, dtype=float).T
        return v
