"""The motion of a scene in float64: quick where an enclosure is slow, to try many times or many scenes.

What is found by it is asked again of the exact motion.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.many_flows import Floats, flow
from taylor_verify.judge.causes.material import are_known, equations_of
from taylor_verify.judge.conventions.axis_orders import quaternion_columns
from taylor_verify.judge.conventions.meanings import rotations
from taylor_verify.records.quantities import MOMENTA
from taylor_verify.scenes.scene import Scene

# Steps of half a radian are doubled, as often as this, until the ends change by less than this part.
_STEP: Final = 0.5
_DOUBLINGS: Final = 3
_SETTLED: Final = 1e-6
_FEWEST: Final = 4
_MOST: Final = 512


def quick_motion(
    scene: Scene, known: Mapping[str, Any], since: Floats, times: Floats
) -> dict[str, Floats] | None:
    """Return the motion of a rounded scene at ``times``, each from the nearest of the rows at ``since``.

    ``known`` has the rows by quantity, as the motion that is returned. Times are since the start of the
    scene. None where the body has loads or terms of its own; NaN where float64 does not follow.
    """
    names = MOMENTA[scene.model]
    if scene.body.loads is not None or not are_known(scene.body) or not set(names) <= set(known):
        return None
    right = equations_of(scene, has_momenta=scene.model == "kirchhoff")
    groups = (*names, "attitude", "centre")
    rows = {name: np.asarray(known[name].astype(float)) for name in groups if name in known}
    if "attitude" in rows:
        q = quaternion_columns(rows["attitude"])
        rows["attitude"] = q / np.linalg.norm(q, axis=1, keepdims=True)
    nearest = np.argmin(np.abs(times[:, None] - since[None, :]), axis=1)
    begin, begins = np.hstack([*rows.values()])[nearest].T[None], since[nearest]
    omega, spans = right.velocities(begins, begin)[0, -3:], times - begins
    turn = np.max(np.linalg.norm(omega, axis=0) * np.abs(spans))
    if not turn < np.inf:
        return None
    with np.errstate(all="ignore"):
        ends = _settled(
            lambda steps: flow(right.rates, begin, begins, spans, steps)[0].T,
            int(min(max(np.ceil(turn / _STEP), _FEWEST), _MOST)),
        )
    edges = np.cumsum([part.shape[1] for part in rows.values()])[:-1]
    motion = dict(zip(rows, np.split(ends, edges, axis=1), strict=True))
    if "attitude" in motion:
        motion["attitude"] = rotations(motion["attitude"])
    return motion


def _settled(ends: Callable[[int], Floats], steps: int) -> Floats:
    """Return the ends of as many steps as they need; NaN where the most are too few."""
    after = ends(steps)
    has_settled = np.zeros(len(after), dtype=bool)
    for _ in range(_DOUBLINGS):
        steps, before = 2 * steps, after
        after = ends(steps)
        has_settled = np.all(
            np.abs(after - before) <= _SETTLED * np.nanmax(np.abs(after), axis=0), axis=1
        )
        if np.all(has_settled):
            break
    return np.where(has_settled[:, None], after, np.nan)
