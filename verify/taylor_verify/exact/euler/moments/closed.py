"""Which closed form answers a rigid body under a constant moment: chosen in exact rationals."""

from __future__ import annotations

from taylor_verify.exact.euler.moments.washboard import Washboard, is_triaxial, washboard
from taylor_verify.exact.solution import NoClosedForm, Solution
from taylor_verify.scenes.motion import Quaternion
from taylor_verify.scenes.scene import Scene


def enclosed(scene: Scene) -> Solution:
    """The motion in balls; raises NoClosedForm where anything tracked has none."""
    if not is_triaxial(scene):
        from taylor_verify.exact.euler.moments import erf

        return erf.enclosed(scene)
    board = washboard(scene)
    if _keeps_axis(board):
        from taylor_verify.exact.euler.moments.fixed_axis import FixedAxisBalls

        return FixedAxisBalls(board, _attitude(scene))
    _refuse_what_has_none(scene)
    from taylor_verify.exact.euler.moments.washboard_balls import WashboardBalls

    return WashboardBalls(board)


def closed_form(scene: Scene) -> Solution:
    """The motion in mpmath; raises NoClosedForm likewise."""
    if not is_triaxial(scene):
        from taylor_verify.exact.euler.moments import fresnel

        return fresnel.closed_form(scene)
    board = washboard(scene)
    if _keeps_axis(board):
        from taylor_verify.exact.euler.moments.fixed_axis import FixedAxis

        return FixedAxis(board, _attitude(scene))
    _refuse_what_has_none(scene)
    from taylor_verify.exact.euler.moments.washboard_chebyshev import WashboardMotion

    return WashboardMotion(board)


def _keeps_axis(board: Washboard) -> bool:
    return board.is_steady or board.is_straight


def _attitude(scene: Scene) -> Quaternion | None:
    """The attitude at the start where it is tracked."""
    return scene.initial.attitude if "attitude" in scene.track else None


def _refuse_what_has_none(scene: Scene) -> None:
    """Raise NoClosedForm for an attitude."""
    if "attitude" in scene.track:
        raise NoClosedForm(
            "the attitude of a body with three different moments of inertia under a moment"
        )
