"""The elements of the orbit of a solid in a fluid, about whatever axis and origin it is given."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final

from taylor_verify.exact.element import Elements
from taylor_verify.exact.kirchhoff import any_solid, clebsch_elements
from taylor_verify.exact.kirchhoff.axis_of_revolution import Axes
from taylor_verify.exact.kirchhoff.closed import Case, case
from taylor_verify.exact.kirchhoff.quartic import Nutation
from taylor_verify.exact.kirchhoff.solid import solid
from taylor_verify.exact.solution import NO_CLOSED_FORM, NoClosedForm
from taylor_verify.scenes.scene import Scene

_LOADED: Final = (
    "A force or a couple in body axes acts: no closed form is built, and the motion has neither a "
    "period nor a modulus that could be named.",
    "Not conserved: T, F^2 and FG change by the work and the impulse of the loads.",
)


def elements(scene: Scene, digits: int) -> Elements:
    """Return the elements of the orbit, to ``digits`` significant digits."""
    body, _ = solid(scene)
    impulses, whole = _case(replace(scene, track=frozenset())), _case(scene)
    if impulses is None and not body.is_free:
        return Elements(NO_CLOSED_FORM, (), _LOADED)
    if impulses is not None and isinstance(impulses.subject, Nutation):
        result = clebsch_elements.elements(impulses.reduced.scene, digits)
        axes = impulses.subject.axes
        if axes.number is None:
            result = _oblique(axes, result)
        else:
            result = result if axes.is_upright else _about(axes.number, result)
            if body.axis_of_symmetry is None:
                result = _beside(result, f"y{axes.number}")
    else:
        kind = NO_CLOSED_FORM if whole is None else whole.regime
        result = any_solid.elements(scene, impulses, kind, digits)
    solved = whole or impulses
    words = () if solved is None else solved.reduced.words
    return replace(result, sentences=(*_reductions(words), *result.sentences))


def _case(scene: Scene) -> Case | None:
    try:
        return case(scene)
    except NoClosedForm:
        return None


def _reductions(words: Sequence[str]) -> list[str]:
    """A sentence on the coordinates in which a motion is solved; none where they are its own."""
    return [f"Solved {'; '.join(words)}."] if words else []


def _beside(orbit_elements: Elements, y: str) -> Elements:
    """The elements of a body whose axis does not pass through the origin of the scene."""
    sentences = (
        line.replace(f"body, {y};", f"body, {y} about that origin;")
        for line in orbit_elements.sentences
    )
    return replace(orbit_elements, sentences=tuple(sentences))


def _about(axis: int, orbit_elements: Elements) -> Elements:
    """The elements with x3, y3 and axis 3 renamed to those of the axis of symmetry."""
    return _renamed(
        orbit_elements, {third: f"{third[:-1]}{axis}" for third in ("x3", "y3", "axis 3")}
    )


def _oblique(axes: Axes, orbit_elements: Elements) -> Elements:
    """The elements with x3, y3 and axis 3 renamed to those of an axis that is no body axis."""
    direction = ", ".join(map(str, axes.n))
    place = (
        f"T is of Clebsch's form about the direction e along ({direction}): a body of revolution."
    )
    names = {"x3_": "xe_", "x3": "x.e", "y3": "y.e", "axis 3": "the axis e"}
    renamed = _renamed(orbit_elements, names)
    return replace(renamed, sentences=(place, *renamed.sentences))


def _renamed(orbit_elements: Elements, names: Mapping[str, str]) -> Elements:
    def renamed(text: str) -> str:
        for old, new in names.items():
            text = text.replace(old, new)
        return text

    numbers = tuple(
        replace(e, name=renamed(e.name), meaning=renamed(e.meaning), source=renamed(e.source))
        for e in orbit_elements.numbers
    )
    return Elements(orbit_elements.regime, numbers, tuple(map(renamed, orbit_elements.sentences)))
