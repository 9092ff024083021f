"""The closed routes of a scene."""

from __future__ import annotations

from taylor_verify.exact.route import CLOSED_ROUTES, solution
from taylor_verify.exact.solution import NoClosedForm
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
