"""The next call: options of the command line that help with some verdicts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import ceil, log10
from typing import Final

from taylor_verify.records.error_kind import ErrorKind
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict

# Errors of these kinds are no matter of accuracy: a wider tolerance would hide them.
_NO_ACCURACY: Final = (
    None,
    ErrorKind.CONVENTION,
    ErrorKind.OFFSET,
    ErrorKind.TIME_SHIFT,
    ErrorKind.NOT_FINITE,
)
# A tolerance beyond this judges nothing.
_LARGEST_TOLERANCE: Final = 0.01


def next_steps(verdicts: Sequence[Verdict], is_explained: bool) -> Iterator[str]:
    """Yield a sentence for each option that helps; ``is_explained`` if --explain was given."""
    tolerance = coarser_tolerance(verdicts)
    if tolerance is not None:
        yield f"--tolerance {tolerance:.0e} judges a method of this accuracy"
    if not is_explained and any(v.is_compared and v.verdict is not Status.PASS for v in verdicts):
        yield "--explain shows the arithmetic of what is allowed"


def coarser_tolerance(verdicts: Sequence[Verdict]) -> float | None:
    """Return the least power of ten above the errors of all failed rows.

    None if no row failed, or if the fault is not one of accuracy.
    """
    failed = [v for v in verdicts if v.verdict is Status.FAIL]
    errors = [v.max for v in failed if v.max is not None and v.error_kind not in _NO_ACCURACY]
    has_one = any(v.tolerance is not None for v in verdicts)
    if not failed or has_one or len(errors) < len(failed) or not max(errors) < _LARGEST_TOLERANCE:
        return None
    return float(10.0 ** ceil(log10(max(errors))))
