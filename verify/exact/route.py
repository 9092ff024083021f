"""Which route leads to the truth of a scene: a closed form where there is one, else Taylor."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Final

from verify.exact.solution import NoClosedForm, Solution
from verify.exact.taylor import TaylorSolution
from verify.scenes.scene import Scene

CLOSED_ROUTES: Final = ("arb", "mpmath")
# Each answers a scene or raises NoClosedForm. Imported when asked for: they load different libraries.
_CLOSED_FORMS: Final[Mapping[tuple[str, str], str]] = {
    ("euler", "arb"): "verify.exact.euler.theta:enclosed",
    ("euler", "mpmath"): "verify.exact.euler.jacobi:closed_form",
    ("kirchhoff", "arb"): "verify.exact.kirchhoff.weierstrass:enclosed",
    ("kirchhoff", "mpmath"): "verify.exact.kirchhoff.jacobi:closed_form",
}


def solution(scene: Scene, route: str | None = None) -> Solution:
    """The exact solution of a scene: balls where every tracked quantity has a closed form, else Taylor.

    With ``route="arb"`` or ``"mpmath"`` only a closed form is accepted, and NoClosedForm is raised
    where it is missing; ``route="taylor"`` takes the Taylor recursion in any case.
    """
    if route == "taylor":
        return TaylorSolution(scene)
    if route is not None:
        return _closed_form(scene, route)
    try:
        return _closed_form(scene, "arb")
    except NoClosedForm:
        return TaylorSolution(scene)


def _closed_form(scene: Scene, route: str) -> Solution:
    module, name = _CLOSED_FORMS[scene.model, route].split(":")
    make: Callable[[Scene], Solution] = getattr(import_module(module), name)
    return make(scene)
