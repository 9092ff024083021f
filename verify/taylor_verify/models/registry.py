"""The table of the mechanics of every kind of body, by the class of a body."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from taylor_verify.models.damping import Damped
from taylor_verify.models.driven import driven
from taylor_verify.models.immersed import Immersed
from taylor_verify.models.mechanics import Mechanics
from taylor_verify.models.rigid import Rigid
from taylor_verify.models.units import Units
from taylor_verify.scenes.bodies import Body, ImmersedBody, RigidBody
from taylor_verify.scenes.scene import Scene

_MECHANICS: Final[Mapping[type[Body], Mechanics[Any, Any]]] = {
    RigidBody: Rigid(),
    ImmersedBody: Immersed(),
}


def mechanics(body: Body) -> Mechanics[Any, Any]:
    """Return the mechanics of a body."""
    undamped = _MECHANICS[type(body)]
    return Damped(undamped) if body.damping else undamped


def natural_units(scene: Scene) -> Units:
    """Return the units in which the initial state and the fastest rate are of order one."""
    clock = scene.clock
    # The instants are monotonic, so one of the two ends is farthest from the start.
    span = max(abs(clock.instants[end] - clock.start) for end in (0, -1))
    units = mechanics(scene.body).units(scene.body, scene.initial, span)
    return units if scene.body.loads is None else driven(units, scene, span)
