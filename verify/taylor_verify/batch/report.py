"""What is written of many runs: a report folder, and a JUnit file. This module alone knows `publish`."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING

from taylor_verify.batch.comparison import Comparison, Earlier
from taylor_verify.batch.judgements import Judgements
from taylor_verify.judge.judgement import Judgement
from taylor_verify.judge.rounding_class import Departure
from taylor_verify.records.provenance import Machine
from taylor_verify.records.status import Status
from taylor_verify.records.studies.extremes import (
    Expected,
    ExtremesStudy,
    ExtremeVerdict,
    Titled,
)
from taylor_verify.records.verdict import Verdict

if TYPE_CHECKING:
    from taylor_verify.publish.ci.case import Remark


class ReportNotWritten(OSError):  # noqa: N818 (it names what happened to the report)
    """A run came to its end and its report could not be written; ``results`` are the judgements."""

    def __init__(self, message: str, results: Judgements) -> None:
        super().__init__(message)
        self.results = results


def write_report(folder: str | PathLike[str], results: Judgements) -> list[Path]:
    """Write verdicts, records, tables and a front page of results, as `taylor-verify run --out DIR` does.

    Returns the files. What an earlier run left there is replaced, as a whole or not at all. Raises
    OSError for a folder that cannot be written, and ValueError for two unlike records of one run.
    """
    from taylor_verify.publish import report

    stored = report.write(fspath(folder), results.verdicts, results.records)
    return [*stored, *report.publish(fspath(folder))]


def read_report(folder: str | PathLike[str]) -> Earlier:
    """Read the verdicts of a report folder.

    Raises FileNotFoundError where there are none, and ValueError for a file that holds something else.
    """
    from taylor_verify.publish import report

    return Earlier(fspath(folder), report.load(fspath(folder)))


def compare_with_published(
    results: Judgements | Judgement, folder: str | PathLike[str]
) -> Comparison:
    """Compare a result with a report folder, as `taylor-verify run --against DIR` does.

    Raises what `read_report` raises.
    """
    return read_report(folder).compare_as_published(results)


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
    from taylor_verify.publish.ci.junit import junit
    from taylor_verify.records.replacement import replace_files

    place = Path(file)
    by_remarks = comparison is not None and comparison.decides
    text = junit(shown_verdicts(results), remarks(results, comparison), by_remarks)
    replace_files(place.parent, {place.name: text})


def extremes_study(results: Judgements) -> ExtremesStudy:
    """Return the document that the page of the extremes is made from.

    Raises ValueError for verdicts of unlike versions.
    """
    from taylor_verify.records import store

    agreement, verdicts = results.agreement, results.verdicts
    expected = {row: Expected(Status(e.verdict), e.why) for row, e in agreement.expected.items()}
    return ExtremesStudy(
        versions=store.versions(verdicts),
        machine=Machine(**store.machine(verdicts[0])) if verdicts else Machine(),
        scenes=tuple(Titled(scene.name, scene.title) for scene in results.selection.scenes_run),
        left_out=results.left_out,
        mismatches=tuple(str(mismatch) for mismatch in agreement.mismatches),
        verdicts=tuple(
            ExtremeVerdict.of(v, expected.get((v.scene, v.rung, v.quantity))) for v in verdicts
        ),
    )


# What a CI is shown.


def shown_verdicts(results: Judgements | Judgement) -> list[Verdict]:
    """Return the verdicts without those that are no pass and came as expected: a CI knows no such thing."""
    if isinstance(results, Judgement):
        return list(results.verdicts)
    return [v for v in results.verdicts if results.agreement.met(v) is None]


def remarks(results: Judgements | Judgement, comparison: Comparison | None = None) -> list[Remark]:
    """Return the remarks on rows for a CI, besides their verdicts: unexpected answers, and regressions."""
    remarked = [] if comparison is not None and comparison.decides else _mismatches(results)
    if isinstance(results, Judgements) and results.unjudged and results.exit_status:
        remarked += _undecided(results.verdicts, "nothing was judged")
    if comparison is not None:
        remarked += _regressions(comparison)
        if not comparison.compared:
            remarked += _undecided(results.verdicts, "no row was compared with the baseline")
    return remarked


def _mismatches(results: Judgements | Judgement) -> list[Remark]:
    """Return a failure for each row that is not as expected, its solver's name taken from its run."""
    from taylor_verify.publish.ci.case import Remark

    if isinstance(results, Judgement):
        return []
    solvers = {(v.scene, v.rung): (v.solver, v.setting) for v in results.verdicts}
    return [
        Remark(scene, *solvers[scene, rung], rung, quantity, Status.FAIL, str(mismatch))
        for mismatch in results.agreement.mismatches
        for scene, rung, quantity in (mismatch.row,)
    ]


def _undecided(verdicts: Sequence[Verdict], text: str) -> list[Remark]:
    from taylor_verify.publish.ci.case import Remark

    return [
        Remark(v.scene, v.solver, v.setting, v.rung, v.quantity, Status.UNDECIDED, text)
        for v in verdicts
    ]


def _regressions(comparison: Comparison) -> list[Remark]:
    from taylor_verify.publish.ci.case import Remark

    def remark(status: Status, prefix: str, departure: Departure) -> Remark:
        row = departure.scene, departure.solver, departure.setting, departure.rung
        return Remark(*row, departure.quantity, status, f"{prefix}: {departure}")

    return [
        *(remark(Status.FAIL, "regression", each) for each in comparison.failures),
        *(remark(Status.UNDECIDED, "not comparable", each) for each in comparison.undecided),
    ]
