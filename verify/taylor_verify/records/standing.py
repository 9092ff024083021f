"""The usability of a measured point of speed against accuracy."""

from __future__ import annotations

from enum import StrEnum


class Standing(StrEnum):
    """The usability of a point. Only SOUND points are compared."""

    SOUND = "sound"
    FALSE = "false success"
    FAILED = "failed"
    UNDECIDED = "undecided"
    NOT_RUN = "not run"
