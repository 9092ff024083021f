"""The unit of work of a run of many scenes."""

from __future__ import annotations

from dataclasses import dataclass

from taylor_verify.judge.tolerances import NO_TOLERANCES, Tolerances
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.solver import Solver


@dataclass(frozen=True)
class Job:
    """A scene on several rungs by one solver: the rungs share the condition of the orbit.

    ``scene`` is a path, the name of a shipped scene, or a Scene that was made in memory; ``solver``
    is a name or a Solver. ``tolerances`` take the place of bounds.
    """

    scene: str | Scene
    solver: Solver | str
    rungs: tuple[str, ...]
    tolerances: Tolerances = NO_TOLERANCES

    @property
    def name(self) -> str:
        """The name of the scene."""
        return self.scene if isinstance(self.scene, str) else self.scene.name

    def __str__(self) -> str:
        return f"{self.name} on {' '.join(self.rungs)}"
