"""Verdicts as the summary of a GitHub step: Markdown, what is no pass first, all rows folded away."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final

from taylor_verify.publish.cells import NOTHING, error, figure, instant, judged, ratio
from taylor_verify.publish.ci.case import Case, Remark, cases
from taylor_verify.publish.markdown import Column, bold, code, prose, table
from taylor_verify.publish.page import counts
from taylor_verify.records.verdict import Verdict

# GitHub takes 1 MiB from a step, and drops a larger summary altogether.
_MOST_BYTES: Final = 1_000_000
_LEGEND: Final = (
    "*Over attainable* is the largest error over what perfect rounding would leave on this orbit. "
    "Only **pass** is green."
)
_NUMBERS: Final = ("max", "at t", "bound", "over attainable")


def step_summary(
    verdicts: Iterable[Verdict], remarks: Iterable[Remark] = (), decision: str = ""
) -> str:
    """The page, never longer than GitHub takes; ``decision`` says what decided if not the verdicts."""
    rows = list(verdicts)
    found = cases(rows, remarks)
    notable = [case for case in found if case.sentences]
    for most in (len(found), len(found) // 10, 100, 10):
        text = _page(rows, found, notable, most, decision)
        if len(text.encode()) <= _MOST_BYTES:
            return text
    return _page(rows, found, notable, 0, decision)


def _page(
    verdicts: Sequence[Verdict],
    found: Sequence[Case],
    notable: Sequence[Case],
    most: int,
    decision: str,
) -> str:
    # A row of the second table is short; it is the reasons that are long.
    folded = found if most == len(found) else ()
    blocks = [
        "## taylor-verify",
        bold(prose(decision)) if decision else "",
        counts(verdicts),
        _beyond_verdicts(found),
        _table("What is no pass, or not what it was", notable[:most], reasons=True),
        _left_out(len(notable) - most),
        _folded(f"All rows: {len(found)}", _table("", folded))
        if folded
        else f"The table of all {len(found)} rows is left out: a summary has no room for it.",
        _LEGEND,
    ]
    return "\n\n".join(block for block in blocks if block) + "\n"


def _beyond_verdicts(found: Sequence[Case]) -> str:
    """What the counts of verdicts do not say."""
    rows = [case for case in found if case.verdict is None or case.status != case.verdict.verdict]
    text = (
        f"{len(rows)} more of the rows regressed from the baseline, or cannot be held against it."
    )
    return bold(text) if rows else ""


def _left_out(count: int) -> str:
    return f"And {count} more." if count > 0 else ""


def _folded(heading: str, text: str) -> str:
    return f"<details><summary>{heading}</summary>\n\n{text}\n\n</details>"


def _table(heading: str, found: Sequence[Case], reasons: bool = False) -> str:
    if not found:
        return ""
    columns = [Column("scene"), Column("rung"), Column("quantity")]
    columns += [Column(name, to_right=True) for name in _NUMBERS]
    columns += [Column("verdict"), *([Column("because")] if reasons else [])]
    text = table(columns, [_row(case, reasons) for case in found])
    return f"### {heading}\n\n{text}" if heading else text


def _row(case: Case, reasons: bool) -> list[str]:
    because = [prose("; ".join(case.sentences))] if reasons else []
    run = " ".join(code(word) for word in (case.scene, case.mark) if word)
    head = [run, case.rung, code(case.quantity)]
    return [*head, *_figures(case.verdict), judged(case.status), *because]


def _figures(verdict: Verdict | None) -> list[str]:
    if verdict is None:
        return [NOTHING] * len(_NUMBERS)
    return [
        prose(error(verdict)),
        instant(verdict.at),
        figure(verdict.bound),
        ratio(verdict),
    ]
