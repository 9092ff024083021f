"""Which route leads to the truth of a scene: a closed form where there is one, else Taylor."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

from verify.exact.euler.jacobi import closed_form as euler_closed_form
from verify.exact.kirchhoff.jacobi import closed_form as kirchhoff_closed_form
from verify.exact.solution import NoClosedForm, Solution
from verify.exact.taylor import TaylorSolution
from verify.scenes.scene import Scene

_CLOSED_FORMS: Final[Mapping[str, Callable[[Scene], Solution]]] = {
    "euler": euler_closed_form,
    "kirchhoff": kirchhoff_closed_form,
}


def solution(scene: Scene, route: str | None = None) -> Solution:
    """The exact solution of a scene: the closed form where every tracked quantity has one, else Taylor.

    With ``route="mpmath"`` only the closed form is accepted, and NoClosedForm is raised where it is
    missing; ``route="taylor"`` takes the Taylor recursion in any case.
    """
    if route == "taylor":
        return TaylorSolution(scene)
    try:
        return _CLOSED_FORMS[scene.model](scene)
    except NoClosedForm:
        if route is not None:
            raise
        return TaylorSolution(scene)
