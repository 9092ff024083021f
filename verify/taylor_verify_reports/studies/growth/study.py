"""The study of growth: ensembles of starts, followed over decades of time."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from taylor_verify_reports.studies.growth import page
from taylor_verify_reports.studies.growth.page import GROWTH, LONG
from taylor_verify_reports.studies.study import Measured, NotMeasured, Option, Progress, Study


def _measure(
    folder: Path, progress: Progress, periods: float | None = None, long: bool = False
) -> Measured:
    """Follow the published ensembles, or the long one alone."""
    from taylor_verify_reports.studies.growth import published

    def ended(label: str, done: int, total: int) -> None:
        progress.say(f"{label}: piece {done} of {total}")

    questions = published.long() if long else published.published()
    try:
        study = published.followed(questions, ended, periods)
    except ValueError as error:
        raise NotMeasured(str(error)) from error
    return Measured((LONG if long else GROWTH).write(folder, study))


def _periods(text: str) -> float:
    from taylor_verify.scenes.reading.table import exact_number

    try:
        return float(exact_number(text))
    except (OverflowError, ValueError) as error:
        raise ValueError(f"expected a number of periods, got {text!r}") from error


STUDY: Final = Study(
    name="growth",
    title="how drift and phase grow over decades of time",
    duration="ten minutes, all cores; with --long an hour or more",
    measure=_measure,
    find=page.find,
    page=lambda study, folder: page.page(study),
    sheet=page.sheet,
    options=(
        Option("periods", "follow no ensemble for more than N periods", _periods),
        Option("long", "follow only the ensemble of 100 million periods"),
    ),
)
