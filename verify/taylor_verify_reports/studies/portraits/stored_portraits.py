"""The study of the portraits: the data of the page and the pictures of each shipped scene."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Final

from taylor_verify.records import store
from taylor_verify_reports.studies.stored import SceneDocuments, documents
from taylor_verify_reports.studies.study import Bulk, Measured, Progress, Study

# Separators without blanks make the rows of numbers shorter.
PORTRAITS: Final = SceneDocuments(
    f"{store.FOLDER}/portraits", "taylor-verify publish; do not edit", (",", ":")
)


def _measure(folder: Path, progress: Progress) -> Measured:
    from taylor_verify.scenes.library import names
    from taylor_verify_reports.studies.portraits.portrait import portrait

    return Measured(PORTRAITS.write(folder, documents(portrait, names(), progress)))


def _add(folder: Path, scenes: Sequence[str], progress: Progress) -> list[Path]:
    from taylor_verify_reports.studies.portraits.portrait import portrait

    return PORTRAITS.add_made(folder, portrait, scenes, progress)


STUDY: Final = Study[None](
    name="portraits",
    title="what each shipped scene is and how it moves, as data for pages and pictures",
    duration="a minute, all cores",
    measure=_measure,
    bulk=(
        Bulk(
            what="portraits of scenes",
            patterns=(f"{PORTRAITS.folder}/",),
            lacking=lambda report: report.outdated_scenes(PORTRAITS.folder),
            make=_add,
        ),
    ),
)
