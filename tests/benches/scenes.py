"""Scenes as the ratios want them: with more samples, and with all that can be tracked."""

from __future__ import annotations

from dataclasses import replace

from taylor_verify.scenes.instants import EquallySpaced
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene


def sampled(scene: Scene, rows: int) -> Scene:
    """Return the scene with so many samples, equally spaced over its own time."""
    start, end = scene.clock.start, scene.clock.instants[-1]
    instants = EquallySpaced(start, (end - start) / (rows - 1), rows)
    return replace(scene, clock=Clock(start, instants))


def tracking_all(name: str) -> Scene:
    """Return a shipped scene with its attitude and, in a fluid, its centre."""
    scene = load(name)
    track = {"attitude"} if scene.model == "euler" else {"attitude", "centre"}
    return replace(scene, track=frozenset(track))
