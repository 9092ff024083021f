"""The elements of an orbit: period, modulus, stability, distance to the separatrix.

    elements(scene, digits)["period"].value

They belong to the scene's own exact numbers and to omega, or the two impulses, alone: attitude and
centre add nothing to them.
"""

from __future__ import annotations

from dataclasses import replace

from taylor_verify.exact.element import Element, Elements
from taylor_verify.exact.euler.elements import elements as euler_elements
from taylor_verify.exact.kirchhoff.displaced import centred
from taylor_verify.exact.kirchhoff.elements import elements as kirchhoff_elements
from taylor_verify.exact.kirchhoff.turned import upright
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.precision import float_text
from taylor_verify.scenes.scene import Scene

__all__ = ["Element", "Elements", "elements"]


def elements(scene: Scene, digits: int = 15) -> Elements:
    """Every element that the orbit of this scene has, to ``digits`` significant digits.

    Where there is no closed form it says so, and holds only what is exact without one. Raises
    exact.solution.Unsettled where the digits cannot be had.
    """
    if isinstance(scene.body, RigidBody):
        return euler_elements(scene, digits)
    named_anew, axis = upright(scene)
    moved, distance = centred(named_anew)
    found = kirchhoff_elements(moved, digits)
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
