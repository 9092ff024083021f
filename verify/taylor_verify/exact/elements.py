"""The elements of an orbit: period, modulus, stability, distance to the separatrix.

    elements(scene, digits)["period"].value

They belong to the scene's own exact numbers and to omega, or the two impulses, alone: attitude and
centre add nothing to them.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from mpmath import mp

from taylor_verify.exact.as_written import as_written
from taylor_verify.exact.damping import NOT_QUADRATIC, is_solved
from taylor_verify.exact.element import Element, Elements
from taylor_verify.exact.registry import function_at, kind_of
from taylor_verify.exact.solution import NO_CLOSED_FORM
from taylor_verify.numbers.irrational import Undecided
from taylor_verify.scenes.scene import Scene

__all__ = ["Element", "Elements", "elements"]

_SLOWED: Final = (
    "Damped: the momenta are e^{-ct} times those of the body without damping at the time tau, and "
    "attitude and centre are its own, with tau = (1 - e^{-ct})/c since the start. Every time and rate here "
    "is counted in tau."
)
_FAR: Final = (
    "Not conserved: T and the momenta change by the work and impulse of the damping and the loads."
)


def elements(scene: Scene, digits: int = 15) -> Elements:
    """Return the elements of the scene's orbit, to ``digits`` significant digits.

    Without a closed form there are only the elements that are exact without one. Raises
    exact.solution.Unsettled if the digits cannot be reached.
    """
    scene = as_written(scene)
    if scene.body.damping and scene.body.loads is None:
        return _damped(scene, digits)
    module = f"{kind_of(scene.body).room}.elements"
    if scene.body.loads is not None:
        module = "taylor_verify.exact.euler.heavy_elements"
    try:
        result: Elements = function_at(f"{module}:elements")(scene, digits)
    except Undecided as doubt:
        return Elements(NO_CLOSED_FORM, (), (f"The kind of motion is not decided: {doubt}.",))
    return result


def _damped(scene: Scene, digits: int) -> Elements:
    """Return the elements of the undamped motion, and the part of it that the damped body performs."""
    damping = scene.body.damping
    if not is_solved(scene):
        story = f"No closed form is built for {NOT_QUADRATIC}."
        return Elements(NO_CLOSED_FORM, (), (story, _FAR))
    free = elements(replace(scene, body=scene.body.undamped), digits)
    numbers = [replace(element, meaning=_at_the_start(element)) for element in free.numbers]
    if damping > 0:
        with mp.workdps(digits):
            horizon = 1 / mp.convert(damping)
            meaning = "tau never reaches it: the motion without damping up to here is all there is"
            numbers.append(Element("horizon", horizon, "time", meaning, "1/c"))
            if "period" in free:
                meaning = "periods of the motion without damping until the body is at rest"
                turns = horizon / free["period"].value
                numbers.append(Element("periods_to_rest", turns, "", meaning, "1/(c period)"))
    sentences = (
        element.replace("Conserved:", "Conserved, of e^{ct} times the momenta:")
        for element in free.sentences
    )
    return Elements(free.regime, tuple(numbers), (_SLOWED, *sentences))


def _at_the_start(element: Element) -> str:
    """The meaning of what is conserved but for damping: its value at the start."""
    return element.meaning.replace(
        ", conserved", " at the start, of e^{ct} times the momenta conserved"
    )
