"""Which closed form answers a rigid body: chosen in exact rationals.

Each function imports what it needs: the two routes load different libraries.
"""

from __future__ import annotations

from taylor_verify.exact.euler.moments.washboard.board import Washboard
from taylor_verify.exact.euler.regime import FreeSpin
from taylor_verify.exact.euler.top import top
from taylor_verify.exact.solution import NoClosedForm, Solution
from taylor_verify.scenes.motion import Quaternion
from taylor_verify.scenes.scene import Scene


def enclosed(scene: Scene) -> Solution:
    """The motion in balls; raises NoClosedForm where anything tracked has none."""
    from taylor_verify.exact.euler import theta
    from taylor_verify.exact.euler.moments import erf
    from taylor_verify.exact.euler.moments.fixed_axis import FixedAxisBalls
    from taylor_verify.exact.euler.moments.washboard.balls import WashboardBalls

    if scene.body.is_free:
        return theta.enclosed(scene)
    board = _board(scene)
    if board is None:
        return erf.enclosed(scene)
    if _keeps_axis(board):
        return FixedAxisBalls(board, _attitude(scene))
    _refuse_attitude(scene)
    return WashboardBalls(board)


def closed_form(scene: Scene) -> Solution:
    """The motion in mpmath; raises NoClosedForm likewise."""
    from taylor_verify.exact.euler import jacobi
    from taylor_verify.exact.euler.moments import fresnel
    from taylor_verify.exact.euler.moments.fixed_axis import FixedAxis
    from taylor_verify.exact.euler.moments.washboard.chebyshev import WashboardMotion

    if scene.body.is_free:
        return jacobi.closed_form(scene)
    board = _board(scene)
    if board is None:
        return fresnel.closed_form(scene)
    if _keeps_axis(board):
        return FixedAxis(board, _attitude(scene))
    _refuse_attitude(scene)
    return WashboardMotion(board)


def _board(scene: Scene) -> Washboard | None:
    """The exact data of a body with three different moments of inertia; None for two equal ones."""
    body, spin = top(scene)
    if FreeSpin(body.inertia, spin.omega).discriminant == 0:
        return None
    return Washboard(body.inertia, body.moment, spin.omega)


def _keeps_axis(board: Washboard) -> bool:
    return board.is_steady or board.is_straight


def _attitude(scene: Scene) -> Quaternion | None:
    """The attitude at the start where it is tracked."""
    return scene.initial.attitude if "attitude" in scene.track else None


def _refuse_attitude(scene: Scene) -> None:
    """Raise NoClosedForm for an attitude."""
    if "attitude" in scene.track:
        raise NoClosedForm(
            "the attitude of a body with three different moments of inertia under a moment"
        )
