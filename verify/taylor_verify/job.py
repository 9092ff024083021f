"""One unit of work of a run of many scenes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Job:
    """One scene on several rungs by one solver: the rungs share the condition of the orbit."""

    scene: str
    solver: str
    rungs: tuple[str, ...]


def jobs(scenes: Iterable[str], solver: str, rungs: Sequence[str]) -> list[Job]:
    return [Job(scene, solver, tuple(rungs)) for scene in scenes]
