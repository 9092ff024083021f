"""Verdicts on many bodies by one solver on one rung."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from taylor_verify.records.verdict import Verdict
    from taylor_verify.scenes.scene import Scene


def judged(scenes: Sequence[Scene], solver: str, rung: str) -> list[list[Verdict]]:
    """Return the verdicts on every scene, in the order of the scenes."""
    from taylor_verify.run import run

    return [list(run(scene, solver, rung).verdicts) for scene in scenes]
