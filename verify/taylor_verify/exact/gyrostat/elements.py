"""Elements of a gyrostat's orbit: none without a closed form."""

from __future__ import annotations

from taylor_verify.exact.element import Elements
from taylor_verify.exact.solution import NO_CLOSED_FORM
from taylor_verify.scenes.scene import Scene


def elements(scene: Scene, digits: int) -> Elements:
    """No number; the regime says why."""
    del scene, digits
    return Elements(NO_CLOSED_FORM, (), ())
