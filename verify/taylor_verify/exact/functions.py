"""Tracked quantities that follow from the others at each time: their exact values, and bounds of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Final, final

import numpy as np
from mpmath import mp, mpf

from taylor_verify.exact.invariant import Invariant
from taylor_verify.exact.rows import norms
from taylor_verify.exact.solution import Quantities, Solution
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.mpfr import in_mpfr, precision, to_mpf
from taylor_verify.scenes.scene import Scene

# Digits of the motion beyond those of a function of it.
_MORE_DIGITS: Final = 6

FUNCTIONS: Final[Mapping[str, Callable[[Scene], Invariant]]] = {}
"""Each such quantity with its value and its sensitivity, for a scene. None is conserved by intention."""


def functions(scene: Scene) -> list[Invariant]:
    """The quantities of a scene that follow from others, in reading order."""
    return [FUNCTIONS[each.name](scene) for each in scene.tracked if each.is_function]


def with_functions(scene: Scene, motion: Motion) -> Motion:
    """The motion with these quantities, whose error is twice the first-order effect of its own.

    What is quadratic in the radius of the motion is far less than the second half of that.
    """
    quantities, radii, errors = dict(motion.quantities), dict(motion.radii), dict(motion.errors)
    rows, count = in_mpfr(motion), len(motion.radius)
    for function in functions(scene):
        with precision():
            value = function.value(rows).reshape(count, -1)
            slopes = function.sensitivity(rows).values()
            steep = sum(norms(slope.reshape(count, -1)) for slope in slopes)
            size = sum(norms(part.reshape(count, -1)) for part in rows.quantities.values())
            wide, sizes = 2 * to_mpf(steep * size) * motion.radius, to_mpf(norms(value))
        quantities[function.name] = values = to_mpf(value)
        errors[function.name] = np.repeat(wide, values.shape[1]).reshape(values.shape)
        radii[function.name] = wide / np.array([norm or mpf(1) for norm in sizes], dtype=object)
    radius = np.maximum.reduce([motion.radius, *(radii[each.name] for each in functions(scene))])
    return replace(motion, quantities=quantities, radius=radius, radii=radii, errors=errors)


@final
class WithFunctions(Solution):
    """The solution of a scene's motion, and what follows from it at each time."""

    def __init__(self, scene: Scene, moving: Solution) -> None:
        self._scene, self._moving = scene, moving
        self.regime, self.by_periods = moving.regime, moving.by_periods

    @property
    def route(self) -> str:  # type: ignore[override]
        return self._moving.route

    def motion(self, elapsed: Sequence[Fraction], digits: int) -> Motion:
        motion = self._moving.motion(elapsed, digits + _MORE_DIGITS)
        with mp.workdps(digits + 2 * _MORE_DIGITS):
            return with_functions(self._scene, motion)

    def evaluate(self, elapsed: Sequence[Fraction], digits: int) -> Quantities:
        return self.motion(elapsed, digits).quantities
