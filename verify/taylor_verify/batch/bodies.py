"""Verdicts on many bodies at once: of each the ones that `run` would give."""

from __future__ import annotations

from collections.abc import Sequence

from taylor_verify.records.verdict import Verdict
from taylor_verify.run import run
from taylor_verify.scenes.scene import Scene


def judged(
    scenes: Sequence[Scene], solver: str = "taylor", rung: str = "f64"
) -> list[list[Verdict]]:
    """Return the verdicts of each scene by a solver on a rung, in the order of the scenes.

    Raises ValueError for a name that is no solver or no rung.
    """
    return [list(run(scene, solver, rung).verdicts) for scene in scenes]
