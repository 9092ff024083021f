"""Gates: a bound with its reason, asked of every sample, written so that a NaN cannot pass."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from mpmath import mp

from verify.judge.attainable import Floats
from verify.judge.errors import Errors, largest
from verify.judge.verdict import Status

# The floor is the root mean square of a random sum. Ten times it leaves room for a solver that
# rounds a few times a step and for the tail of the distribution, and no room for one step in a
# hundred done wrongly.
FACTOR = 10
# A truth wider than this share of a bound cannot judge against it.
_TRUTH_SHARE = 16
# At an error of one the answer zero would do as well: such a bound forbids nothing.
_VACUOUS = 1.0


@dataclass(frozen=True)
class Finding:
    """What a gate found: the status, the sample that decided and the numbers there."""

    status: Status
    worst: int
    ratio: float
    ratio_at: int
    because: str


def judge(errors: Errors, attainable: Floats, reason: str) -> Finding:
    """Hold every sample's error against FACTOR times the attainable one."""
    bounds = FACTOR * attainable
    worst = index_of_largest(errors.values)
    ratios = [_ratio(e, a) for e, a in zip(errors.values, attainable, strict=True)]
    ratio_at = index_of_largest(ratios)
    status = _status(errors, bounds)
    because = f"{FACTOR} x attainable; {reason}"
    if status is Status.VACUOUS:
        because = f"the floor has reached the size of the motion itself; {because}"
    if status is Status.UNDECIDED:
        because = f"the truth is wider than 1/{_TRUTH_SHARE} of the bound; {because}"
    return Finding(status, worst, float(ratios[ratio_at]), ratio_at, because)


def _status(errors: Errors, bounds: Floats) -> Status:
    if any(mp.isnan(value) for value in errors.values):
        return Status.FAIL
    within = [bool(error <= bound) for error, bound in zip(errors.values, bounds, strict=True)]
    if not np.max(bounds) < _VACUOUS:
        # What the floor does not excuse still fails: the samples before it reached the motion.
        meaningful = [ok for ok, bound in zip(within, bounds, strict=True) if bound < _VACUOUS]
        return Status.VACUOUS if all(meaningful) else Status.FAIL
    narrow = zip(errors.truth_radius, bounds, strict=True)
    if not all(bool(radius * _TRUTH_SHARE <= bound) for radius, bound in narrow):
        return Status.UNDECIDED
    return Status.PASS if all(within) else Status.FAIL


def _ratio(error: Any, attainable: float) -> Any:
    """Error over attainable: 0 for no error, infinite where the floor is zero and the error not."""
    if error == 0:
        return mp.zero
    return error / attainable if attainable > 0 else mp.inf + 0 * error


def index_of_largest(values: Iterable[Any]) -> int:
    """The index of the largest value, or of the first NaN."""
    found = list(values)
    top = largest(found)
    if mp.isnan(top):
        return next(i for i, value in enumerate(found) if mp.isnan(value))
    return found.index(top)
