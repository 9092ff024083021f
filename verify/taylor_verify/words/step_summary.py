"""Verdicts as the summary of a GitHub step: Markdown with failures first, and all rows folded."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final

from taylor_verify.records.verdict import Verdict
from taylor_verify.words.case import Case, Remark, cases
from taylor_verify.words.cells import CELLS, NOTHING, judged
from taylor_verify.words.markdown import bold, code, prose, table
from taylor_verify.words.page_parts import counts

# GitHub takes 1 MiB from a step, and drops a larger summary.
_MOST_BYTES: Final = 1_000_000
_LEGEND: Final = (
    "*Over attainable* is the largest error over what perfect rounding would leave on this orbit. "
    "Only **pass** is green."
)
_NUMBERS: Final = ("max:", "at t:", "bound:", "over attainable:")


def step_summary(
    verdicts: Iterable[Verdict], remarks: Iterable[Remark] = (), beginning: str = ""
) -> str:
    """Return the page within GitHub's limit; ``beginning`` is the sentence that says how it ended."""
    rows = list(verdicts)
    every = cases(rows, remarks)
    notable = [case for case in every if case.sentences]
    for most in (len(every), len(every) // 10, 100, 10):
        text = _page(rows, every, notable, most, beginning)
        if len(text.encode()) <= _MOST_BYTES:
            return text
    return _page(rows, every, notable, 0, beginning)


def _page(
    verdicts: Sequence[Verdict],
    every: Sequence[Case],
    notable: Sequence[Case],
    most: int,
    beginning: str,
) -> str:
    # A row of the second table is short, because it has no reasons.
    folded = every if most == len(every) else ()
    beyond = sum(case.verdict is None or case.status != case.verdict.verdict for case in every)
    blocks = [
        "## taylor-verify",
        bold(prose(beginning)) if beginning else "",
        counts(verdicts),
        bold(f"{beyond} more of the rows count as no pass, for the reasons below.")
        if beyond
        else "",
        _table("What is no pass, or not what it was", notable[:most], reasons=True),
        f"And {len(notable) - most} more." if len(notable) > most else "",
        f"<details><summary>All rows: {len(every)}</summary>\n\n{_table('', folded)}\n\n</details>"
        if folded
        else f"The table of all {len(every)} rows is left out: a summary has no room for it.",
        _LEGEND,
    ]
    return "\n\n".join(filter(None, blocks)) + "\n"


def _table(heading: str, rows_shown: Sequence[Case], reasons: bool = False) -> str:
    if not rows_shown:
        return ""
    columns = ["scene", "rung", "quantity", *_NUMBERS, "verdict", *(["because"] if reasons else [])]
    rows = []
    for case in rows_shown:
        run = " ".join(code(word) for word in (case.scene, case.mark) if word)
        verdict = case.verdict
        numbers = [CELLS[name](verdict) if verdict else NOTHING for name in _NUMBERS]
        because = [prose("; ".join(case.sentences))] if reasons else []
        row = [run, case.rung, code(case.quantity), *numbers, judged(case.status), *because]
        rows.append(row)
    text = table(columns, rows)
    return f"### {heading}\n\n{text}" if heading else text
