"""The study of the worst: a search for the largest error over attainable in families of extremes."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Final

from taylor_verify_reports.studies.study import Measured, Option, Progress, Study
from taylor_verify_reports.studies.worst import page
from taylor_verify_reports.studies.worst.page import WORST

RUNS: Final = 400
# Enough for the first population and one more generation.
LEAST_RUNS: Final = 10


def _measure(
    folder: Path, progress: Progress, runs: int = RUNS, seed: int = 1, seconds: None = None
) -> Measured:
    """Search every family, and replace the shipped worst scenes by the new ones."""
    from taylor_verify.scenes.library import WORST as SCENES
    from taylor_verify.scenes.library import cases_directory
    from taylor_verify_reports.studies.worst.measure import search, searched_families, study

    families = searched_families()
    results = search(families, runs, seed, progress.counting(len(families)))
    scenes = {result.searched.name: result.scene_text for result in results}
    shipped = page.store_scenes(cases_directory() / SCENES, scenes)
    return Measured([*WORST.write(folder, study(results, runs, seed)), *shipped])


def _runs(text: str) -> int:
    with suppress(ValueError):
        if int(text) >= LEAST_RUNS:
            return int(text)
    raise ValueError(f"expected a whole number of at least {LEAST_RUNS}, got {text}")


def _seconds(text: str) -> None:
    raise ValueError(
        f"expected a budget in runs, which can be repeated (--runs {RUNS}), got {text} s"
    )


def _seed(text: str) -> int:
    with suppress(ValueError):
        return int(text)
    raise ValueError(f"expected a whole number, got {text}")


STUDY: Final = Study(
    name="worst",
    title="the worst that a search has found, family by family",
    duration="some minutes",
    measure=_measure,
    find=WORST.find,
    page=lambda study, folder: page.page(study),
    sheet=page.sheet,
    options=(
        Option("runs", f"the number of runs of the search in each family; default: {RUNS}", _runs),
        Option(
            "seconds",
            "refused: with a limit by time each machine would find other scenes; use --runs",
            _seconds,
            "S",
        ),
        Option("seed", "the seed of the search; default: 1", _seed),
    ),
)
