"""Tracked quantities that follow from the others at each time: their exact values, and bounds of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import Any, Final, final

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


def values(scene: Scene, motion: Motion) -> dict[str, np.ndarray[Any, Any]]:
    """The values of these quantities at every row of a motion (n, components)."""
    rows = in_mpfr(motion)
    with precision():
        formed = {each.name: each.value(rows) for each in functions(scene)}
        return {name: to_mpf(column.reshape(len(column), -1)) for name, column in formed.items()}


def with_functions(scene: Scene, motion: Motion) -> Motion:
    """The motion with these quantities, whose radius is twice the first-order effect of its own.

    What is quadratic in the radius of the motion is far less than the second half of that.
    """
    formed = values(scene, motion)
    rows, errors = in_mpfr(motion), [mpf(radius) for radius in motion.radius]
    radii = {name: motion.radius_of(name) for name in motion.quantities}
    for function in functions(scene):
        with precision():
            slopes = function.sensitivity(rows)
            steep = [norms(np.asarray(slope).reshape(len(errors), -1)) for slope in slopes.values()]
            sizes = [norms(part.reshape(len(errors), -1)) for part in rows.quantities.values()]
            bound = to_mpf(sum(steep) * sum(sizes))
        scale = [mp.norm(list(row)) or mpf(1) for row in formed[function.name]]
        radii[function.name] = np.array(
            [2 * b * r / s for b, r, s in zip(bound, errors, scale, strict=True)], dtype=object
        )
    radius = np.array([max(row) for row in zip(*radii.values(), strict=True)], dtype=object)
    return Motion({**motion.quantities, **formed}, radius, radii, motion.errors, motion.peaks)


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
