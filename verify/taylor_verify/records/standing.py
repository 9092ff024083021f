"""The worth of a measured point of speed against accuracy."""

from __future__ import annotations

from enum import StrEnum


class Standing(StrEnum):
    """The worth of a point. Only SOUND ones are compared."""

    SOUND = "sound"
    FALSE = "false success"
    FAILED = "failed"
    UNDECIDED = "undecided"
    NOT_RUN = "not run"
