"""Many runs beside an earlier report, and as a JUnit file. This module of batch alone knows `publish`."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING

from taylor_verify.batch.comparison import Comparison, Earlier
from taylor_verify.batch.judgements import Judgements
from taylor_verify.judge.judgement import Judgement
from taylor_verify.judge.rounding_class import Departure
from taylor_verify.records import store
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict

if TYPE_CHECKING:
    from taylor_verify.publish.ci.case import Remark


class ReportNotWritten(OSError):  # noqa: N818 (it names what happened to the report)
    """A run came to its end and its report could not be written; ``results`` are the judgements."""

    def __init__(self, message: str, results: Judgements) -> None:
        super().__init__(message)
        self.results = results


def read_report(folder: str | PathLike[str]) -> Earlier:
    """Read the verdicts of a report folder.

    Raises FileNotFoundError where there are none, and ValueError for a file that holds something else.
    """
    return Earlier(fspath(folder), store.load(Path(folder)))


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
