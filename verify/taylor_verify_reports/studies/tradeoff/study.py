"""The study of speed against accuracy: every setting on some scenes, timed in fresh processes."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from taylor_verify_reports.studies.study import Measured, Option, Progress, Study
from taylor_verify_reports.studies.tradeoff import page
from taylor_verify_reports.studies.tradeoff.stored import load, write


def _measure(folder: Path, progress: Progress, outside: bool = False) -> Measured:
    from taylor_verify_reports.studies.tradeoff.measurement import measurement

    numbers, times = measurement(with_outside=outside, finished=progress.say)
    return Measured(write(folder, numbers, times))


STUDY: Final = Study(
    name="tradeoff",
    title="speed against accuracy, every solver, measured once",
    duration="minutes, a quiet machine; with --outside twenty",
    measure=_measure,
    find=load,
    page=page.page,
    sheet=page.sheet,
    draw=page.pictures,
    options=(
        Option(
            "outside",
            "also measure compiled integrators of other libraries, in turns with all others; each is "
            "downloaded first",
        ),
    ),
)
