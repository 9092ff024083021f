"""The status of a verdict, and the exit status of a command that several verdicts lead to."""

from __future__ import annotations

from collections.abc import Iterable
from enum import StrEnum
from typing import Final


class Status(StrEnum):
    """What a gate decided. Only PASS is green."""

    PASS = "pass"
    FAIL = "fail"
    UNDECIDED = "undecided"
    VACUOUS = "vacuous"
    REFUSED = "refused"
    UNAVAILABLE = "unavailable"


# The gravest first: one word for several verdicts is the gravest of theirs.
GRAVITY: Final = (
    *(Status.FAIL, Status.UNDECIDED, Status.REFUSED),
    *(Status.VACUOUS, Status.UNAVAILABLE, Status.PASS),
)


def gravest(statuses: Iterable[Status]) -> Status:
    """Return the status of several verdicts taken together."""
    return min(statuses, key=GRAVITY.index)
