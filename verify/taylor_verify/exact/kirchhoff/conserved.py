"""What every free motion of a solid in a fluid keeps, as elements of its orbit."""

from __future__ import annotations

from mpmath import mp

from taylor_verify.exact.element import Element
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse


def conserved(body: ImmersedBody, start: Impulse) -> list[Element]:
    """T, F and G; G only where there is an F."""
    x, y = start.linear, start.angular
    state = x + y
    T = tensors.dot(state, tensors.apply(body.energy_matrix, state)) / 2
    found = [
        Element("T", mp.convert(T), "energy", "kinetic energy, conserved", "Hydromechanics 48 (i)")
    ]
    F2, FG = tensors.dot(x, x), tensors.dot(x, y)
    F = mp.sqrt(mp.convert(F2))
    found.append(
        Element("F", F, "impulse", "linear impulse |x|, conserved", "Hydromechanics 48 (ii)")
    )
    if F2:
        G = mp.convert(FG) / F
        meaning = "angular impulse along F, x.y/F, conserved"
        found.append(Element("G", G, "angular impulse", meaning, "Hydromechanics 48 (iii)"))
    return found
