"""The elements of the orbit of a solid in a fluid, about whatever axis and origin it is given."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Final

from taylor_verify.exact.element import Elements
from taylor_verify.exact.kirchhoff import clebsch_elements, general
from taylor_verify.exact.kirchhoff.axes import Axes, clebsch_about
from taylor_verify.exact.kirchhoff.displaced import centred
from taylor_verify.exact.kirchhoff.solid import solid
from taylor_verify.exact.kirchhoff.turned import upright
from taylor_verify.exact.manufactured import MANUFACTURED, REGIME
from taylor_verify.exact.solution import NO_CLOSED_FORM
from taylor_verify.scenes.precision import float_text
from taylor_verify.scenes.scene import Scene

_LOADED: Final = (
    "A force or a couple in body axes acts: no closed form is built, and the motion has neither a "
    "period nor a modulus that could be named.",
    "Not conserved: T, F^2 and FG change by the work and the impulse of the loads.",
)


def elements(scene: Scene, digits: int) -> Elements:
    """Every element that the orbit has, to ``digits`` significant digits."""
    body, _ = solid(scene)
    if body.manufactured is not None:
        return Elements(REGIME, (), MANUFACTURED)
    if not body.is_free:
        return Elements(NO_CLOSED_FORM, (), _LOADED)
    if body.axis_of_symmetry is None:
        oblique = clebsch_about(body)
        if oblique is None:
            return general.elements(scene, digits)
        return _oblique(oblique[1], clebsch_elements.elements(scene, digits))
    named_anew, axis = upright(scene)
    moved, distance = centred(named_anew)
    found = clebsch_elements.elements(moved, digits)
    if distance:
        place = (
            "T is of Clebsch's form about the point of axis 3 at "
            f"{float_text(distance)} from the origin: the body is solved there."
        )
        found = replace(found, sentences=(place, *found.sentences))
    return found if axis == 3 else _about(axis, found)


def _about(axis: int, found: Elements) -> Elements:
    """The elements with x3, y3 and axis 3 renamed to those of the axis of symmetry."""
    return _renamed(found, {third: f"{third[:-1]}{axis}" for third in ("x3", "y3", "axis 3")})


def _oblique(axes: Axes, found: Elements) -> Elements:
    """The elements with x3, y3 and axis 3 renamed to those of an axis that is no body axis."""
    direction = ", ".join(map(str, axes.n))
    place = (
        f"T is of Clebsch's form about the direction e along ({direction}): a body of revolution."
    )
    names = {"x3_": "xe_", "x3": "x.e", "y3": "y.e", "axis 3": "the axis e"}
    renamed = _renamed(found, names)
    return replace(renamed, sentences=(place, *renamed.sentences))


def _renamed(found: Elements, names: Mapping[str, str]) -> Elements:
    def renamed(text: str) -> str:
        for old, new in names.items():
            text = text.replace(old, new)
        return text

    numbers = tuple(
        replace(e, name=renamed(e.name), meaning=renamed(e.meaning), source=renamed(e.source))
        for e in found.numbers
    )
    return Elements(found.regime, numbers, tuple(map(renamed, found.sentences)))
