"""The judgement of a solver's own events in words."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any


def event_lines(document: Mapping[str, Any]) -> Iterator[str]:
    """Yield a line for each time of a judgement as `check --event --json` prints it."""
    for row in document["events"]:
        yield f"t = {row['given']:.17g}: right to {row['digits']} digits (off by {row['error']:.1e})"
    for row in document["missed"]:
        yield f"missed: t = {row['t']}"
    for time in document["invented"]:
        yield f"invented: t = {time:.17g}"
    for row in document["undecided"]:
        yield f"undecided: t = {row['t']}, within {row['radius']}"
