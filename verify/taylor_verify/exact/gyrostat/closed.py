"""Closed forms of a gyrostat: none is written yet, and the enclosed series answer."""

from __future__ import annotations

from taylor_verify.exact.solution import NoClosedForm, Solution
from taylor_verify.scenes.scene import Scene


def enclosed(scene: Scene) -> Solution:
    """Raise NoClosedForm: Weierstrass' functions are the next step."""
    raise NoClosedForm(f"no closed form of a gyrostat is written here @ {scene.name}")


closed_form = enclosed
