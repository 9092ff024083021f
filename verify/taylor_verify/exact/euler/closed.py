"""The closed form of a rigid body, chosen in exact rationals.

Each function imports what it needs: the two routes load different libraries.
"""

from __future__ import annotations

from collections.abc import Callable

from taylor_verify.exact.euler.moments.regime import LoadedSpin
from taylor_verify.exact.euler.moments.washboard.board import Washboard
from taylor_verify.exact.euler.regime import FreeSpin
from taylor_verify.exact.solution import NoClosedForm, Solution
from taylor_verify.scenes import tensors
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
    from taylor_verify.exact.euler import theta
    from taylor_verify.exact.euler.moments import erf
    from taylor_verify.exact.euler.moments.washboard import balls

    return _solved(scene, theta.free_rotation, erf.loaded_rotation, balls.motion)


def closed_form(scene: Scene) -> Solution:
    """The motion in mpmath; raises NoClosedForm likewise."""
    from taylor_verify.exact.euler import jacobi
    from taylor_verify.exact.euler.moments import fresnel
    from taylor_verify.exact.euler.moments.washboard import chebyshev

    return _solved(scene, jacobi.free_rotation, fresnel.loaded_rotation, chebyshev.motion)


def _solved(
    scene: Scene,
    free: Callable[[FreeSpin, Quaternion | None], Solution],
    loaded: Callable[[LoadedSpin, Quaternion | None], Solution],
    washboard: Callable[[Washboard, Quaternion | None], Solution],
) -> Solution:
    """The solution by the one of these that fits the body."""
    body, start = top(scene)
    attitude = start.attitude if "attitude" in scene.track else None
    spin = FreeSpin(body.inertia, start.omega)
    if body.is_free:
        return free(spin, attitude)
    if spin.discriminant == 0 and any(tensors.plus(spin.torque, body.moment)):
        return loaded(LoadedSpin(body.inertia, body.moment, start.omega), attitude)
    board = Washboard(body.inertia, body.moment, start.omega)
    if attitude is not None and not board.keeps_axis:
        raise NoClosedForm(
            "the attitude of a body with three different moments of inertia under a moment"
        )
    return washboard(board, attitude)
