"""Stored rows that no run can have written: each is refused with its place.

A damaged file reads like a sound one, so its rows are asked what every verdict keeps: sizes are not
negative, a pass has its numbers and is within its bound, and no row is there twice.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Final

from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict

_SIZES: Final = (
    *("max", "mean", "final", "bound", "attainable", "roundoff"),
    *("ratio", "tolerance", "residual", "remains", "seconds"),
)


def check_rows(placed: Mapping[str, Verdict]) -> None:
    """Raise ValueError for the first row, by its place in a document, that is no verdict's."""
    for place, verdict in placed.items():
        _check_sizes(verdict, place)
        if verdict.verdict is Status.PASS:
            _check_pass(verdict, place)
    rows = Counter(_named(verdict) for verdict in placed.values())
    if twice := [row for row, count in rows.items() if count > 1]:
        raise ValueError(f"expected every row once, got more of {', '.join(twice)}")


def _check_sizes(verdict: Verdict, place: str) -> None:
    for name in _SIZES:
        value = getattr(verdict, name)
        if value is not None and not value >= 0:
            expected = "expected a number that is not negative"
            raise ValueError(f"{expected}, got {value!r} @ {place}.{name}")


def _check_pass(verdict: Verdict, place: str) -> None:
    if verdict.max is None or verdict.bound is None:
        name = "max" if verdict.max is None else "bound"
        raise ValueError(f"expected a number of a row that passed, got null @ {place}.{name}")
    if not verdict.max <= verdict.bound:
        expected = f"expected an error within its bound {verdict.bound!r} of a row that passed"
        raise ValueError(f"{expected}, got {verdict.max!r} @ {place}.max")


def _named(verdict: Verdict) -> str:
    run = (verdict.scene, verdict.solver, verdict.setting, verdict.rung, verdict.quantity)
    return " ".join(filter(None, run))
