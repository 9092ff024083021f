"""The body and the start of a scene of this room."""

from __future__ import annotations

from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import Vector


def solid(scene: Scene) -> tuple[ImmersedBody, Impulse]:
    """Return a scene's solid in a fluid and its impulses; raises TypeError for another model."""
    if isinstance(scene.body, ImmersedBody) and isinstance(scene.initial, Impulse):
        return scene.body, scene.initial
    raise TypeError(f"expected a scene of the model kirchhoff, got {scene.model} @ {scene.name}")


def velocities(body: ImmersedBody, start: Impulse) -> tuple[Vector, Vector]:
    """Return U and Omega at the start, in body axes."""
    both = tensors.apply(body.energy_matrix, start.linear + start.angular)
    return both[:3], both[3:]
