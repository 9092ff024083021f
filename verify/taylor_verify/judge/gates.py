"""Gates: the comparison of every sample's error with a bound, written so that NaN cannot pass.

The bound follows from the arithmetic, unless the caller asks for a tolerance.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from taylor_verify.judge.errors.state import Errors, Floats
from taylor_verify.records.quantities import GATE_FACTOR
from taylor_verify.records.reason import AskedTolerance, Cause, Reason, shown
from taylor_verify.records.status import Status

# The truth must be at least this many times narrower than the bound.
_TRUTH_SHARE = 16
# The answer zero has an error of one, so a bound of one or more forbids nothing.
_VACUOUS = 1.0
_TOO_FINE = (
    "the tolerance is finer than the roundings of this precision: take a wider precision, or a larger "
    "tolerance"
)


@dataclass(frozen=True)
class Finding:
    """The result of a gate: the status, the deciding sample and the numbers there.

    ``bound`` is the allowed error at the sample of the largest error: the ``tolerance`` if there is one.
    ``is_rounding`` is True if the roundings of the arithmetic explain the error.
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
    """Compare every sample's error with GATE_FACTOR times the attainable error, or with a tolerance.

    The ratio is the largest over the asked samples, or over all samples if none is asked. ``terms``
    describe the attainable error; the finding adds the factor, the tolerance, and a remark if the numbers
    need one. A tolerance is below 1, so a gate with a tolerance is never vacuous.
    """
    roundings = GATE_FACTOR * attainable
    bounds = bounds_of(attainable, tolerance)
    worst = index_of_largest(errors.values)
    ratios = _ratios(errors.values, attainable)
    ratio_at = index_of_largest(ratios[: _asked(roundings) or None])
    status, by_rounding = _status(errors, bounds), _status(errors, roundings)
    reason = replace(terms, factor=float(GATE_FACTOR))
    if tolerance is not None:
        reason = replace(reason, tolerance=AskedTolerance(tolerance, shown(roundings[worst])))
        is_explained = by_rounding in (Status.PASS, Status.VACUOUS)
        if status is Status.FAIL and (is_explained or not attainable[worst] <= tolerance):
            reason = reason.with_remark(Cause.FINE_TOLERANCE, _TOO_FINE)
    if status is Status.VACUOUS:
        instead = "; only the conserved quantities are gated" if errors.is_state else ""
        large = (
            f"roundoff alone may be as large as {errors.quantity} itself, which is an error of 1: "
            f"the bound reaches {float(np.max(bounds)):.2g}{instead}"
        )
        reason = reason.with_remark(Cause.VACUOUS, large)
    if status is Status.UNDECIDED:
        wide = f"the truth is wider than 1/{_TRUTH_SHARE} of the bound"
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
    """Return the bound of every sample: the caller's tolerance, or the bound from the arithmetic."""
    return GATE_FACTOR * attainable if tolerance is None else np.full(len(attainable), tolerance)


def _status(errors: Errors, bounds: Floats) -> Status:
    if np.isnan(errors.values).any():
        return Status.FAIL
    within = errors.values <= bounds
    asked = _asked(bounds)
    if asked < len(bounds):
        # The samples before the floor reached the motion's size can still fail.
        return Status.VACUOUS if within[:asked].all() else Status.FAIL
    if not (errors.truth_radius * _TRUTH_SHARE <= bounds).all():
        return Status.UNDECIDED
    return Status.PASS if within.all() else Status.FAIL


def _asked(bounds: Floats) -> int:
    """Return the number of samples that the gate asks: those with a bound below the size of the motion.

    The floor may fall again afterwards, for example after a flip. But the floor holds for small errors
    only. An answer with an error as large as the motion has left the orbit and does not return.
    """
    lost = np.flatnonzero(~(bounds < _VACUOUS))
    return int(lost[0]) if len(lost) else len(bounds)


def _ratios(errors: Floats, attainable: Floats) -> Floats:
    """Return error over attainable: 0 for no error, infinite if only the floor is zero."""
    with np.errstate(all="ignore"):
        ratios = np.where(attainable > 0, errors / attainable, np.inf + 0 * errors)
    return np.where(errors == 0, 0.0, ratios)


def index_of_largest(values: Floats) -> int:
    """Return the index of the largest value, or of the first NaN."""
    return int(np.argmax(values))
