"""Which route leads to the truth of a scene: a closed form where there is one, else Taylor."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Final

from taylor_verify.exact.solution import NoClosedForm, Solution
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.scenes.faults import brief
from taylor_verify.scenes.scene import Scene

CLOSED_ROUTES: Final = ("arb", "mpmath")
# Each answers a scene or raises NoClosedForm. Imported when asked for: they load different libraries.
_CLOSED_FORMS: Final[Mapping[tuple[str, str], str]] = {
    ("euler", "arb"): "taylor_verify.exact.euler.theta:enclosed",
    ("euler", "mpmath"): "taylor_verify.exact.euler.jacobi:closed_form",
    ("kirchhoff", "arb"): "taylor_verify.exact.kirchhoff.weber.enclosure:enclosed",
    ("kirchhoff", "mpmath"): "taylor_verify.exact.kirchhoff.weber.sums:closed_form",
}
# The same for a rigid body under a constant moment.
_LOADED: Final[Mapping[str, str]] = {
    "arb": "taylor_verify.exact.euler.moments.closed:enclosed",
    "mpmath": "taylor_verify.exact.euler.moments.closed:closed_form",
}
# The same for a body with a manufactured motion, of either model.
_MANUFACTURED: Final[Mapping[str, str]] = {
    "arb": "taylor_verify.exact.manufactured:enclosed",
    "mpmath": "taylor_verify.exact.manufactured:doubled",
}


def solution(scene: Scene, route: str | None = None) -> Solution:
    """The exact solution of a scene: balls where every tracked quantity has a closed form, else Taylor.

    With ``route="arb"`` or ``"mpmath"`` only a closed form is accepted, and NoClosedForm is raised
    where it is missing; ``route="taylor"`` takes Taylor series in any case.
    """
    if route == "taylor":
        return TaylorSolution(scene)
    if route in CLOSED_ROUTES:
        return _closed_form(scene, route)
    if route is not None:
        known = ", ".join((*CLOSED_ROUTES, "taylor"))
        raise ValueError(f"expected a route ({known}), got {brief(route)}")
    try:
        return _closed_form(scene, "arb")
    except NoClosedForm:
        return TaylorSolution(scene)


def _closed_form(scene: Scene, route: str) -> Solution:
    if scene.body.manufactured is not None:
        place = _MANUFACTURED[route]
    elif scene.model == "euler" and not scene.body.is_free:
        place = _LOADED[route]
    else:
        place = _CLOSED_FORMS[scene.model, route]
    module, name = place.split(":")
    make: Callable[[Scene], Solution] = getattr(import_module(module), name)
    return make(scene)
