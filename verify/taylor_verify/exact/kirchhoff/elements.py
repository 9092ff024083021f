"""The elements of the orbit of a solid in a fluid, about whatever axis and origin it is given."""

from __future__ import annotations

from dataclasses import replace

from taylor_verify.exact.element import Elements
from taylor_verify.exact.kirchhoff.clebsch_elements import elements as about_axis_3
from taylor_verify.exact.kirchhoff.displaced import centred
from taylor_verify.exact.kirchhoff.turned import upright
from taylor_verify.scenes.precision import float_text
from taylor_verify.scenes.scene import Scene


def elements(scene: Scene, digits: int) -> Elements:
    """Every element that the orbit has, to ``digits`` significant digits."""
    named_anew, axis = upright(scene)
    moved, distance = centred(named_anew)
    found = about_axis_3(moved, digits)
    if distance:
        told = (
            "T is of Clebsch's form about the point of axis 3 at "
            f"{float_text(distance)} from the origin: the body is solved there."
        )
        found = replace(found, sentences=(told, *found.sentences))
    return found if axis == 3 else _about(axis, found)


def _about(axis: int, found: Elements) -> Elements:
    """What is told of x3, y3 and the axis 3, told of the body axis that is the axis of symmetry."""

    def told(text: str) -> str:
        for of_third in ("x3", "y3", "axis 3"):
            text = text.replace(of_third, f"{of_third[:-1]}{axis}")
        return text

    numbers = tuple(
        replace(
            element,
            name=told(element.name),
            meaning=told(element.meaning),
            source=told(element.source),
        )
        for element in found.numbers
    )
    return Elements(found.regime, numbers, tuple(map(told, found.sentences)))
