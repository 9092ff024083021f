"""The study of the reference: the exact trajectory of every scene of the standard set, in digits."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Final

from taylor_verify_reports.studies.reference import page
from taylor_verify_reports.studies.study import Bulk, Measured, Progress, Published, Study


def _measure(folder: Path, progress: Progress) -> Measured:
    from taylor_verify.scenes.library import names

    return Measured(page.write(folder, _trajectories(names(), progress)))


def _lacking(report: Published) -> tuple[str, ...]:
    """Return the scenes with a sheet whose JSON is missing or outdated."""
    target = report.folder / page.FOLDER
    return tuple(
        scene
        for scene in report.outdated_scenes(page.FOLDER)
        if (target / page.sheet_of(scene)).exists()
    )


def _add(folder: Path, scenes: Sequence[str], progress: Progress) -> list[Path]:
    written: list[Path] = []
    _trajectories(scenes, progress, lambda one: written.extend(page.add_json(folder, [one])))
    return written


def _trajectories(
    scenes: Sequence[str],
    progress: Progress,
    keep: Callable[[dict[str, Any]], object] | None = None,
) -> list[dict[str, Any]]:
    from taylor_verify_reports.studies.documents import documents
    from taylor_verify_reports.studies.reference.measure import reference

    return documents(reference, scenes, progress.counting(len(scenes)), keep)


STUDY: Final = Study[None](
    name="reference",
    title="exact motions in digits, to test other programs with",
    duration="a minute, all cores",
    measure=_measure,
    place=f"{page.FOLDER}/README.md",
    needs_heyoka=False,
    bulk=(
        Bulk(
            what="exact trajectories as JSON",
            patterns=(f"{page.FOLDER}/*.json",),
            lacking=_lacking,
            make=_add,
        ),
    ),
)
