"""The study of growth: ensembles of starts, followed over decades of time."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from time import monotonic
from typing import Final

from taylor_verify_reports.studies.growth import page
from taylor_verify_reports.studies.growth.page import GROWTH, LONG
from taylor_verify_reports.studies.study import Measured, NotMeasured, Option, Progress, Study

_SECONDS_BETWEEN_REPORTS: Final = 10.0


def _measure(
    folder: Path, progress: Progress, periods: float | None = None, long: bool = False
) -> Measured:
    """Follow the published ensembles, or the long one alone."""
    from taylor_verify_reports.studies.growth import published

    entries = published.LONG if long else published.PUBLISHED
    try:
        study = published.followed(entries, Pieces(progress.say), periods)
    except ValueError as error:
        raise NotMeasured(str(error)) from error
    return Measured((LONG if long else GROWTH).write(folder, study))


def _periods(text: str) -> float:
    from taylor_verify.scenes.reading.table import exact_number

    try:
        return float(exact_number(text))
    except (OverflowError, ValueError) as error:
        raise ValueError(f"expected a number of periods, got {text!r}") from error


class Pieces:
    """Progress report: a line when an ensemble ends, and every few seconds while it is followed."""

    def __init__(self, say: Callable[[str], None]) -> None:
        self._say, self._label, self._reported = say, "", 0.0

    def __call__(self, label: str, done: int, total: int) -> None:
        """Report that ``done`` of ``total`` pieces of the ensemble ``label`` have ended."""
        if done == total:
            self._say(f"{label}: done")
        elif label != self._label or monotonic() - self._reported >= _SECONDS_BETWEEN_REPORTS:
            self._say(f"{label}: piece {done} of {total}")
        else:
            return
        self._label, self._reported = label, monotonic()


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
