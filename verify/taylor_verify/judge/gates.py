"""Gates: a bound with its reason, asked of every sample, written so that a NaN cannot pass.

The bound follows from the arithmetic, unless the caller has asked for a tolerance.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from taylor_verify.judge.errors.state import Errors, Floats
from taylor_verify.records.quantities import GATE_FACTOR
from taylor_verify.records.reason import AskedTolerance, Cause, Reason, shown
from taylor_verify.records.status import Status

# A truth wider than this share of a bound cannot judge against it.
TRUTH_SHARE = 16
# At an error of one the answer zero would do as well: such a bound forbids nothing.
_VACUOUS = 1.0
_TOO_FINE = (
    "the tolerance is finer than the roundings of this precision: take a wider precision, or a larger "
    "tolerance"
)


@dataclass(frozen=True)
class Finding:
    """The finding of a gate: the status, the sample that decided and the numbers there.

    ``bound`` is what was allowed at the sample of the largest error, a ``tolerance`` where one was asked
    for. ``is_rounding`` is true if the roundings of the arithmetic explain the error.
    """

    status: Status
    worst: int
    bound: float
    tolerance: float | None
    is_rounding: bool
    ratio: float
    ratio_at: int
    reason: Reason


def judge(
    errors: Errors, attainable: Floats, terms: Reason, tolerance: float | None = None
) -> Finding:
    """Compare every sample's error with GATE_FACTOR times the attainable one, or with a tolerance.

    The ratio is the largest of the samples that are asked, or of all if none is. ``terms`` say what is
    attainable; the finding adds the factor, the tolerance, and a remark where the numbers do not say
    everything. A tolerance is below 1, so that no gate that has one is vacuous.
    """
    roundings = GATE_FACTOR * attainable
    bounds = bounds_of(attainable, tolerance)
    worst = index_of_largest(errors.doubles)
    ratios = _ratios(errors.doubles, attainable)
    ratio_at = index_of_largest(ratios[: _asked(roundings) or None])
    status, by_rounding = _status(errors, bounds), _status(errors, roundings)
    reason = replace(terms, factor=float(GATE_FACTOR))
    if tolerance is not None:
        reason = replace(reason, tolerance=AskedTolerance(tolerance, shown(roundings[worst])))
        is_explained = by_rounding in (Status.PASS, Status.VACUOUS)
        if status is Status.FAIL and (is_explained or not attainable[worst] <= tolerance):
            reason = reason.with_remark(Cause.FINE_TOLERANCE, _TOO_FINE)
    if status is Status.VACUOUS:
        open_at = f"the bound reaches {float(np.max(bounds)):.2g}, and the answer zero is off by 1"
        instead = "; only the conserved quantities are gated there" if errors.is_state else ""
        far = (
            f"rounding alone may carry {errors.quantity} as far as it is large: {open_at}{instead}"
        )
        reason = reason.with_remark(Cause.VACUOUS, far)
    if status is Status.UNDECIDED:
        wide = f"the truth is wider than 1/{TRUTH_SHARE} of the bound"
        reason = reason.with_remark(Cause.WIDE_TRUTH, wide)
    return Finding(
        status=status,
        worst=worst,
        bound=float(bounds[worst]),
        tolerance=tolerance,
        is_rounding=by_rounding is Status.PASS,
        ratio=float(ratios[ratio_at]),
        ratio_at=ratio_at,
        reason=reason,
    )


def bounds_of(attainable: Floats, tolerance: float | None) -> Floats:
    """Return the bound of every sample: the caller's tolerance, or that of the arithmetic."""
    return GATE_FACTOR * attainable if tolerance is None else np.full(len(attainable), tolerance)


def _status(errors: Errors, bounds: Floats) -> Status:
    if np.isnan(errors.doubles).any():
        return Status.FAIL
    within = errors.doubles <= bounds
    asked = _asked(bounds)
    if asked < len(bounds):
        # What the floor does not excuse still fails: the samples before it reached the motion.
        return Status.VACUOUS if within[:asked].all() else Status.FAIL
    if not (errors.widths * TRUTH_SHARE <= bounds).all():
        return Status.UNDECIDED
    return Status.PASS if within.all() else Status.FAIL


def _asked(bounds: Floats) -> int:
    """Return the number of samples that the gate asks: those before its bound reaches the motion's size.

    A floor may fall again afterwards, as the orbit's own condition does after a flip. But it is that
    of small errors, and one as large as the motion has left the orbit: nothing brings it back.
    """
    lost = np.flatnonzero(~(bounds < _VACUOUS))
    return int(lost[0]) if len(lost) else len(bounds)


def _ratios(errors: Floats, attainable: Floats) -> Floats:
    """Error over attainable: 0 for no error, infinite where the floor is zero and the error not."""
    with np.errstate(all="ignore"):
        held = np.where(attainable > 0, errors / attainable, np.inf + 0 * errors)
    return np.where(errors == 0, 0.0, held)


def index_of_largest(values: Floats) -> int:
    """Return the index of the largest value, or of the first NaN."""
    return int(np.argmax(values))
