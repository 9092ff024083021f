"""Loads that a scene writes down, and its own states, at the times of a course."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from taylor_verify.draw.view import Numbers
from taylor_verify.exact.row_arithmetic import quaternions
from taylor_verify.models.acting import Acting
from taylor_verify.scenes.loads.loads import VECTORS, Loads
from taylor_verify.scenes.loads.states import Held
from taylor_verify.scenes.scene import Scene

Document = dict[str, Any]


def acting_on(scene: Scene, course: Mapping[str, Any]) -> list[Document]:
    """Return a document for each load and each own state: its name, its rows, and whether it is held."""
    loads = scene.body.loads
    if loads is None:
        return []
    forces = _forces(scene, loads, course)
    names = VECTORS[scene.model]
    acting = [
        {"name": name, "rows": forces[:, 3 * k : 3 * k + 3].tolist(), "is_held": False}
        for k, name in enumerate(names)
    ]
    return acting + [
        {"name": state.name, "rows": course[state.name], "is_held": isinstance(state, Held)}
        for state in loads.states
    ]


def _forces(scene: Scene, loads: Loads, course: Mapping[str, Any]) -> Numbers:
    """Return the loads in body axes, (times, 3) or (times, 6)."""
    moving = [np.array(course[name]) for name in scene.initial.MOVING]
    turns = quaternions(np.array(course["attitude"]), scene.initial.attitude)
    centre = [np.array(course["centre"])] if "centre" in course else []
    own = [np.array(course[s.name]) for s in loads.states if not isinstance(s, Held)]
    held_states = [np.array(course[s.name]) for s in loads.states if isinstance(s, Held)]
    taken = np.hstack(held_states) if held_states else None
    state = np.hstack([*moving, turns, *centre, *own])
    return Acting(scene, loads).loads(course["t"], state, taken)
