"""The body and the start of a scene of this room."""

from __future__ import annotations

from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Spin
from taylor_verify.scenes.scene import Scene


def top(scene: Scene) -> tuple[RigidBody, Spin]:
    """Return a scene's rigid body and its spin; raises TypeError for another model."""
    if isinstance(scene.body, RigidBody) and isinstance(scene.initial, Spin):
        return scene.body, scene.initial
    raise TypeError(f"expected a scene of the model euler, got {scene.model} @ {scene.name}")
