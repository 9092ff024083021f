"""The body and the start of a scene of this room."""

from __future__ import annotations

from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.scene import Scene


def solid(scene: Scene) -> tuple[ImmersedBody, Impulse]:
    """Return a scene's solid in a fluid and its impulses; raises TypeError for another model."""
    if isinstance(scene.body, ImmersedBody) and isinstance(scene.initial, Impulse):
        return scene.body, scene.initial
    raise TypeError(f"expected a scene of the model kirchhoff, got {scene.model} @ {scene.name}")
