"""Stored rows that no run can have written: each is refused with its place.

A damaged file reads like a sound one, so its rows are asked what every verdict has: sizes are not
negative, none exceeds the largest, a pass has its numbers and is within its bound, and no row is there
twice.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Mapping
from typing import Final

from taylor_verify.records.precisions import RUNG_PATTERN
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict

_SIZES: Final = (
    *("max", "mean", "final", "bound", "attainable", "roundoff"),
    *("ratio", "tolerance", "residual", "remains", "seconds"),
)
_OF_A_PASS: Final = ("max", "bound", "mean", "final", "ratio", "attainable", "roundoff")
# A mean of equal numbers may be above them by its roundings.
_ROUNDINGS: Final = 1 + 2.0**-40


def check_rows(placed: Mapping[str, Verdict]) -> None:
    """Raise ValueError for the first row, by its place in a document, that is no verdict's."""
    if not placed:
        raise ValueError("expected rows of a run, got none @ verdicts")
    for place, verdict in placed.items():
        _check_sizes(verdict, place)
        if verdict.verdict is Status.PASS:
            _check_pass(verdict, place)
        _check_run(verdict, place)
    rows = Counter(" ".join(filter(None, (*v.run, v.quantity))) for v in placed.values())
    if twice := [row for row, count in rows.items() if count > 1]:
        raise ValueError(f"expected every row once, got more of {', '.join(twice)}")


def check_runs(placed: Mapping[str, Verdict], timed: Collection[tuple[str, ...]]) -> None:
    """Raise ValueError for a row of a run that is not among the runs that were timed."""
    for place, verdict in placed.items():
        if verdict.run not in timed:
            run = " ".join(filter(None, verdict.run))
            raise ValueError(f"expected a run with its time in timings.json, got {run} @ {place}")


def _check_sizes(verdict: Verdict, place: str) -> None:
    for name in _SIZES:
        value = getattr(verdict, name)
        if value is not None and not value >= 0:
            raise _fault("a number that is not negative", repr(value), f"{place}.{name}")
    for name in ("mean", "final"):
        value, most = getattr(verdict, name), verdict.max
        if value is not None and most is not None and not value <= most * _ROUNDINGS:
            expected = f"no more than the largest error {most!r}"
            raise _fault(expected, repr(value), f"{place}.{name}")


def _check_pass(verdict: Verdict, place: str) -> None:
    for name in _OF_A_PASS:
        if getattr(verdict, name) is None:
            raise _fault("a number of a row that passed", "null", f"{place}.{name}")
    largest, bound = verdict.max, verdict.bound
    if largest is not None and bound is not None and not largest <= bound:
        expected = f"an error within its bound {bound!r} of a row that passed"
        raise _fault(expected, repr(largest), f"{place}.max")


def _fault(expected: str, got: str, place: str) -> ValueError:
    return ValueError(f"expected {expected}, got {got} @ {place}")


def _check_run(verdict: Verdict, place: str) -> None:
    """Refuse a row whose run cannot be made again: no arithmetic, or no text of a scene."""
    if not re.fullmatch(RUNG_PATTERN, verdict.rung):
        expected = "a precision (f32 f64 f80 f128 mpN)"
        raise _fault(expected, f"{verdict.rung!r:.60}", f"{place}.rung")
    if not isinstance(verdict.provenance.get("scene"), str):
        raise _fault("the digest of the scene's text", "none", f"{place}.provenance.scene")
