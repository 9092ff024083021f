"""Cells of tables: a number in three digits or a word for a missing one; whole rows of verdicts."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from math import inf, isfinite, isnan
from typing import Final

from taylor_verify.records.quantities import states_among
from taylor_verify.records.runs import Run, gravest
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.words.markdown import bold, code, prose, table

NOTHING = "\N{EN DASH}"
INFINITE = "∞"


def figure(value: float | None) -> str:
    """Return a number in three significant digits: 0.531, 42.0, 6.67e-6."""
    if value is None:
        return NOTHING
    if value == 0:
        return "0"
    if not isfinite(value):
        return "NaN" if isnan(value) else INFINITE
    mantissa, _, tail = f"{value:.2e}".partition("e")
    exponent = int(tail)
    if -2 <= exponent <= 2:
        return f"{value:.{2 - exponent}f}"
    return f"{mantissa}e{exponent}"


def instant(value: float | None) -> str:
    """Return a time of the scene in six digits."""
    return NOTHING if value is None else f"{value:.6g}"


def in_roundoffs(verdict: Verdict, value: float | None) -> float | None:
    """Return an error in units of the rung's u; None if u is unknown or too small for a double."""
    return value / verdict.roundoff if value is not None and verdict.roundoff else None


def word(verdict: Verdict) -> str:
    """Return the word for an error that is no number: the verdict, or the outcome of a failed run."""
    unfinished = verdict.verdict is Status.FAIL and not verdict.is_compared
    return verdict.outcome if unfinished else verdict.verdict.value


def error(verdict: Verdict) -> str:
    """Return the largest error, or a word if it is no number."""
    return word(verdict) if verdict.max is None else figure(verdict.max)


def ratio(verdict: Verdict) -> str:
    """Return error over attainable; infinite for an error above an attainable one of zero."""
    if verdict.ratio is None and verdict.is_compared:
        return word(verdict) if verdict.max is None else INFINITE
    return figure(verdict.ratio)


def judged(verdict: Status) -> str:
    """Return the word of the verdict, in bold unless it is a pass."""
    return verdict.value if verdict is Status.PASS else bold(verdict.value)


def peak(verdict: Verdict) -> str:
    """Return maximum, mean and time of the maximum, in units of u."""
    largest, mean = (in_roundoffs(verdict, value) for value in (verdict.max, verdict.mean))
    if largest is None:
        return word(verdict)
    if largest == 0:
        return figure(largest)
    return f"{figure(largest)}, {figure(mean)} @ {instant(verdict.at)}"


def reason(verdict: Verdict) -> str:
    """Return the reason of a verdict in one line, which begins with an error that is no number."""
    return "; ".join(filter(None, (_not_finite(verdict), verdict.because)))


def conclusion(verdict: Verdict) -> str:
    """Return only the remarks of a reason, after an error that is no number."""
    return "; ".join(filter(None, (_not_finite(verdict), verdict.reason.conclusion)))


def _not_finite(verdict: Verdict) -> str:
    is_number = verdict.max is not None or not verdict.is_compared
    return "" if is_number else "the error is not a finite number"


# Columns of a table of verdicts by their headings.
CELLS: Final[Mapping[str, Callable[[Verdict], str]]] = {
    "scene": lambda verdict: code(verdict.scene),
    "rung": lambda verdict: verdict.rung,
    "quantity": lambda verdict: code(verdict.quantity),
    "max:": lambda verdict: prose(error(verdict)),
    "mean:": lambda verdict: figure(verdict.mean),
    "at t:": lambda verdict: instant(verdict.at),
    "max, u:": lambda verdict: figure(in_roundoffs(verdict, verdict.max)),
    "mean, u:": lambda verdict: figure(in_roundoffs(verdict, verdict.mean)),
    "bound:": lambda verdict: figure(verdict.bound),
    "attainable:": lambda verdict: figure(verdict.attainable),
    "over attainable:": ratio,
    "steps:": lambda verdict: str(verdict.steps or NOTHING),
    "verdict": lambda verdict: judged(verdict.verdict),
    "because": lambda verdict: prose(reason(verdict)),
}


def verdict_table(headings: Sequence[str], verdicts: Iterable[Verdict]) -> str:
    """Return a table with a row for each verdict and the columns of these headings."""
    return table(headings, [[CELLS[name](verdict) for name in headings] for verdict in verdicts])


def over_attainable(verdict: Verdict) -> float:
    """Return the ratio, or infinity for one that is no finite number."""
    return inf if verdict.ratio is None or isnan(verdict.ratio) else verdict.ratio


def worst(verdicts: Iterable[Verdict]) -> Verdict | None:
    """Return the verdict with the largest error over attainable, of those that were compared."""
    compared = (verdict for verdict in verdicts if verdict.is_compared)
    return max(compared, key=over_attainable, default=None)


def worst_ratio(verdicts: Iterable[Verdict]) -> str:
    """Return the largest error over attainable with the name of its quantity."""
    gravest_verdict = worst(verdicts)
    return (
        f"{ratio(gravest_verdict)} ({code(gravest_verdict.quantity)})"
        if gravest_verdict
        else NOTHING
    )


def main_error(run: Run | None) -> str:
    """Return the error of omega or the impulse, with the verdict of the run unless it is a pass."""
    if run is None:
        return NOTHING
    status = gravest(run.verdicts)
    states = states_among(v.quantity for v in run.state)
    main = next((v for v in run.state if v.quantity == states[0]), None)
    if main is None or main.max is None:
        return judged(status)
    return error(main) if status is Status.PASS else f"{error(main)} {judged(status)}"
