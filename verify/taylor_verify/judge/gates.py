"""Gates: a bound with its reason, asked of every sample, written so that a NaN cannot pass."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from taylor_verify.judge.errors import Errors, Floats
from taylor_verify.judge.verdict import Status

# The floor is the root mean square of a random sum. Ten times it leaves room for a solver that
# rounds a few times a step and for the tail of the distribution, and no room for one step in a
# hundred done wrongly.
FACTOR = 10
# Steps that somebody else claims widen a gate as their square root, WIDENING times at most beyond
# those of a method that resolves every sample and every hundredth of a radian. So 10^4 steps a radian
# count: an RK4 of step 1e-4 on an orbit of one radian per unit of time claims no more.
STEPS_PER_RADIAN = 100
WIDENING = 10
# And no more than a processor can do: a step is some dozens of dependent operations.
STEPS_PER_SECOND = 10**8
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
    worst = index_of_largest(errors.doubles)
    ratios = _ratios(errors.doubles, attainable)
    ratio_at = index_of_largest(ratios[: _asked(bounds) or None])
    status = _status(errors, bounds)
    because = f"{FACTOR} x attainable; {reason}"
    if status is Status.VACUOUS:
        because = f"{_vacuous(errors, bounds)}; {because}"
    if status is Status.UNDECIDED:
        because = f"the truth is wider than 1/{_TRUTH_SHARE} of the bound; {because}"
    return Finding(status, worst, float(ratios[ratio_at]), ratio_at, because)


def _status(errors: Errors, bounds: Floats) -> Status:
    if np.isnan(errors.doubles).any():
        return Status.FAIL
    within = errors.doubles <= bounds
    asked = _asked(bounds)
    if asked < len(bounds):
        # What the floor does not excuse still fails: the samples before it reached the motion.
        return Status.VACUOUS if within[:asked].all() else Status.FAIL
    if not (errors.widths * _TRUTH_SHARE <= bounds).all():
        return Status.UNDECIDED
    return Status.PASS if within.all() else Status.FAIL


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


def _ratios(errors: Floats, attainable: Floats) -> Floats:
    """Error over attainable: 0 for no error, infinite where the floor is zero and the error not."""
    with np.errstate(all="ignore"):
        held = np.where(attainable > 0, errors / attainable, np.inf + 0 * errors)
    found: Floats = np.where(errors == 0, 0.0, held)
    return found


def index_of_largest(values: Floats) -> int:
    """The index of the largest value, or of the first NaN."""
    return int(np.argmax(values))
