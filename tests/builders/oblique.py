"""A free rigid body with an oblique attitude: axes that are mixed up show at its start."""

from __future__ import annotations

from taylor_verify.scenes.reading.reader import read
from taylor_verify.scenes.scene import Scene

FULL = "[[1.2, 0.1, -0.2], [0.1, 2.1, 0.3], [-0.2, 0.3, 2.7]]"
FORWARDS, BACKWARDS = ("end = 4\nsamples = 5", "end = -4\nsamples = 5")

_SCENE = """
title = "Oblique"
model = "euler"
source = "none"
track = ["omega", "attitude"]
[body]
inertia = {inertia}
[initial]
omega = [0.9, -0.3, 0.5]
attitude = [1, 2, -1, 3]
[time]
{time}
"""


def oblique(inertia: str = FULL, time: str = FORWARDS) -> Scene:
    """Return the scene, its keys as a file has them."""
    return read(_SCENE.format(inertia=inertia, time=time), "oblique")
