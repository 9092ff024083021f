"""Rows that hold the state of another time: one row off, or the first row after a step already."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from taylor_verify.judge.causes.candidate import Candidate
from taylor_verify.judge.causes.material import Material
from taylor_verify.records.reason import Kind

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
    for quantity, verdict in material.failed.items():
        shift = verdict.time_shift
        if verdict.shift != Kind.CONSTANT.value or not shift or not verdict.max:
            continue
        leaves = (verdict.remains or 0.0) / verdict.max
        doubt = max(_KNOWN, _LEAVES_TIMES * leaves)
        # Negative if row k is too old.
        steps = -float(np.mean(spaces)) / shift
        whole = round(steps)
        if abs(abs(steps) - 1) <= min(doubt, _WHOLE):
            other = "k+1" if steps > 0 else "k-1"
            why = f"row k holds the state of row {other}"
            yield Candidate("one row off", quantity, leaves, why)
        elif whole > 1 and whole * doubt <= _WHOLE and abs(steps - whole) <= whole * doubt:
            why = (
                f"every row holds the state a step of {abs(shift):.6g} later, {whole} of which make "
                "the time from row to row"
            )
            yield Candidate("first row stepped already", quantity, leaves, why)
