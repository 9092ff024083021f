"""The study of the width of an enclosure beside its true error, on two motions without a closed form."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from taylor_verify_reports.studies.enclosure.document import EnclosureStudy
from taylor_verify_reports.studies.enclosure.picture import picture
from taylor_verify_reports.studies.stored import Stored
from taylor_verify_reports.studies.study import Measured, Progress, Study

ENCLOSURE: Final = Stored(EnclosureStudy, "enclosure")


def _measure(folder: Path, progress: Progress) -> Measured:
    from taylor_verify_reports.studies.enclosure.measure import study

    with progress.working("enclosure of two motions"):
        return Measured(ENCLOSURE.write(folder, study()))


STUDY: Final = Study(
    name="enclosure",
    title="the proven width of an enclosure beside its true error, as a picture",
    duration="a minute",
    measure=_measure,
    find=ENCLOSURE.find,
    draw=lambda study: [picture(study)],
    needs_heyoka=False,
)
