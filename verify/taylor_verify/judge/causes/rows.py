"""Rows that hold the state of another time: one row off, or the first row after a step already."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from taylor_verify.judge.causes.candidate import Candidate
from taylor_verify.judge.causes.material import Material
from taylor_verify.records.reason import Kind
from taylor_verify.records.verdict import Verdict

_FEWEST_ROWS: Final = 3
# Rows are evenly spaced if no space differs by more than this part.
_EVEN: Final = 1e-6
# A shift is known no better than this part, nor than a few times what it leaves of the error.
_KNOWN: Final = 1e-6
_LEAVES_TIMES: Final = 3.0
# What is known of the shift must tell a whole number of steps from any other.
_WHOLE: Final = 0.05


def other_rows(material: Material) -> Iterator[Candidate]:
    """Yield the row or the step that a constant shift of time amounts to."""
    spaces = np.diff(material.elapsed)
    if len(spaces) < _FEWEST_ROWS - 1 or np.ptp(spaces) > _EVEN * np.max(np.abs(spaces)):
        return
    for name, verdict in material.failed.items():
        if verdict.shift != Kind.CONSTANT.value or not verdict.time_shift or not verdict.max:
            continue
        said = _said(verdict, float(np.mean(spaces)))
        if said is not None:
            yield Candidate(said[0], name, (verdict.remains or 0.0) / verdict.max, said[1])


def _said(verdict: Verdict, space: float) -> tuple[str, str] | None:
    """Name and reason of a constant shift; positive in units of the space if row k is too old."""
    shift = verdict.time_shift
    assert shift is not None
    assert verdict.max
    doubt = max(_KNOWN, _LEAVES_TIMES * (verdict.remains or 0.0) / verdict.max)
    steps = space / shift
    if abs(abs(steps) - 1) <= min(doubt, _WHOLE):
        other = "k-1" if steps > 0 else "k+1"
        return "one row off", f"row k holds the state of row {other}"
    whole = round(-steps)
    if whole > 1 and whole * doubt <= _WHOLE and abs(-steps - whole) <= whole * doubt:
        why = (
            f"every row holds the state a step of {abs(shift):.6g} later, {whole} of which make the "
            "time from row to row"
        )
        return "first row stepped already", why
    return None
