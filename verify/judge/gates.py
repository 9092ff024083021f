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
    """Hold every sample's error against FACTOR times the attainable one.

    The ratio is the largest of the samples that are asked, or of all if none is.
    """
    bounds = FACTOR * attainable
    worst = index_of_largest(errors.values)
    ratios = [_ratio(e, a) for e, a in zip(errors.values, attainable.tolist(), strict=True)]
    ratio_at = index_of_largest(ratios[: _asked(bounds) or None])
    status = _status(errors, bounds)
    because = f"{FACTOR} x attainable; {reason}"
    if status is Status.VACUOUS:
        because = f"{_vacuous(errors, bounds)}; {because}"
    if status is Status.UNDECIDED:
        because = f"the truth is wider than 1/{_TRUTH_SHARE} of the bound; {because}"
    return Finding(status, worst, float(ratios[ratio_at]), ratio_at, because)


def _status(errors: Errors, bounds: Floats) -> Status:
    if mp.isnan(largest(errors.values)):
        return Status.FAIL
    # Python's floats: mpmath asks NumPy's many questions before it compares with one.
    limits = bounds.tolist()
    within = [bool(error <= limit) for error, limit in zip(errors.values, limits, strict=True)]
    asked = _asked(bounds)
    if asked < len(bounds):
        # What the floor does not excuse still fails: the samples before it reached the motion.
        return Status.VACUOUS if all(within[:asked]) else Status.FAIL
    narrow = zip(errors.truth_radius, limits, strict=True)
    if not all(bool(radius * _TRUTH_SHARE <= limit) for radius, limit in narrow):
        return Status.UNDECIDED
    return Status.PASS if all(within) else Status.FAIL


def _asked(bounds: Floats) -> int:
    """How many samples the gate asks: those before the bound reaches the size of the motion.

    A floor may fall again afterwards, as the orbit's own condition does after a flip. But it is that
    of small errors, and one as large as the motion has left the orbit: nothing brings it back.
    """
    lost = np.flatnonzero(~(bounds < _VACUOUS))
    return int(lost[0]) if len(lost) else len(bounds)


def _vacuous(errors: Errors, bounds: Floats) -> str:
    """Why the gate forbids nothing, and what is gated in its place."""
    open_at = f"the bound reaches {float(np.max(bounds)):.2g}, and the answer zero is off by 1"
    instead = "; only the conserved quantities are gated there" if errors.is_state else ""
    return f"rounding alone may carry {errors.quantity} as far as it is large: {open_at}{instead}"


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
