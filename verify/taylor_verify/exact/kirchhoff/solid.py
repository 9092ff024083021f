"""The body and the start of a scene of this room."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction

from taylor_verify.exact.solution import Time, longest
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import floor_log2
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.scene import Scene


def solid(scene: Scene) -> tuple[ImmersedBody, Impulse]:
    """Return a scene's solid in a fluid and its impulses; raises TypeError for another model."""
    if isinstance(scene.body, ImmersedBody) and isinstance(scene.initial, Impulse):
        return scene.body, scene.initial
    raise TypeError(f"expected a scene of the model kirchhoff, got {scene.model} @ {scene.name}")


def velocities(body: ImmersedBody, start: Impulse) -> tuple[Vector, Vector]:
    """Return U and Omega at the start, in body axes."""
    both = tensors.apply(body.energy_matrix, start.linear + start.angular)
    return both[:3], both[3:]


def is_steady(body: ImmersedBody, start: Impulse) -> bool:
    """Return True if x and y stay as they are at the start, exactly, under the constant loads."""
    x, y = start.linear, start.angular
    U, Omega = velocities(body, start)
    force = tensors.plus(tensors.cross(x, Omega), body.force)
    torque = tensors.plus(tensors.cross(y, Omega), tensors.cross(x, U))
    return not any(force + tensors.plus(torque, body.couple))


def short_digits(U: Vector, start: Impulse, elapsed: Sequence[Time]) -> int:
    """The digits by which |y|/F, whose change is the way across F, exceeds the centre itself.

    Without them two precisions agree on a wrong centre where both lose the whole way. F is not zero, and U
    is the velocity at the start.
    """
    shortest = min((longest([t]) for t in elapsed if t != 0), default=Fraction(1))
    reached = tensors.dot(start.centre, start.centre) + tensors.dot(U, U) * shortest**2
    lever = tensors.dot(start.angular, start.angular) / tensors.dot(start.linear, start.linear)
    if not 0 < reached < lever:
        return 0
    return math.ceil(floor_log2(lever / reached) * math.log10(2) / 2)
