"""The study of the controls: deliberately broken solvers, and the gates that see their faults."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from taylor_verify_reports.studies.controls import page
from taylor_verify_reports.studies.controls.document import CONTROLS
from taylor_verify_reports.studies.study import Measured, Progress, Study


def _measure(folder: Path, progress: Progress) -> Measured:
    from taylor_verify_reports.controls.defects import DEFECTS
    from taylor_verify_reports.studies.controls.measure import sights, study

    measured = sights(DEFECTS, progress.counting(len(DEFECTS)))
    return Measured(CONTROLS.write(folder, study(measured)))


STUDY: Final = Study(
    name="controls",
    title="what each gate sees of solvers that were broken on purpose",
    duration="a minute",
    measure=_measure,
    find=CONTROLS.find,
    page=lambda study, folder: page.page(study),
    sheet=page.sheet,
)
