"""The status of a verdict, and the exit status of a command that several verdicts lead to."""

from __future__ import annotations

from collections.abc import Collection, Iterable
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


def exit_status(statuses: Collection[Status]) -> int:
    """Return 0 if nothing failed, 1 for a failure, 3 if something shows nothing and nothing failed."""
    if Status.FAIL in statuses:
        return 1
    nothing_shown = (Status.UNDECIDED, Status.REFUSED, Status.VACUOUS)
    return 3 if any(status in statuses for status in nothing_shown) else 0


def gravest(statuses: Iterable[Status]) -> Status:
    """Return the status of several verdicts taken together."""
    return min(statuses, key=GRAVITY.index)
