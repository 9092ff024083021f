"""Files of a sweep: its summary as Markdown and JSON, and the worst cases as scenes."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from dataclasses import astuple, replace
from pathlib import Path
from typing import Final

from taylor_verify.batch.sweeps.questions import Questions
from taylor_verify.records.json_text import complete
from taylor_verify.records.replacement import first_line, replace_files
from taylor_verify.records.status import Status
from taylor_verify.records.sweep import Quantiles, Spread, SweepSummary, WorstCase
from taylor_verify.words.cells import INFINITE, NOTHING, figure
from taylor_verify.words.markdown import code, prose, table
from taylor_verify.words.page_parts import traced

WORST: Final = "worst"
_SHARES: Final = ("median:", "90 %:", "99 %:", "99.9 %:", "largest:")
_HEADINGS: Final = ("quantity", "judged:", *_SHARES, "fail:", "undecided:")
SUMMARY_NAMES: Final = ("summary.md", "summary.json", WORST)
"""The names in a sweep's folder of the summary and the worst cases."""
_REASON: Final = "# Why: "
# What stands in a name of a scene and in no name of a file.
_ODD: Final = re.compile(r"[^A-Za-z0-9._-]+")


def write_summary(folder: Path, summary: SweepSummary, questions: Questions) -> SweepSummary:
    """Write everything in one step; return the summary with the files of its worst cases.

    Raises OSError.
    """
    worst = (replace(case, file=_file(k, case)) for k, case in enumerate(summary.worst, 1))
    summary = replace(summary, worst=tuple(worst))
    texts = {
        case.file: _reason(summary, case) + questions.text(case.point) for case in summary.worst
    }
    texts |= {
        "summary.md": page(summary),
        "summary.json": json.dumps(complete(summary), indent=1, allow_nan=False) + "\n",
    }
    # Those that are written now are not removed, nor scenes that the user has put there.
    earlier = [
        file for file in (folder / WORST).glob("*.toml") if first_line(file).startswith(_REASON)
    ]
    replace_files(folder, texts, stale=earlier)
    return summary


def page(summary: SweepSummary) -> str:
    """Return the summary as Markdown."""
    judged = f"{summary.total} bodies by {code(summary.solver)} on {code(summary.rung)}: {summary.counts}."
    blocks = [
        f"# {prose(summary.title or summary.name)}",
        judged,
        *(f"Nothing was judged: {prose(lack)}." for lack in summary.lacks),
        *(f"Refused, for example: {prose(refusal)}." for refusal in summary.refusals),
        "The error over what perfect rounding would leave (the roundoff floor), of the rows that passed or "
        f"failed; a body fails above {summary.bound}. "
        "A quantile is an error that occurred, at most a thousandth above the exact quantile.",
        table(_HEADINGS, [_cells(each, each.ratio) for each in summary.quantities]),
        "The largest error of each body, in the unit of its quantity.",
        table(_HEADINGS, [_cells(each, each.max) for each in summary.quantities]),
    ]
    if summary.worst:
        words = "Each has the numbers that `run` finds for its scene."
        blocks += ["## The worst cases", words, _worst_table(summary.worst)]
    return "\n\n".join([*blocks, traced(complete(summary.provenance))]) + "\n"


def _cells(spread: Spread, quantiles: Quantiles | None) -> list[str]:
    shown = [NOTHING] * len(_SHARES)
    if quantiles:
        shown = [INFINITE if size is None else figure(size) for size in astuple(quantiles)]
    last = (spread.counts[status.value] for status in (Status.FAIL, Status.UNDECIDED))
    return [code(spread.quantity), str(spread.judged), *shown, *map(str, last)]


def _worst_table(cases: Sequence[WorstCase]) -> str:
    headings = ["scene", "verdict", "quantity", "over attainable:", "error:", "because"]
    is_explained = any(case.causes for case in cases)
    rows = []
    for case in cases:
        row = [
            f"[{code(case.scene)}]({case.file})",
            case.verdict.value,
            code(case.quantity),
            figure(case.ratio),
            figure(case.max),
            prose(case.because),
        ]
        rows.append([*row, prose("; ".join(case.causes))] if is_explained else row)
    return table([*headings, *(["likely cause"] if is_explained else [])], rows)


def _file(rank: int, case: WorstCase) -> str:
    stem = _ODD.sub("-", Path(case.scene).stem)
    return f"{WORST}/{rank:02d}-{stem}.toml"


def _reason(summary: SweepSummary, case: WorstCase) -> str:
    """Return the comment that begins the scene of a worst case."""
    size = "no number" if case.ratio is None else figure(case.ratio)
    drawn = f", seed {summary.seed}, {summary.points} points" if summary.seed is not None else ""
    tolerance = "" if summary.tolerance is None else f" with the tolerance {summary.tolerance}"
    return (
        f"{_REASON}{case.verdict} in {case.quantity} by {summary.solver} on {summary.rung}{tolerance}.\n"
        f"# Error over attainable: {size}. "
        f"Scene {case.scene} of a sweep of {summary.total}{drawn}.\n"
    )
