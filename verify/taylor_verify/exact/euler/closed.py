"""The closed form of a rigid body, chosen in exact rationals.

Each function imports what it needs: the two routes load different libraries.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from taylor_verify.exact.euler.fixed_axis import FixedAxis, in_balls, in_mpmath
from taylor_verify.exact.euler.moments.regime import LoadedSpin
from taylor_verify.exact.euler.moments.washboard.board import Washboard
from taylor_verify.exact.euler.moments.washboard.turnings import regime
from taylor_verify.exact.euler.regime import FreeSpin
from taylor_verify.exact.solution import NoClosedForm, Solution
from taylor_verify.numbers import tensors
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Quaternion, Spin
from taylor_verify.scenes.scene import Scene


def top(scene: Scene) -> tuple[RigidBody, Spin]:
    """Return a scene's rigid body and its spin; raises TypeError for another model."""
    if isinstance(scene.body, RigidBody) and isinstance(scene.initial, Spin):
        return scene.body, scene.initial
    raise TypeError(f"expected a scene of the model euler, got {scene.model} @ {scene.name}")


class _Forms(NamedTuple):
    """The closed forms of one route, by the kind of body."""

    free: Callable[[FreeSpin, Quaternion | None], Solution]
    loaded: Callable[[LoadedSpin, Quaternion | None], Solution]
    fixed_axis: Callable[[str, FixedAxis, Quaternion | None], Solution]
    washboard: Callable[[Washboard], Solution]


def enclosed(scene: Scene) -> Solution:
    """The motion in balls; raises NoClosedForm where anything tracked has none."""
    from taylor_verify.exact.euler import theta
    from taylor_verify.exact.euler.moments import erf
    from taylor_verify.exact.euler.moments.washboard import balls

    forms = _Forms(theta.free_rotation, erf.loaded_rotation, in_balls, balls.motion)
    return _solved(scene, forms)


def closed_form(scene: Scene) -> Solution:
    """The motion in mpmath; raises NoClosedForm likewise, and on a washboard."""
    from taylor_verify.exact.euler import jacobi
    from taylor_verify.exact.euler.moments import fresnel

    forms = _Forms(jacobi.free_rotation, fresnel.loaded_rotation, in_mpmath, _only_in_balls)
    return _solved(scene, forms)


def _only_in_balls(board: Washboard) -> Solution:
    raise NoClosedForm(
        "in mpmath, the integral under a moment along a principal axis; the second route is taylor"
    )


def _solved(scene: Scene, forms: _Forms) -> Solution:
    """The solution by the form that fits the body."""
    body, start = top(scene)
    attitude = start.attitude if "attitude" in scene.track else None
    spin = FreeSpin(body.inertia, start.omega)
    if body.is_free:
        return forms.free(spin, attitude)
    if spin.discriminant == 0 and any(tensors.plus(spin.torque, body.moment)):
        return forms.loaded(LoadedSpin(body.inertia, body.moment, start.omega), attitude)
    board = Washboard(body.inertia, body.moment, start.omega)
    if board.keeps_axis:
        axis = FixedAxis(board.omega, board.gain)
        return forms.fixed_axis(regime(board).value, axis, attitude)
    if attitude is not None:
        raise NoClosedForm(
            "the attitude of a body with three different moments of inertia under a moment"
        )
    return forms.washboard(board)
