"""The closed form of a gyrostat: of the free motion alone, in every regime, in balls."""

from __future__ import annotations

from taylor_verify.exact.gyrostat.pencil import FreeGyrostat
from taylor_verify.exact.gyrostat.sigma import free_rotation
from taylor_verify.exact.solution import NoClosedForm, Solution
from taylor_verify.scenes.gyrostat import Gyrostat
from taylor_verify.scenes.motion import Quaternion, Spin
from taylor_verify.scenes.scene import Scene


def enclosed(scene: Scene) -> Solution:
    """Return the motion in balls; raises NoClosedForm for a moment on the body."""
    return free_rotation(*free_gyrostat(scene))


def closed_form(scene: Scene) -> None:
    """The motion in mpmath: there is none."""


def free_gyrostat(scene: Scene) -> tuple[FreeGyrostat, Quaternion | None]:
    """Return the motion without a moment, and the attitude where it is tracked; else NoClosedForm."""
    body, start = scene.body, scene.initial
    assert isinstance(body, Gyrostat)
    assert isinstance(start, Spin)
    if not body.is_free:
        raise NoClosedForm("a moment acts on a body with wheels")
    attitude = start.attitude if "attitude" in scene.track else None
    return FreeGyrostat(body.inertia, body.rotor, start.omega), attitude
