"""The study of the extremes: each one run on float64, beside the expected verdict."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from taylor_verify_reports.studies.extremes import page
from taylor_verify_reports.studies.extremes.page import EXTREMES
from taylor_verify_reports.studies.study import Measured, Progress, Study


def _measure(folder: Path, progress: Progress) -> Measured:
    """Run all extremes; unexpected verdicts are published too, and marked."""
    from taylor_verify_reports.studies.extremes.measure import extremes, extremes_study

    with progress.jobs() as job_progress:
        results = extremes(job_progress)
    study = extremes_study(results)
    return Measured(EXTREMES.write(folder, study), study.mismatches, results.exit_status)


STUDY: Final = Study(
    name="extremes",
    title="what becomes of the hardest scenes, and what was expected of each",
    duration="minutes, all cores",
    measure=_measure,
    find=EXTREMES.find,
    page=lambda study, folder: page.page(study),
    sheet=page.sheet,
)
