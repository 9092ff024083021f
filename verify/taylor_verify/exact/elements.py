"""The elements of an orbit: period, modulus, stability, distance to the separatrix.

    elements(scene, digits)["period"].value

They belong to the scene's own exact numbers and to omega, or the two impulses, alone: attitude and
centre add nothing to them.
"""

from __future__ import annotations

from taylor_verify.exact.element import Element, Elements
from taylor_verify.exact.registry import function_at, kind_of
from taylor_verify.scenes.scene import Scene

__all__ = ["Element", "Elements", "elements"]


def elements(scene: Scene, digits: int = 15) -> Elements:
    """Every element that the orbit of this scene has, to ``digits`` significant digits.

    Where there is no closed form it says so, and holds only what is exact without one. Raises
    exact.solution.Unsettled where the digits cannot be had.
    """
    found: Elements = function_at(f"{kind_of(scene.body).room}.elements:elements")(scene, digits)
    return found
