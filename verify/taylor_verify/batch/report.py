"""The runs beside an earlier report, and as a JUnit file."""

from __future__ import annotations

from os import PathLike
from pathlib import Path

from taylor_verify.batch.comparison import Comparison, shown_verdicts
from taylor_verify.batch.differences import Difference
from taylor_verify.batch.judgements import Judgements
from taylor_verify.judge.judgement import Judgement
from taylor_verify.records.answers import LikelyCause
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.words.account import cause_line
from taylor_verify.words.case import Remark


class ReportNotWritten(OSError):  # noqa: N818 (it names what happened to the report)
    """A run came to its end and its report could not be written; ``results`` are the judgements."""

    def __init__(self, message: str, results: Judgements) -> None:
        super().__init__(message)
        self.results = results


def write_junit(
    file: str | PathLike[str],
    results: Judgements | Judgement,
    comparison: Comparison | None = None,
) -> None:
    """Write the verdicts of results as JUnit XML, in place of an earlier file.

    What came as expected is left out. With the ``comparison`` with a baseline, a regression is a failure of
    its row; where that comparison decides alone, what fails its own bound alone is none. The file is green
    only where the exit statuses are 0. Raises OSError.
    """
    from taylor_verify.records.replacement import replace_files
    from taylor_verify.words.junit import junit

    place = Path(file)
    by_remarks = comparison is not None and comparison.decides
    text = junit(shown_verdicts(results), remarks(results, comparison), by_remarks)
    replace_files(place.parent, {place.name: text})


def _explained(results: Judgements | Judgement, cause: LikelyCause) -> list[Verdict]:
    """Return the failed rows of the quantity whose error a likely cause explains."""
    run = (cause.scene, cause.rung)
    return [
        verdict
        for verdict in shown_verdicts(results)
        if verdict.verdict is Status.FAIL
        and verdict.quantity == cause.quantity
        and (not cause.scene or (verdict.scene, verdict.rung) == run)
    ]


def remarks(results: Judgements | Judgement, comparison: Comparison | None = None) -> list[Remark]:
    """Return the remarks on rows for a CI, besides their verdicts: unexpected answers, and regressions."""
    remarked: list[Remark] = []

    def remark(row: Verdict | Difference, status: Status, text: str) -> None:
        run = row.scene, row.solver, row.setting, row.rung
        remarked.append(Remark(*run, row.quantity, status, text))

    if isinstance(results, Judgements):
        if comparison is None or not comparison.decides:
            for mismatch in results.agreement.mismatches:
                remark(mismatch, Status.FAIL, str(mismatch))
        if results.unjudged and results.exit_status:
            for verdict in results.verdicts:
                remark(verdict, Status.UNDECIDED, "nothing was judged")
    if comparison is None or not comparison.decides:
        for cause in results.causes:
            for verdict in _explained(results, cause):
                remark(verdict, Status.FAIL, cause_line(cause.sentence))
    if comparison is not None:
        for failure in comparison.failures:
            remark(failure, Status.FAIL, f"regression: {failure}")
        for difference in comparison.undecided:
            remark(difference, Status.UNDECIDED, f"not comparable: {difference}")
        for verdict in results.verdicts if not comparison.compared else ():
            remark(verdict, Status.UNDECIDED, "no row was compared with the baseline")
        for verdict in results.verdicts if comparison.doubted else ():
            remark(verdict, Status.UNDECIDED, comparison.notes[0])
    return remarked
