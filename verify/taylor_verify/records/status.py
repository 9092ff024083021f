"""The status of a verdict, and the exit status of a command that several verdicts lead to."""

from __future__ import annotations

from collections.abc import Iterable
from enum import StrEnum
from typing import Final


class Status(StrEnum):
    """The decision of a gate. Only PASS is green."""

    PASS = "pass"
    FAIL = "fail"
    UNDECIDED = "undecided"
    VACUOUS = "vacuous"
    REFUSED = "refused"
    UNAVAILABLE = "unavailable"


# From worst to best: the status of several verdicts is the worst of them.
GRAVITY: Final = (
    Status.FAIL,
    Status.UNDECIDED,
    Status.REFUSED,
    Status.VACUOUS,
    Status.UNAVAILABLE,
    Status.PASS,
)


def gravest(statuses: Iterable[Status]) -> Status:
    """Return the status of several verdicts taken together."""
    return min(statuses, key=GRAVITY.index)
