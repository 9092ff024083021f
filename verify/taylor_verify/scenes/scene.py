"""A scene: the question asked of every solver, in exact numbers."""

from __future__ import annotations

from dataclasses import dataclass

from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.motion import Clock, State


@dataclass(frozen=True)
class Scene:
    """Content of a scene file: every number is an exact rational, in the scene's own consistent units.

    ``name`` is the name of a shipped scene (``euler/generic``) or the path given; ``model`` is
    ``euler`` (RigidBody, Spin) or ``kirchhoff`` (ImmersedBody, Impulse); ``track`` holds what the
    scene requires besides omega or impulse: ``attitude``, ``centre``; ``digest`` is the SHA-256 of
    the text; ``warnings`` are sentences about a body that no real solid could have; ``notes`` say how
    numbers were formed that the file does not write as they are (an inverse, a rate in degrees).
    """

    name: str
    title: str
    model: str
    track: frozenset[str]
    body: Body
    initial: State
    clock: Clock
    source: str = ""
    digest: str = ""
    warnings: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
