"""The times of a file's rows: what means the start, or an instant of a held state, is exactly there.

A scene and its truth count the time from the start, and round the elapsed times of instants. A simulator
counts it on the clock of its file: it takes a value at the double nearest to start + 1/10, or at the sum of
two doubles, and writes a decimal that is a little earlier.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from fractions import Fraction
from typing import Final, NamedTuple

from taylor_verify.numbers.precision import Rung
from taylor_verify.scenes.scene import Scene

# As many roundings of a time as a sum of two doubles and the last row may be off.
_ROUNDINGS: Final = 4


class _Instant(NamedTuple):
    """An instant as the clock of a file reads it, rounded once, and its time in the truth."""

    read: Fraction
    time: Fraction


def meant_times(times: Sequence[Fraction], scene: Scene, rung: Rung) -> Sequence[Fraction]:
    """Return the times of rows in the truth of a scene.

    A row on the start or on an instant is one by its text, by the number nearest to it, or by the sum of
    the rounded start and the rounded elapsed time. Another row is on its side of the rounded instant.
    """
    start, loads = scene.clock.start, scene.body.loads
    has_instants = loads is not None and bool(loads.held_states)
    if not (start or has_instants):
        return times
    try:
        instants = _instants(times, scene, rung) if has_instants else []
        first = rung.round(start)
        sums = {
            total: instant.time
            for instant in instants
            for total in (
                rung.round(instant.time),
                rung.round(first + instant.time - start),
            )
        }
        places = {**sums, **{instant.read: instant.time for instant in instants}, first: start}
        moved = [instant for instant in instants if instant.read != instant.time]
        return tuple(_meant(time, rung, places, moved) for time in times)
    except (OverflowError, ValueError):
        # The same is said where the scene is posed.
        return times


def _instants(times: Sequence[Fraction], scene: Scene, rung: Rung) -> list[_Instant]:
    start, loads = scene.clock.start, scene.body.loads
    assert loads is not None
    last = max(times)
    until = last - start + _ROUNDINGS * rung.unit_roundoff * (abs(start) + abs(last))
    every = [instant.time for instant in loads.instants(until)]
    return [_Instant(rung.round(start + t), start + rung.round(t)) for t in every]


def _meant(
    time: Fraction, rung: Rung, places: dict[Fraction, Fraction], moved: Sequence[_Instant]
) -> Fraction:
    place = places.get(rung.round(time))
    if place is not None or not moved:
        return time if place is None else place
    k = bisect_right(moved, time, key=lambda instant: instant.read)
    if k < len(moved) and time >= moved[k].time:
        # Before the instant by as much as on the clock of the file.
        return time - moved[k].read + moved[k].time
    return max(time, moved[k - 1].time) if k else time
