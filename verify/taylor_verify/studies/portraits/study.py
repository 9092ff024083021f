"""The portraits as a study: all that pages and pictures show of each shipped scene."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Final

from taylor_verify.studies.portraits import stored
from taylor_verify.studies.study import Bulk, Measured, Progress, Published, Study


def _measure(folder: Path, progress: Progress) -> Measured:
    from taylor_verify.scenes.library import names
    from taylor_verify.studies.portraits.measure import portraits

    scenes = names()
    return Measured(stored.write(folder, portraits(scenes, progress.counting(len(scenes)))))


def _lacking(report: Published) -> tuple[str, ...]:
    """Return the scenes without a portrait, or with one of another text of the scene."""
    return report.without(stored.FOLDER)


def _add(folder: Path, scenes: Sequence[str], progress: Progress) -> list[Path]:
    from taylor_verify.studies.portraits.measure import portraits

    return stored.add(folder, portraits(scenes, progress.counting(len(scenes))))


STUDY: Final = Study[None](
    name="portraits",
    title="what each shipped scene is and how it moves, as data for pages and pictures",
    duration="a minute, all cores",
    measure=_measure,
    bulk=(Bulk("portraits of scenes", (f"{stored.FOLDER}/",), _lacking, _add),),
)
