"""The closed form of a rigid body, chosen in exact rationals.

Each function imports what it needs: the two routes load different libraries.
"""

from __future__ import annotations

from taylor_verify.exact.euler.fixed_axis import axis_under
from taylor_verify.exact.euler.regime import FreeSpin
from taylor_verify.exact.solution import NoClosedForm, Solution
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Spin
from taylor_verify.scenes.scene import Scene


def top(scene: Scene) -> tuple[RigidBody, Spin]:
    """Return a scene's rigid body and its spin; raises TypeError for another model."""
    if isinstance(scene.body, RigidBody) and isinstance(scene.initial, Spin):
        return scene.body, scene.initial
    raise TypeError(f"expected a scene of the model euler, got {scene.model} @ {scene.name}")


def enclosed(scene: Scene) -> Solution:
    """The motion in balls; raises NoClosedForm where anything tracked has none."""
    from taylor_verify.exact.euler.fixed_axis import in_balls
    from taylor_verify.exact.gyrostat.pencil import FreeGyrostat
    from taylor_verify.exact.gyrostat.sigma import free_rotation, top_rotation

    body, start = top(scene)
    attitude = start.attitude if "attitude" in scene.track else None
    if any(body.rotor):
        if not body.is_free:
            raise NoClosedForm("a moment acts on a body with wheels")
        return free_rotation(FreeGyrostat(body.inertia, body.rotor, start.omega), attitude)
    spin = FreeSpin(body.inertia, start.omega)
    if body.is_free:
        return top_rotation(spin, attitude)
    steady_axis = axis_under(spin, body.moment)
    if steady_axis is None:
        raise NoClosedForm("a constant moment turns the axis of rotation")
    return in_balls(*steady_axis, attitude)


def closed_form(scene: Scene) -> Solution | None:
    """The motion in mpmath; None under a moment or with wheels."""
    from taylor_verify.exact.euler import jacobi

    body, start = top(scene)
    if not body.is_integrable:
        return None
    attitude = start.attitude if "attitude" in scene.track else None
    return jacobi.free_rotation(FreeSpin(body.inertia, start.omega), attitude)
