"""Ensemble of starts: the scene's own, and random ones nearby from a stated seed."""

from __future__ import annotations

import random
from dataclasses import replace
from fractions import Fraction
from typing import Final

from taylor_verify.scenes.scene import Scene

STARTS: Final = 4
# The largest relative change of each component, in steps of a hundredth of it.
_REACH: Final = Fraction(1, 100)
_GRAIN: Final = 100


def nearby(scene: Scene, seed: int, count: int = STARTS) -> list[Scene]:
    """Return scenes whose angular velocity or impulses differ by up to one per cent in each component.

    Components that are zero stay zero. Attitude and centre do not change, because they only set the
    observer.
    """
    draw, start = random.Random(seed), scene.initial

    def moved(component: Fraction) -> Fraction:
        return component * (1 + _REACH * Fraction(draw.randint(-_GRAIN, _GRAIN), _GRAIN))

    starts = (start.with_moving(tuple(map(moved, start.moving))) for _ in range(count))
    return [replace(scene, initial=initial) for initial in starts]
