"""The closed routes of a scene."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from mpmath import mp, mpf

from builders.numbers import apart
from taylor_verify.exact.route import CLOSED_ROUTES, solution
from taylor_verify.exact.solution import NoClosedForm
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.scene import Scene


def has_route(scene: Scene, route: str) -> bool:
    """True if the scene has a closed form by this route."""
    try:
        solution(scene, route)
    except NoClosedForm:
        return False
    return True


def closed_routes(scene: Scene) -> list[str]:
    """The routes by which a scene has a closed form: balls, mpmath where it has one, or none."""
    return [route for route in CLOSED_ROUTES if has_route(scene, route)]


def motions_of_taylor(
    scene: Scene, regime: str, times: Sequence[Fraction], digits: int
) -> list[Motion]:
    """Return the motion by each closed route, which has this regime and all digits of the enclosed one."""
    truth, motions = solution(scene, "taylor").motion(times, digits), []
    for route in closed_routes(scene):
        exact = solution(scene, route)
        assert (exact.regime, exact.route) == (regime, route)
        motions.append(exact.motion(times, digits))
        with mp.workdps(2 * digits + 20):
            assert apart(motions[-1], truth) <= 2 * mpf(10) ** -digits
    return motions
