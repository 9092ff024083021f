"""A scene brought to simpler coordinates, with the ways back to its own."""

from __future__ import annotations

from dataclasses import dataclass, replace

from taylor_verify.exact.carried import Back, carried
from taylor_verify.exact.solution import Solution
from taylor_verify.scenes.scene import Scene


@dataclass(frozen=True)
class Reduced:
    """The scene that is left to solve, the ways back in the order of the reductions, and their words."""

    scene: Scene
    backs: tuple[Back, ...] = ()
    words: tuple[str, ...] = ()

    def then(self, scene: Scene, back: Back, *words: str) -> Reduced:
        """Return the same after one more reduction, which left this scene."""
        return replace(self, scene=scene, backs=(*self.backs, back), words=(*self.words, *words))

    def carried_back(self, inner: Solution) -> Solution:
        """Return the motion of the scene at the beginning from that of the scene that is left."""
        for back in reversed(self.backs):
            inner = carried(inner, back)
        return inner
