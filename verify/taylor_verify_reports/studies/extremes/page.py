"""Page of the extremes, made from the stored verdicts of one run.

    extremes.json   every verdict with the expected one; the titles of the scenes; the runs that were
                    left out; the versions that made the rows

The extremes are hard scenes. A verdict other than `pass` is either expected, with a reason, or a mismatch.
The page lists mismatches in its summary, and every verdict other than `pass` with its reason.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from taylor_verify.records import store
from taylor_verify.records.json_text import complete, plain
from taylor_verify.records.runs import Run, gravest, runs
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict, read_study
from taylor_verify.report import csv_tables as sheets
from taylor_verify.words.cells import NOTHING, figure, judged, peak, reason, word, worst_ratio
from taylor_verify.words.markdown import bold, bullets, code, prose, table
from taylor_verify.words.page import counts, roundoffs, traced, whole
from taylor_verify_reports.studies.extremes.document import ExtremesStudy, ExtremeVerdict
from taylor_verify_reports.studies.stored import Stored

_FOLDER: Final = "extremes/"

_WHAT: Final = (
    "These scenes are extreme: beside a separatrix and on it, with moments nearly equal or far apart, "
    "sizes near the ends of the number range, many periods, and the worst scenes that a search has "
    "found. The right verdict is not always *pass*. If rounding alone may change a motion by its own "
    "size, the right verdict is *vacuous*. The right verdict of each scene is written down "
    "beforehand, with its reason, and a mismatch in either direction is a fail."
)
_LEGEND: Final = (
    "*state* is the main quantity, the angular velocity or the impulse: *max, mean @ t of the max*, "
    "in u, or a word for a missing number.",
    "*over attainable* is the largest of all quantities of the scene, with the name of the quantity; "
    "a gate allows ten.",
    "*verdict* is the gravest of all quantities. *as expected* counts the quantities with the "
    "expected verdict; a mismatch is bold.",
)


# The document.


def _fields(study: ExtremesStudy) -> dict[str, Any]:
    """Return the stored keys and values without the seconds of runs, which differ between machines."""
    rows = [store.row(verdict) for verdict in study.verdicts]
    return {**complete(study), "machine": plain(study.machine), "verdicts": rows}


EXTREMES: Final = Stored(ExtremesStudy, "extremes", _fields, read_study)


# The page.


def page(study: ExtremesStudy) -> str:
    """Return the counts, a line for each scene, and every verdict other than pass with its reason."""
    by_model: dict[str, list[Run]] = {}
    for run in runs(study.verdicts):
        by_model.setdefault(run.model, []).append(run)
    return whole(
        "The extremes",
        _WHAT,
        counts(study.verdicts),
        _summary(study),
        bullets([*_LEGEND, roundoffs(study.verdicts)]),
        *(_section(study, own, model) for model, own in by_model.items()),
        "## No pass, and why",
        _not_passed(study),
        _left_out(study),
        "## To remake this",
        f"`taylor-verify publish extremes` runs all of them on float64 and writes "
        f"[extremes.json](../{EXTREMES.name}), this page and its [CSV](extremes.csv), which has every "
        "quantity. `taylor-verify run extremes` prints the same and fails at a mismatch; with `--rung` it "
        "runs them on others. The expectations are in `cases/extremes/EXPECTED.toml`.",
        traced({"versions": study.versions, **plain(study.machine)}),
    )


def _summary(study: ExtremesStudy) -> str:
    """Return the number of expected verdicts, and all mismatches in full."""
    others = [verdict for verdict in study.verdicts if verdict.verdict is not Status.PASS]
    met = sum(verdict.is_met for verdict in others)
    counted = f"{met} of {len(others)} verdicts other than pass were expected."
    if not study.mismatches:
        return counted
    faults = bullets(map(prose, study.mismatches))
    return f"{counted} {bold(f'{len(study.mismatches)} mismatches')}:\n\n{faults}"


def _section(study: ExtremesStudy, own: Sequence[Run], model: str) -> str:
    columns = [
        "scene",
        "rung",
        "what it is",
        "state:",
        "over attainable:",
        "verdict",
        "as expected:",
    ]
    rows = [_cells(study, run) for run in own]
    return f"## {model or 'Without a state'}\n\n{table(columns, rows)}"


def _cells(study: ExtremesStudy, run: Run) -> list[str]:
    main = run.state[0] if run.state else run.verdicts[0]
    met = sum(isinstance(row, ExtremeVerdict) and row.is_met for row in run.verdicts)
    counted = f"{met} of {len(run.verdicts)}"
    return [
        code(run.scene.removeprefix(_FOLDER)),
        run.rung,
        prose(study.titles.get(run.scene, "")),
        _state(main),
        worst_ratio(v for v in run.verdicts if v.verdict in (Status.PASS, Status.FAIL)),
        judged(gravest(run.verdicts)),
        counted if met == len(run.verdicts) else bold(counted),
    ]


def _state(verdict: Verdict) -> str:
    """Return the error with the verdict unless that is a pass; a word if the error is no number."""
    if verdict.max is None:
        return bold(prose(word(verdict)))
    text = prose(peak(verdict))
    return text if verdict.verdict is Status.PASS else f"{text} {judged(verdict.verdict)}"


def _not_passed(study: ExtremesStudy) -> str:
    """Return a line for every verdict other than pass, beside the expected one."""
    columns = ["scene", "quantity", "verdict", "expected", "bound:", "why"]
    rows = [
        _row(verdict)
        for verdict in study.verdicts
        if verdict.verdict is not Status.PASS or not verdict.is_met
    ]
    return table(columns, rows) if rows else "Every answer is a pass."


def _row(verdict: ExtremeVerdict) -> list[str]:
    wanted = verdict.expected
    expected = wanted.verdict.value if wanted else NOTHING
    return [
        code(verdict.scene.removeprefix(_FOLDER)),
        code(verdict.quantity),
        judged(verdict.verdict),
        expected if verdict.is_met else bold(expected),
        figure(verdict.bound),
        prose((wanted.why if wanted else "") or reason(verdict)),
    ]


def _left_out(study: ExtremesStudy) -> str:
    lines = [f"{code(run.scene)}, {run.rung}: {prose(run.why)}" for run in study.left_out]
    return f"Not run:\n\n{bullets(lines)}" if lines else ""


def sheet(study: ExtremesStudy) -> str:
    """Return a row for every quantity of every scene."""

    def expected(verdict: Verdict) -> dict[str, Any]:
        assert isinstance(verdict, ExtremeVerdict)
        wanted = verdict.expected
        return {
            "title": study.titles.get(verdict.scene),
            "expected": wanted.verdict.value if wanted else None,
            "why_expected": wanted.why if wanted else None,
            "as_expected": "yes" if verdict.is_met else "no",
        }

    # The reasons of the bounds are long texts, and extremes.json has them.
    return sheets.gates(study.verdicts, expected, without=("because", "scene_sha256"))
