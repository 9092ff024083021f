"""Events of a motion as decimal text."""

from __future__ import annotations

from typing import Any, Final

from taylor_verify.exact.event_times import Events, EventTime
from taylor_verify.exact.printed import enclosed_number

# Digits of the middle of an interval that proves none.
_LEAST_DIGITS: Final = 6


def events_document(events: Events) -> dict[str, Any]:
    """Return the events of `exact --json`: each time with a bound of its error, absolute."""
    return {
        "digits": events.digits,
        "events": [event_row(time, events.digits) for time in events.times],
        "undecided": [event_row(time, events.digits) for time in events.undecided],
    }


def event_row(time: EventTime, digits: int) -> dict[str, str]:
    """Return a time to at most so many digits, and a bound of its error."""
    text, radius = enclosed_number(time.t, time.radius, digits, _LEAST_DIGITS)
    return {"t": text, "radius": radius}
