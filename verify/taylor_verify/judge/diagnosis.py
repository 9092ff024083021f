"""Diagnosis of the error of one quantity from its samples: its kind, and when it becomes too large.

Only what the samples show is reported: a power of time is named if a straight line in logarithms fits it
closely, and an error that fits no pattern is unexplained.
"""

from __future__ import annotations

from dataclasses import replace
from math import isfinite
from typing import Any, Final

import numpy as np

from taylor_verify.judge.gates import bounds_of
from taylor_verify.records.error_kind import ErrorKind
from taylor_verify.records.quantities import GATE_FACTOR
from taylor_verify.records.reason import Kind
from taylor_verify.records.status import Status
from taylor_verify.records.student import student
from taylor_verify.records.verdict import Verdict

Floats = np.ndarray[Any, np.dtype[np.float64]]
Places = np.ndarray[Any, np.dtype[np.bool_]]

_OF_A_SHIFT: Final = {
    Kind.CONSTANT.value: ErrorKind.TIME_SHIFT,
    Kind.DRIFTING.value: ErrorKind.PHASE_DRIFT,
    Kind.WANDERING.value: ErrorKind.PHASE_WANDER,
}
# A constant error never falls below this part of its largest value, over at least _FEWEST samples.
_CONSTANT: Final = 0.9
_FEWEST: Final = 5
# An error as large as this part of the motion cannot grow much further.
_LOST: Final = 0.1
# The root mean squares of a bounded error over the quarters of the time agree to this part, which leaves
# room for noise, and for a growth as t^0.15. Each quarter needs the number of samples below.
_BOUNDED: Final = 0.75
_QUARTERS: Final = 4
_FEWEST_IN_A_QUARTER: Final = 5
# The fit of a power: root mean squares over _PARTS equal parts of the logarithm of time, beginning at the
# fraction _FROM of the time. Each part needs the number of samples below. The 95 % interval of the power
# must be no wider than _CLEAR to either side.
_FROM: Final = 1 / 32
_PARTS: Final = 5
_FEWEST_IN_A_PART: Final = 3
_LEVEL: Final = 0.95
_CLEAR: Final = 0.2
# A slower growth than this cannot be distinguished from none.
_LEAST_POWER: Final = 0.3


def diagnosed(
    verdict: Verdict, times: Floats, start: float, errors: Floats, attainable: Floats
) -> Verdict:
    """Return the verdict with the kind of its error, its growth, and the time from which it is too large.

    ``errors`` and ``attainable`` are given at all samples, in the order of ``times``; ``start`` is the
    time of the initial state.
    """
    bounds = bounds_of(attainable, verdict.tolerance)
    too_large = np.flatnonzero(~(errors <= bounds))
    if not np.isfinite(errors).all():
        # NaN and infinity come first, whatever else is too large.
        too_large = np.flatnonzero(~np.isfinite(errors))
    is_failed = verdict.verdict is Status.FAIL and len(too_large) > 0
    kind, exponent = None, None
    if verdict.verdict is not Status.UNDECIDED:
        # If the truth is too wide, the course of the error is not visible.
        kind, exponent = _kind(verdict, np.abs(times - start), errors, attainable)
    return replace(
        verdict,
        since=float(times[too_large[0]]) if is_failed else None,
        until=float(times[-1]),
        error_kind=kind,
        exponent=exponent,
    )


def _kind(
    verdict: Verdict, elapsed: Floats, errors: Floats, attainable: Floats
) -> tuple[ErrorKind, float | None]:
    if not np.isfinite(errors).all():
        return ErrorKind.NOT_FINITE, None
    if (errors <= GATE_FACTOR * attainable).all():
        return ErrorKind.ROUNDOFF, None
    along = _OF_A_SHIFT.get(verdict.shift or "")
    if along in (ErrorKind.TIME_SHIFT, ErrorKind.PHASE_DRIFT):
        return along, None
    if is_constant(errors):
        return along or ErrorKind.OFFSET, None
    if np.max(errors) >= _LOST:
        return along or ErrorKind.UNEXPLAINED, None
    if is_bounded(elapsed, errors):
        return along or ErrorKind.BOUNDED, None
    exponent = power_of_time(elapsed, errors)
    if along is not None or exponent is not None:
        return along or ErrorKind.GROWTH, exponent
    return ErrorKind.UNEXPLAINED, None


def is_constant(errors: Floats) -> bool:
    """Return True for an error that is nearly equal at all samples, the first one included."""
    return len(errors) >= _FEWEST and bool(np.min(errors) >= _CONSTANT * np.max(errors))


def is_bounded(elapsed: Floats, errors: Floats) -> bool:
    """Return True for an error that is as large in the first quarter of the time as in the others."""
    quarters = _parts(elapsed, np.linspace(0.0, float(np.max(elapsed)), _QUARTERS + 1))
    if any(np.count_nonzero(inside) < _FEWEST_IN_A_QUARTER for inside in quarters):
        return False
    sizes = [_mean_square_root(errors[inside]) for inside in quarters]
    return min(sizes) >= _BOUNDED * max(sizes)


def power_of_time(elapsed: Floats, errors: Floats) -> float | None:
    """Return the power of time with which an error grows; None if the samples show none clearly."""
    end = float(np.max(elapsed))
    if not end > 0:
        return None
    points = []
    for inside in _parts(elapsed, np.geomspace(_FROM * end, end, _PARTS + 1)):
        size = _mean_square_root(errors[inside])
        if np.count_nonzero(inside) < _FEWEST_IN_A_PART or not size > 0:
            return None
        points.append((float(np.mean(np.log(elapsed[inside]))), float(np.log(size))))
    x, y = np.transpose(points)
    (slope, _), covariance = np.polyfit(x, y, 1, cov=True)
    half = student(_PARTS - 2, _LEVEL) * float(covariance[0, 0]) ** 0.5
    is_clear = isfinite(slope) and half <= _CLEAR
    return round(float(slope), 3) if is_clear and slope >= _LEAST_POWER else None


def _parts(elapsed: Floats, edges: Floats) -> list[Places]:
    """Return the samples between each edge and the next one, the last edge included."""
    begins, ends = edges[:-1], [*edges[1:-1], np.inf]
    return [(elapsed >= begin) & (elapsed < end) for begin, end in zip(begins, ends, strict=True)]


def _mean_square_root(errors: Floats) -> float:
    """Return the root mean square, scaled so that no square overflows; 0 of an empty array."""
    largest = float(np.max(errors, initial=0.0))
    if not largest > 0:
        return 0.0
    return largest * float(np.sqrt(np.mean((errors / largest) ** 2)))
