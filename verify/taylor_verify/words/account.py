"""The text of a report: the opening, a line for each row, the likely causes and the notes.

`print`, a notebook, pytest and the errors of `raise_for_failure` show it whole. The terminal, JUnit, the
step summary and the annotations of GitHub arrange the same lines.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, Final

from taylor_verify.records.answers import LikelyCause
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.words.cells import figure, instant, ratio
from taylor_verify.words.opening import opening

_MENDS: Final = {
    Status.UNDECIDED: "no fault of the solver, and no pass; a larger tolerance may decide it",
    Status.VACUOUS: "rounding alone reaches the size of the motion, so that no answer could fail: "
    "take a wider rung, a tolerance of your own, or the conserved quantities alone",
    Status.REFUSED: "the rung cannot hold this scene: take another",
}


def account(
    verdicts: Sequence[Verdict],
    causes: Sequence[LikelyCause] = (),
    notes: Iterable[str] = (),
    run: str = "",
) -> list[str]:
    """Return the lines of a report on some verdicts, one for each; a mend stands below its row.

    ``run`` is a line on what was judged, behind the opening. Each row can stand alone.
    """
    lines = [opening(verdicts, causes), run]
    for verdict in verdicts:
        row = f"{verdict.scene} {verdict.rung} {with_numbers(verdict)}"
        lines.append(f"{verdict.verdict}  {row}")
        # No tolerance decides what was not compared, as rows that a file does not have.
        is_open = verdict.verdict is Status.UNDECIDED and not verdict.is_compared
        if verdict.verdict in _MENDS and not (verdict.is_waived or is_open):
            lines.append(f"    {_MENDS[verdict.verdict]}")
    for cause in causes:
        lines.append(cause_line(cause.sentence, f"{cause.scene} {cause.rung}".strip()))
    return [*filter(None, lines), *map(note_line, notes)]


def cause_line(sentence: str, run: str = "") -> str:
    """Return the line of a likely cause, with the run that it is about where there are several."""
    return ": ".join(filter(None, ("likely cause", run, sentence)))


def note_line(note: str) -> str:
    """Return the line of what was found out about an answer."""
    return f"note: {note}"


def with_numbers(verdict: Verdict) -> str:
    """Return the sentence of a verdict and, unless it is a pass, the numbers that decide it."""
    if verdict.verdict is Status.PASS or not verdict.is_compared:
        return verdict.sentence
    size = "not finite" if verdict.max is None else figure(verdict.max)
    unit = f" ({verdict.unit})" if verdict.unit else ""
    where = "" if verdict.ratio_at is None else f" at t = {instant(verdict.ratio_at)}"
    return (
        f"{verdict.sentence}; largest error {size}{unit} at t = {instant(verdict.at)}, where "
        f"{figure(verdict.bound)} is allowed; up to {ratio(verdict)} times what perfect rounding "
        f"would leave{where}"
    )


def allowance(verdict: Verdict) -> str:
    """Return the bound of a verdict that was compared, and its arithmetic."""
    bound = "" if verdict.bound is None else f"{verdict.bound:.3g} = "
    return f"{bound}{verdict.reason.allowance}"


def event_lines(document: Mapping[str, Any]) -> Iterator[str]:
    """Yield a line for each time of a judgement as `check --event --json` prints it."""
    for row in document["events"]:
        allowed = "" if row["bound"] is None else f", {figure(row['bound'])} allowed"
        off = f"off by {figure(row['error'])}{allowed}"
        digits = f"{row['digits']} digit{'s' * (row['digits'] != 1)}"
        yield f"t = {_shortest(row['given'])}: right to {digits} ({off})"
    for row in document["missed"]:
        yield f"missed: t = {row['t']}"
    for time in document["invented"]:
        yield f"invented: t = {_shortest(time)}"
    for row in document["undecided"]:
        yield f"undecided: t = {row['t']}, within {row['radius']}"
    if "because" in document:
        yield f"undecided: {document['because']}"


def _shortest(time: float) -> str:
    """Return the shortest decimal that is read as a double: 0.41, and not 0.40999999999999998."""
    return repr(float(time)).removesuffix(".0")
