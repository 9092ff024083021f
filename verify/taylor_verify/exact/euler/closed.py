"""The closed form of a rigid body, chosen in exact rationals.

Each function imports what it needs: the two routes load different libraries.
"""

from __future__ import annotations

from taylor_verify.exact.euler.fixed_axis import axis_under
from taylor_verify.exact.euler.regime import FreeSpin
from taylor_verify.exact.solution import NoClosedForm, Solution
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Quaternion, Spin
from taylor_verify.scenes.scene import Scene


def top(scene: Scene) -> tuple[RigidBody, Spin]:
    """Return a scene's rigid body and its spin; raises TypeError for another model."""
    if isinstance(scene.body, RigidBody) and isinstance(scene.initial, Spin):
        return scene.body, scene.initial
    raise TypeError(f"expected a scene of the model euler, got {scene.model} @ {scene.name}")


def enclosed(scene: Scene) -> Solution:
    """The motion in balls; raises NoClosedForm where anything tracked has none."""
    from taylor_verify.exact.euler.fixed_axis import in_balls
    from taylor_verify.exact.gyrostat.sigma import top_rotation

    body, start = top(scene)
    spin, attitude = FreeSpin(body.inertia, start.omega), _tracked(scene, start)
    if body.is_free:
        return top_rotation(spin, attitude)
    steady_axis = axis_under(spin, body.moment)
    if steady_axis is None:
        raise NoClosedForm("a constant moment turns the axis of rotation")
    return in_balls(*steady_axis, attitude)


def closed_form(scene: Scene) -> Solution | None:
    """The motion in mpmath; None under a moment."""
    from taylor_verify.exact.euler import jacobi

    body, start = top(scene)
    if not body.is_free:
        return None
    return jacobi.free_rotation(FreeSpin(body.inertia, start.omega), _tracked(scene, start))


def _tracked(scene: Scene, start: Spin) -> Quaternion | None:
    return start.attitude if "attitude" in scene.track else None
