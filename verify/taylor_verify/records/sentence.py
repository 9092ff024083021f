"""The sentence about one quantity: digits that are right, the error that is left, and since when.

It is made of the values of a verdict, here and nowhere else. The arithmetic of the bound is the reason's
affair.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import floor, inf, log10
from typing import Final

from taylor_verify.records.error_kind import ErrorKind
from taylor_verify.records.quantities import (
    COMPLETE,
    CONSERVED_QUANTITIES,
    GATE_FACTOR,
    INITIAL,
    is_conserved,
)
from taylor_verify.records.reason import Reason
from taylor_verify.records.status import Status

# Powers of time that have a name: a random walk, a steady error, and their integrals.
_POWERS: Final = {0.5: "t^1/2", 1.0: "t", 1.5: "t^3/2", 2.0: "t^2", 3.0: "t^3"}
# A fitted power this near to one of them is called by its name.
_NEAR: Final = 0.15
# What of a change has one direction all the way, as a part of the largest error.
_STEADY: Final = 0.5
_STORED: Final = {
    ErrorKind.PRINTED: "the rounding of the file's own printed digits",
    ErrorKind.SINGLE: "the rounding of the file's numbers to float32",
}


class Row:
    """The values of a verdict that its sentence is made of; `Verdict` has them and says what they mean."""

    rung: str
    quantity: str
    verdict: Status
    outcome: str
    max: float | None
    at: float | None
    unit: str
    tolerance: float | None
    reason: Reason
    attainable: float | None
    time_shift: float | None
    shift: str | None
    trend: float | None
    remains: float | None
    roundoff: float | None
    exponent: float | None
    change: float | None
    since: float | None
    until: float | None
    error_kind: ErrorKind | None

    @property
    def sentence(self) -> str:
        """The digits that are right, the kind of error that is left, and since when, in one line."""
        return _sentence(self)

    @property
    def digits(self) -> int | None:
        """The decimal digits that are right at every sample, at most those that the rung has.

        None where nothing was compared, where the truth is too wide to tell, and where an error is no
        finite number. A radian counts as a whole.
        """
        if self.verdict is Status.UNDECIDED or self.max is None or not 0 <= self.max < inf:
            return None
        has = _digits_below(self.roundoff) if self.roundoff else None
        right = _digits_below(self.max) if self.max else has
        return right if right is None or has is None else min(right, has)

    @property
    def is_conserved(self) -> bool:
        """True for the row of a conserved quantity."""
        return is_conserved(self.quantity)

    @property
    def is_compared(self) -> bool:
        """True if a comparison was made: a run that never came to one has no time of an error."""
        return self.at is not None


def _digits_below(size: float) -> int:
    """Return the number of zeros behind the point of a positive size, or 0."""
    return max(floor(-log10(size)), 0)


def _sentence(verdict: Row) -> str:
    """Return one line that begins with the quantity and can stand alone."""
    conclusion = verdict.reason.conclusion
    if verdict.quantity in (INITIAL, COMPLETE) and verdict.error_kind not in _STORED:
        return f"{verdict.quantity}: {conclusion or verdict.verdict.value}"
    if not verdict.is_compared:
        return f"{verdict.quantity}: {conclusion or verdict.outcome}"
    if verdict.verdict is Status.UNDECIDED:
        return f"{verdict.quantity}: undecided{f', {conclusion}' if conclusion else ''}"
    if verdict.quantity == INITIAL:
        # Where the start is off by its printed digits alone, nothing after follows from it.
        conclusion = ""
    parts = [_digits(verdict), conclusion, *_left(verdict), _bound(verdict)]
    return f"{verdict.quantity}: {'; '.join(filter(None, parts))}"


def _digits(verdict: Row) -> str:
    digits = verdict.digits
    if digits is None or verdict.max is None:
        return f"not a finite number{_since(verdict)}"
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


def _left(verdict: Row) -> Iterator[str]:
    """Return what the error that is left is made of; empty where nothing is known of it."""
    kind = verdict.error_kind
    if verdict.max == 0 or verdict.verdict is Status.VACUOUS:
        return
    if kind is ErrorKind.ROUNDOFF:
        yield "what is left is roundoff"
    elif kind in _STORED:
        yield f"what is left is {_STORED[kind]}"
    elif kind is ErrorKind.CONVENTION:
        yield "the file has another convention than the scene"
    elif kind is ErrorKind.TIME_SHIFT:
        yield f"the error is a time shift: the answer is {_late(verdict.time_shift)}{_remains(verdict)}"
    elif kind is ErrorKind.PHASE_DRIFT:
        yield f"the error is a drift of phase: the clock runs {_pace(verdict.trend)}{_remains(verdict)}"
    elif kind is ErrorKind.PHASE_WANDER:
        yield f"the error is a phase that wanders{_worst_shift(verdict)}{_remains(verdict)}"
        yield from _course(verdict)
    elif kind is not None and kind is not ErrorKind.NOT_FINITE:
        if verdict.shift is not None and kind is not ErrorKind.OFFSET:
            yield "no shift of time explains the error"
        yield from _course(verdict)


def _course(verdict: Row) -> Iterator[str]:
    """Return the course of the error in time."""
    if verdict.error_kind is ErrorKind.OFFSET:
        yield "the error has one size at all samples, the first one included"
    elif verdict.error_kind is ErrorKind.BOUNDED:
        yield "it hardly grows with time"
    elif verdict.exponent is not None:
        yield _growth(verdict, verdict.exponent)


def _growth(verdict: Row, exponent: float) -> str:
    nearest = min(_POWERS, key=lambda power: abs(power - exponent))
    if abs(nearest - exponent) > _NEAR:
        return "it grows with time"
    if nearest == 1.0:
        return f"it grows in proportion to t{_tendency(verdict)}"
    return f"it grows as {_POWERS[nearest]}"


def _tendency(verdict: Row) -> str:
    change, size = verdict.change, verdict.max
    if change is None or size is None or not abs(change) >= _STEADY * size:
        return ""
    conserved = CONSERVED_QUANTITIES.get(verdict.quantity)
    if conserved is None or not conserved.is_positive:
        return ": a steady drift"
    return ": a steady loss" if change < 0 else ": a steady gain"


def _bound(verdict: Row) -> str:
    """Return the bound in words, and since when the error is above it."""
    tolerance = verdict.tolerance
    if tolerance is not None:
        limit = f"the tolerance of {tolerance:.3g}{_allowed_by_arithmetic(verdict)}"
    else:
        limit = f"what {verdict.rung} arithmetic would leave"
    if verdict.error_kind is ErrorKind.NOT_FINITE:
        return ""
    if verdict.verdict is Status.FAIL:
        return f"above {limit}{_since(verdict)}"
    return f"within {limit}" if tolerance is not None and verdict.verdict is Status.PASS else ""


def _since(verdict: Row) -> str:
    return "" if verdict.since is None else f" since t = {verdict.since:g}"


def _allowed_by_arithmetic(verdict: Row) -> str:
    if verdict.attainable is None or verdict.error_kind is ErrorKind.ROUNDOFF:
        return ""
    return f" (roundoff of {verdict.rung} alone would need {GATE_FACTOR * verdict.attainable:.2g})"


def _late(shift: float | None) -> str:
    shift = shift or 0.0
    return f"{'late' if shift >= 0 else 'early'} by {abs(shift):.3g}"


def _pace(trend: float | None) -> str:
    trend = trend or 0.0
    return f"{'slow' if trend > 0 else 'fast'} by {abs(trend):.3g} of the time"


def _worst_shift(verdict: Row) -> str:
    shift = verdict.reason.shift
    return "" if shift is None or shift.at is None else f", {_late(shift.late)} at t = {shift.at:g}"


def _remains(verdict: Row) -> str:
    if verdict.remains is None:
        return ""
    shift = verdict.reason.shift
    return f", and {verdict.remains:.2g} remains{shift.rows_of_it() if shift else ''}"
