"""The scenes and precisions of a run: what was asked for, read, with what is left out."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from os import PathLike, fspath
from typing import Any

from taylor_verify.batch.job import Job
from taylor_verify.judge.tolerances import NO_TOLERANCES, Tolerances
from taylor_verify.numbers.precision import Rung
from taylor_verify.numbers.precision import rung as rung_named
from taylor_verify.records.faults import Refused, brief
from taylor_verify.records.precisions import LADDER
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.solver import Solver


@dataclass(frozen=True)
class Selection:
    """Scenes on rungs. ``left_out`` gives, by scene and rung, why a run that a folder has is not made.

    ``is_standard_set`` says that no scene was named: a scene that has gone is then missed.
    """

    scenes: tuple[Scene, ...]
    rungs: tuple[str, ...]
    left_out: Mapping[tuple[str, str], str] = field(default_factory=dict)
    is_standard_set: bool = False

    @property
    def warnings(self) -> list[str]:
        """Doubtful points of scenes that are well-posed all the same, with the name of each scene."""
        return [f"{warning} @ {scene.name}" for scene in self.scenes for warning in scene.warnings]

    @property
    def scenes_run(self) -> list[Scene]:
        """The scenes of which a rung is run."""
        return [scene for scene in self.scenes if self._rungs(scene)]

    def jobs(self, solver: Solver | str, tolerances: Tolerances = NO_TOLERANCES) -> list[Job]:
        """Return a job for each scene that is run, on the rungs that are not left out."""
        return [Job(scene, solver, self._rungs(scene), tolerances) for scene in self.scenes_run]

    def _rungs(self, scene: Scene) -> tuple[str, ...]:
        return tuple(rung for rung in self.rungs if (scene.name, rung) not in self.left_out)

    def has(self, scene: str, rung: str) -> bool:
        """Return True if the selection asks for this scene, by name, on this rung."""
        is_named = self.is_standard_set or any(scene == each.name for each in self.scenes)
        return is_named and rung in self.rungs


def select(
    scenes: Iterable[Scene | str | PathLike[str]] | Scene | str | PathLike[str] | None = None,
    rungs: Iterable[Rung | str] | Rung | str | None = None,
) -> Selection:
    """Read the scenes of a run, each once, before anything runs.

    Parameters
    ----------
    scenes
        Scenes, paths, names of shipped scenes, or folders of these (``extremes``); or a single one. None is
        the standard set.
    rungs
        ``f32 f64 f80 f128 mpN``, or a single one. None is f64, and all five of the ladder for the standard
        set.

    Raises
    ------
    records.faults.Refused
        With every fault of every scene that cannot be read.
    ValueError
        For a name that is no rung, and for what is neither scenes nor rungs.
    """
    from taylor_verify.scenes.expected import left_out
    from taylor_verify.scenes.library import named, names

    scenes = None if scenes is None else _several(scenes, "scenes")
    rungs = None if rungs is None else _several(rungs, "rungs")
    asked = rungs if rungs is not None else LADDER if scenes is None else ("f64",)
    on = tuple(dict.fromkeys(rung_named(rung).name for rung in asked))
    named_scenes = names() if scenes is None else scenes
    words = [fspath(scene) if isinstance(scene, PathLike) else scene for scene in named_scenes]
    without = left_out([word for word in words if isinstance(word, str)], on)
    chosen = [one for word in words for one in (named(word) if isinstance(word, str) else [word])]
    return Selection(read_all(chosen), on, without, is_standard_set=scenes is None)


def read_all(scenes: Iterable[Scene | str]) -> tuple[Scene, ...]:
    """Read scenes, each once. Raises Refused with the faults of all that cannot be read."""
    from taylor_verify.scenes.reading.reader import as_scene

    asked = [*scenes]
    read: dict[str, Scene] = {}
    faults: list[str] = []
    for one in asked:
        try:
            scene = as_scene(one)
        except Refused as error:
            faults += [f"{one} is refused:"] if len(asked) > 1 else []
            faults += error.faults
        else:
            read.setdefault(scene.name, scene)
    if faults:
        raise Refused(faults)
    return tuple(read.values())


def _several(asked: Any, what: str) -> Sequence[Any]:
    """Return what was asked for as a sequence: a text is one name, and no row of letters."""
    if isinstance(asked, str | PathLike | Scene | Rung):
        return [asked]
    if isinstance(asked, bytes) or not isinstance(asked, Iterable):
        raise ValueError(f"expected {what} or the name of one, got {brief(asked)} @ {what}")
    return [*asked]
