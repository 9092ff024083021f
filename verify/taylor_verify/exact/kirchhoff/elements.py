"""The elements of the orbit of a solid in a fluid, about whatever axis and origin it is given."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from taylor_verify.exact.element import Elements
from taylor_verify.exact.kirchhoff import clebsch_elements, general
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
        return general.elements(scene, digits)
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

    def renamed(text: str) -> str:
        for third in ("x3", "y3", "axis 3"):
            text = text.replace(third, f"{third[:-1]}{axis}")
        return text

    numbers = tuple(
        replace(e, name=renamed(e.name), meaning=renamed(e.meaning), source=renamed(e.source))
        for e in found.numbers
    )
    return Elements(found.regime, numbers, tuple(map(renamed, found.sentences)))
