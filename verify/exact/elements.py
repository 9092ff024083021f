"""The elements of an orbit: period, modulus, stability, distance to the separatrix.

    elements(scene, digits)["period"].value

They belong to the scene's own exact numbers and to omega, or the two impulses, alone: attitude and
centre add nothing to them.
"""

from __future__ import annotations

from verify.exact.element import Element, Elements
from verify.exact.euler.elements import elements as euler_elements
from verify.exact.kirchhoff.elements import elements as kirchhoff_elements
from verify.scenes.bodies import RigidBody
from verify.scenes.scene import Scene

__all__ = ["Element", "Elements", "elements"]


def elements(scene: Scene, digits: int = 15) -> Elements:
    """Every element that the orbit of this scene has, to ``digits`` significant digits.

    Where there is no closed form it says so, and holds only what is exact without one. Raises
    exact.solution.Unsettled where the digits cannot be had.
    """
    if isinstance(scene.body, RigidBody):
        return euler_elements(scene, digits)
    return kirchhoff_elements(scene, digits)
