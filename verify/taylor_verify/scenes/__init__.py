"""Scenes: a question in exact numbers, and the precisions that it is rounded to."""

from __future__ import annotations

import os

from taylor_verify import types


def load(scene: str | os.PathLike[str]) -> types.Scene:
    """Read a scene file, or a shipped scene.

    Parameters
    ----------
    scene
        The path of a scene file, or the name of a shipped scene (``euler/generic``).

    Returns
    -------
    scenes.scene.Scene
        The scene. Every number is the rational that its text writes.

    Raises
    ------
    records.faults.Refused
        With every fault of the file at once, each as ``expected ..., got ... @ body.inertia[1]``.
    """
    from taylor_verify.scenes.reading import reader

    return reader.load(scene)
