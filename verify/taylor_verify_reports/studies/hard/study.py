"""The study of the hard scenes: verdicts, a search for the worst, and the reach of each precision."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Final

from taylor_verify.records.replacement import replace_files
from taylor_verify_reports.studies.hard import page
from taylor_verify_reports.studies.hard.document import HARD
from taylor_verify_reports.studies.hard.picture import pictures
from taylor_verify_reports.studies.study import Measured, Option, Progress, Study

# Runs of a published search in each family, and enough for the first population and one more generation.
RUNS: Final = 400
LEAST_RUNS: Final = 10


def _measure(folder: Path, progress: Progress, runs: int = 0, seed: int = 1) -> Measured:
    """Run all extremes and follow the families; with ``runs``, search for the worst scenes before.

    Unexpected verdicts are published too, and marked. Without a search the stored one stays.
    """
    from taylor_verify_reports.studies.hard import measure, reach

    earlier, shipped = HARD.find(folder), list[Path]()
    search, worst = (earlier.search, earlier.worst) if earlier else (None, ())
    if runs:
        from taylor_verify.scenes.library import WORST, cases_directory
        from taylor_verify_reports.studies.hard.search import SEARCHED, search_all

        results = search_all(runs, seed, progress.counting(len(SEARCHED)))
        search, worst = measure.searched(runs, seed), tuple(one.row() for one in results)
        texts = {one.family.name: one.scene_text for one in results}
        shipped = store_scenes(cases_directory() / WORST, texts)
    with progress.jobs() as job_progress:
        judgements = measure.extremes(job_progress)
    rows = reach.measure(progress.counting(len(reach.members())))
    study = replace(measure.study(judgements, rows), search=search, worst=worst)
    written = [*HARD.write(folder, study), *shipped]
    return Measured(written, study.mismatches, judgements.exit_status)


def store_scenes(folder: Path, scenes: Mapping[str, str]) -> list[Path]:
    """Write scene files, TOML by their names, in place of all in ``folder``. Raises OSError."""
    texts = {f"{name}.toml": text for name, text in scenes.items()}
    return list(replace_files(folder, texts, stale=folder.glob("*.toml")))


def _runs(text: str) -> int:
    with suppress(ValueError):
        if int(text) >= LEAST_RUNS:
            return int(text)
    raise ValueError(f"expected a whole number of at least {LEAST_RUNS}, got {text}")


def _seed(text: str) -> int:
    with suppress(ValueError):
        return int(text)
    raise ValueError(f"expected a whole number, got {text}")


STUDY: Final = Study(
    name="hard",
    title="hard scenes: their verdicts, the worst found, and how far each precision carries",
    duration="ten minutes, all cores",
    measure=_measure,
    find=HARD.find,
    page=page.page,
    sheet=page.sheet,
    draw=pictures,
    options=(
        Option(
            "runs",
            "search each family for the worst scene with N runs, and replace the shipped ones; "
            f"{RUNS} are published",
            _runs,
        ),
        Option("seed", "the seed of the search; default: 1", _seed),
    ),
)
