"""Events of a motion as decimal text."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from decimal import ROUND_CEILING, ROUND_FLOOR
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.exact.printed import decimal_text, enclosed_number

if TYPE_CHECKING:
    from taylor_verify.exact.event_times import Events, EventTime

# Digits of the middle of an interval that proves none.
_LEAST_DIGITS: Final = 6
# Digits of the time that a motion is followed to.
_TIME_DIGITS: Final = 12


def events_document(events: Events) -> dict[str, Any]:
    """Return the events of `exact --json`: each time with a bound of its error, absolute."""
    return {
        "event": events.text,
        "digits": events.digits,
        "events": [event_row(time, events.digits) for time in events.times],
        "undecided": [event_row(time, events.digits) for time in events.undecided],
    }


def incomplete_document(events: Events, start: Fraction) -> dict[str, Any]:
    """Return the events of a motion that is not followed on, with the time up to which they are all."""
    rounding = ROUND_FLOOR if events.until >= start else ROUND_CEILING
    return {
        **events_document(events),
        "reached": decimal_text(events.until, _TIME_DIGITS, rounding),
    }


def event_row(time: EventTime, digits: int) -> dict[str, str]:
    """Return a time to at most so many digits, and a bound of its error."""
    text, radius = enclosed_number(time.t, time.radius, digits, _LEAST_DIGITS)
    return {"t": text, "radius": radius}


def event_lines(document: Mapping[str, Any]) -> Iterator[str]:
    """Yield how many events there are, and a line for each."""
    count = len(document["events"])
    how = "proven, and others that are undecided" if document["undecided"] else "none missed"
    reached = f" up to t = {document['reached']}" if "reached" in document else ""
    yield f"{count} {'time' if count == 1 else 'times'} of {document['event']}{reached}, {how}"
    for row in document["events"]:
        yield f"t = {row['t']}   (radius {row['radius']})"
    for row in document["undecided"]:
        yield f"undecided: touched or crossed at t = {row['t']}, within {row['radius']}"
