"""A scene brought to simpler coordinates, and maybe another pace of time, with the ways back to its own."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from taylor_verify.exact.carried import Back, carried
from taylor_verify.exact.solution import Number, Solution, Time
from taylor_verify.scenes.scene import Scene

Pace = Callable[[Number], Any]
"""The inner time that goes by in one unit of the scene's, as a ball or in mpmath."""


@dataclass(frozen=True)
class Reduced:
    """The scene that is left to solve, the ways back in the order of the reductions, and their words.

    ``pace`` is that of the time in which all of it goes, where this is not the scene's.
    """

    scene: Scene
    backs: tuple[Back, ...] = ()
    words: tuple[str, ...] = ()
    pace: Pace | None = None

    def then(self, scene: Scene, back: Back, *words: str) -> Reduced:
        """Return the same after one more reduction, which left this scene."""
        return replace(self, scene=scene, backs=(*self.backs, back), words=(*self.words, *words))

    def carried_back(self, inner: Solution) -> Solution:
        """Return the motion of the scene at the beginning from that of the scene that is left."""
        for back in reversed(self.backs):
            inner = carried(inner, back)
        pace = self.pace
        if pace is None:
            return inner
        return carried(inner, _as_it_is, clock=lambda t, number: pace(number) * number(t))


def _as_it_is(rows: dict[str, Any], elapsed: Sequence[Time], number: Number) -> None:
    """Leave the coordinates of a motion as they are."""
