"""Random starts near that of a scene, from a given seed."""

from __future__ import annotations

import random
from dataclasses import replace
from fractions import Fraction
from typing import Final

from taylor_verify.scenes.scene import Scene

STARTS: Final = 4
# The largest relative change of a component, and the number of equal steps to it.
_REACH: Final = Fraction(1, 100)
_GRAIN: Final = 100


def nearby(scene: Scene, seed: int, count: int = STARTS) -> list[Scene]:
    """Return ``count`` scenes whose start differs from that of ``scene`` by up to one per cent.

    Each component of the angular velocity or the impulses is changed; zero stays zero. Attitude and centre
    stay the same, because they only fix the axes of space.
    """
    draw, start = random.Random(seed), scene.initial

    def moved(component: Fraction) -> Fraction:
        return component * (1 + _REACH * Fraction(draw.randint(-_GRAIN, _GRAIN), _GRAIN))

    starts = (start.with_moving(tuple(map(moved, start.moving))) for _ in range(count))
    return [replace(scene, initial=initial) for initial in starts]
