"""The sentence about one quantity: its correct digits, the remaining error, and since when.

It is made of the values of a verdict, here and nowhere else. The arithmetic of the bound is the reason's
affair.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

from taylor_verify.records.error_kind import ErrorKind
from taylor_verify.records.quantities import COMPLETE, CONSERVED_QUANTITIES, GATE_FACTOR, INITIAL
from taylor_verify.records.reason import Cause, late, pace
from taylor_verify.records.status import Status

if TYPE_CHECKING:
    from taylor_verify.records.verdict import Verdict

# Powers of time that have a name: a random walk, a steady error, and their integrals.
_POWERS: Final = {0.5: "t^1/2", 1.0: "t", 1.5: "t^3/2", 2.0: "t^2", 3.0: "t^3"}
# A fitted power this near to one of them is called by its name.
_NEAR: Final = 0.15
# A change is steady if it has one direction, and at least this part of the largest error.
_STEADY: Final = 0.5
# Kinds for which only the digits are reported.
_UNSAID: Final = (None, ErrorKind.NOT_FINITE)
_STORED: Final = {
    ErrorKind.PRINTED: "the rounding of the file's own printed digits",
    ErrorKind.SINGLE: "the rounding of the file's numbers to float32",
}


def sentence(verdict: Verdict) -> str:
    """Return one line that begins with the quantity and can stand alone."""
    return f"{verdict.quantity}: {_description(verdict)}"


def _description(verdict: Verdict) -> str:
    conclusion = verdict.reason.conclusion
    if verdict.quantity in (INITIAL, COMPLETE) and verdict.error_kind not in _STORED:
        return conclusion or verdict.verdict.value
    if not verdict.is_compared:
        return conclusion or verdict.outcome
    if verdict.verdict is Status.UNDECIDED:
        return f"undecided, {conclusion}" if conclusion else "undecided"
    if verdict.quantity == INITIAL:
        # Where the start is off by its printed digits alone, nothing after follows from it.
        conclusion = ""
    parts = [_digits(verdict), conclusion, *_left(verdict), _bound(verdict)]
    return "; ".join(filter(None, parts))


def _digits(verdict: Verdict) -> str:
    digits = verdict.digits
    if digits is None or verdict.max is None:
        first = "" if verdict.since is None else f", first at t = {verdict.since:g}"
        lacks = any(remark.cause is Cause.NO_ATTITUDE for remark in verdict.reason.remarks)
        return f"{'no attitude' if lacks else 'not a finite number'}{first}"
    size = f"{verdict.max:.2g}{' rad' if verdict.unit == 'rad' else ''}"
    if not digits:
        return f"no digit is right at t = {verdict.at:g} (error {size})"
    is_one_row = verdict.until is None or verdict.quantity == INITIAL
    end = "" if is_one_row else f" up to t = {verdict.until:g}"
    if verdict.max == 0:
        return f"exact{end}"
    verb = "kept" if verdict.is_conserved else "right"
    count = "1 digit is" if digits == 1 else f"{digits} digits are"
    return f"{count} {verb}{end} (largest error {size})"


def _left(verdict: Verdict) -> Iterator[str]:
    """Return the sentences on the error that is left; empty where nothing is known of it."""
    kind = verdict.error_kind
    if verdict.max == 0 or verdict.verdict is Status.VACUOUS or kind in _UNSAID:
        return
    shift, remains = verdict.reason.shift, ""
    if verdict.remains is not None:
        rows = shift.rows_in_words() if shift else ""
        remains = f", and without this {verdict.remains:.2g} remains{rows}"
    if kind is ErrorKind.ROUNDOFF:
        yield "what is left is roundoff"
    elif kind in _STORED:
        yield f"what is left is {_STORED[kind]}"
    elif kind is ErrorKind.CONVENTION:
        yield "the file has another convention than the scene"
    elif kind is ErrorKind.TIME_SHIFT:
        yield f"the error is a time shift: the answer is {late(verdict.time_shift or 0.0)}{remains}"
    elif kind is ErrorKind.PHASE_DRIFT:
        clock = pace(verdict.trend or 0.0)
        yield f"the error is a drift of phase: the clock runs {clock}{remains}"
    elif kind is ErrorKind.PHASE_WANDER:
        worst = (
            "" if shift is None or shift.at is None else f", {late(shift.late)} at t = {shift.at:g}"
        )
        yield f"the error is a phase that wanders{worst}{remains}"
        yield from _course(verdict)
    else:
        if verdict.shift is not None and kind is not ErrorKind.OFFSET:
            yield "no shift of time explains the error"
        yield from _course(verdict)


def _course(verdict: Verdict) -> Iterator[str]:
    """Return the course of the error in time."""
    if verdict.error_kind is ErrorKind.OFFSET:
        yield "the error has one size at all samples, the first one included"
    elif verdict.error_kind is ErrorKind.BOUNDED:
        yield "it hardly grows with time"
    elif verdict.exponent is not None:
        distances = {abs(power - verdict.exponent): power for power in _POWERS}
        power = distances[min(distances)]
        if min(distances) > _NEAR:
            yield "it grows with time"
        elif power == 1.0:
            yield f"it grows in proportion to t{_tendency(verdict)}"
        else:
            yield f"it grows as {_POWERS[power]}"


def _tendency(verdict: Verdict) -> str:
    change, size = verdict.change, verdict.max
    if change is None or size is None or not abs(change) >= _STEADY * size:
        return ""
    conserved = CONSERVED_QUANTITIES.get(verdict.quantity)
    if conserved is None or not conserved.is_positive:
        return ": a steady drift"
    return ": a steady loss" if change < 0 else ": a steady gain"


def _bound(verdict: Verdict) -> str:
    """Return the bound in words, and since when the error is above it."""
    tolerance = verdict.tolerance
    if verdict.error_kind is ErrorKind.NOT_FINITE:
        return ""
    if tolerance is None:
        is_above = verdict.verdict is Status.FAIL
        return f"larger than {verdict.rung} rounding explains{_since(verdict)}" if is_above else ""
    limit = f"the tolerance of {tolerance:.3g}"
    if verdict.attainable is not None and verdict.error_kind is not ErrorKind.ROUNDOFF:
        explained = GATE_FACTOR * verdict.attainable
        limit += f" (rounding in {verdict.rung} explains {explained:.2g})"
    if verdict.verdict is Status.FAIL:
        return f"above {limit}{_since(verdict)}"
    return f"within {limit}" if verdict.verdict is Status.PASS else ""


def _since(verdict: Verdict) -> str:
    return "" if verdict.since is None else f" since t = {verdict.since:g}"
