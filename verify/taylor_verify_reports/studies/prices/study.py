"""The study of prices: the cost of each option of a scene."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from taylor_verify_reports.studies.prices import page
from taylor_verify_reports.studies.prices.document import PRICES
from taylor_verify_reports.studies.study import Measured, Progress, Study


def _measure(folder: Path, progress: Progress) -> Measured:
    from taylor_verify_reports.studies.prices.measure import study

    return Measured(PRICES.write(folder, study(progress.say)))


STUDY: Final = Study(
    name="prices",
    title="what each thing costs that a scene may ask for",
    duration="minutes, a quiet machine",
    measure=_measure,
    find=PRICES.find,
    page=lambda study, folder: page.page(study),
    sheet=page.sheet,
)
