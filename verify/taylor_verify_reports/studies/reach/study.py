"""The study of the reach of each precision in families of extremes."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from taylor_verify_reports.studies.reach import page
from taylor_verify_reports.studies.reach.page import REACH
from taylor_verify_reports.studies.study import Measured, Progress, Study


def _measure(folder: Path, progress: Progress) -> Measured:
    from taylor_verify_reports.studies.reach.measure import members, study

    return Measured(REACH.write(folder, study(progress.counting(len(members())))))


STUDY: Final = Study(
    name="reach",
    title="how far each precision carries, and where it ends",
    duration="minutes, all cores",
    measure=_measure,
    find=REACH.find,
    page=page.page,
    sheet=page.sheet,
    draw=page.pictures,
)
