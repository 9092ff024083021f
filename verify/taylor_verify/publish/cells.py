"""What stands in a cell: a number in three digits, or a word for why there is none."""

from __future__ import annotations

from taylor_verify.publish.markdown import bold
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict

NOTHING = "\N{EN DASH}"
INFINITE = "∞"


def figure(value: float | None) -> str:
    """Three significant digits: 0.531, 42.0, 6.67e-6."""
    if value is None:
        return NOTHING
    if value == 0:
        return "0"
    mantissa, _, tail = f"{value:.2e}".partition("e")
    exponent = int(tail)
    if -2 <= exponent <= 2:
        return f"{value:.{2 - exponent}f}"
    return f"{mantissa}e{exponent}"


def instant(value: float | None) -> str:
    """A time of the scene, which has its own number of digits."""
    return NOTHING if value is None else f"{value:.6g}"


def in_roundoffs(verdict: Verdict, value: float | None) -> float | None:
    """An error in units of the rung's u; None where u is unknown or too small for a double."""
    return value / verdict.roundoff if value is not None and verdict.roundoff else None


def word(verdict: Verdict) -> str:
    """In place of an error that is no number: the verdict, or how a failed run ended."""
    unfinished = verdict.verdict is Status.FAIL and not verdict.is_compared
    return verdict.outcome if unfinished else verdict.verdict.value


def error(verdict: Verdict) -> str:
    return word(verdict) if verdict.max is None else figure(verdict.max)


def ratio(verdict: Verdict) -> str:
    """Error over attainable: infinite where there is an error and nothing is attainable."""
    if verdict.ratio is None and verdict.is_compared:
        return word(verdict) if verdict.max is None else INFINITE
    return figure(verdict.ratio)


def judged(verdict: Status) -> str:
    """The verdict's word; one that is no pass stands out."""
    return verdict.value if verdict is Status.PASS else bold(verdict.value)


def peak(verdict: Verdict) -> str:
    """Maximum, mean and where, in units of u."""
    largest, mean = (in_roundoffs(verdict, value) for value in (verdict.max, verdict.mean))
    if largest is None:
        return word(verdict)
    if largest == 0:
        return figure(largest)
    return f"{figure(largest)}, {figure(mean)} @ {instant(verdict.at)}"


def reason(verdict: Verdict) -> str:
    """Return the reason of a verdict in one line; an error that is no number is said first."""
    return "; ".join(filter(None, (_not_finite(verdict), verdict.because)))


def conclusion(verdict: Verdict) -> str:
    """Return the remarks of a reason alone; an error that is no number is said first."""
    return "; ".join(filter(None, (_not_finite(verdict), verdict.reason.conclusion)))


def _not_finite(verdict: Verdict) -> str:
    is_number = verdict.max is not None or not verdict.is_compared
    return "" if is_number else "the error is not a finite number"
