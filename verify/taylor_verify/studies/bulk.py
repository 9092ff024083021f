"""The bulk of a report folder: files that are made from the rest, which the repository does not hold.

data/records, data/portraits    every sample of every run; what each scene is and how it moves
reference/*.json                the exact trajectories with the questions that they answer
tables/gates.*                  every verdict with its reason, as the verdicts have them
tables/*.tex, *.html, *.pdf     renderings of the pages and of their pictures
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from taylor_verify.records import store
from taylor_verify.records.file_names import of_scene
from taylor_verify.records.runs import Run, runs
from taylor_verify.records.status import Status
from taylor_verify.studies import figures
from taylor_verify.studies.paper import PAGES
from taylor_verify.studies.portraits import stored as portraits
from taylor_verify.studies.reference import page as reference_files

# As .gitignore has them, below the folder.
FILES: Final = (
    "data/records/",
    "data/portraits/",
    "figures/*.pdf",
    "reference/*.json",
    "tables/*.html",
    "tables/*.tex",
    "tables/gates.csv",
    "tables/gates.md",
)
_SOLVER: Final = "taylor"
# A run that was never judged has no record.
_UNJUDGED: Final = (Status.REFUSED, Status.UNAVAILABLE)


@dataclass(frozen=True)
class Missing:
    """What a report folder lacks of its bulk: runs without a record, scenes, and rendered files."""

    runs: tuple[Run, ...]
    portraits: tuple[str, ...]
    references: tuple[str, ...]
    renderings: tuple[str, ...]

    @property
    def data(self) -> str:
        """The data that are missing, in words; empty for none."""
        counts = {
            "records of runs": len(self.runs),
            "portraits of scenes": len(self.portraits),
            "exact trajectories as JSON": len(self.references),
        }
        return ", ".join(f"{count} {name}" for name, count in counts.items() if count)


def missing(folder: Path, digests: Mapping[str, str]) -> Missing:
    """Return what ``folder`` lacks, or has of other verdicts or of another text of a scene.

    ``digests`` has the SHA-256 of every scene that can be run. Raises OSError for a folder without
    verdicts, and ValueError for files that hold something else.
    """
    published = [run for run in runs(store.load(folder)) if run.scene in digests]
    scenes = dict.fromkeys(run.scene for run in published)
    has_records = store.has_own_records(folder)
    return Missing(
        runs=tuple(
            run
            for run in published
            if _has_a_record(run) and not (has_records and _record(folder, run).exists())
        ),
        portraits=tuple(
            scene for scene in scenes if _digest(folder / portraits.FOLDER, scene) != digests[scene]
        ),
        references=tuple(
            scene
            for scene in scenes
            if (folder / reference_files.FOLDER / f"{of_scene(scene)}.csv").exists()
            and _digest(folder / reference_files.FOLDER, scene) != digests[scene]
        ),
        renderings=tuple(name for name in _renderings(folder) if not (folder / name).exists()),
    )


def _has_a_record(run: Run) -> bool:
    is_judged = any(verdict.verdict not in _UNJUDGED for verdict in run.verdicts)
    return run.solver == _SOLVER and not run.setting and is_judged


def _record(folder: Path, run: Run) -> Path:
    return folder / store.FOLDER / store.record_name(run.scene, run.solver, run.rung)


def _digest(place: Path, scene: str) -> Any:
    """The SHA-256 of the scene that a document was made of; None without a document."""
    file = place / f"{of_scene(scene)}.json"
    return store.read_document(file).get("sha256") if file.exists() else None


def _renderings(folder: Path) -> list[str]:
    drawings = sorted((folder / figures.FOLDER).glob("*.svg"))
    pages = [Path(page).stem for page in PAGES if (folder / page).exists()]
    return [
        "tables/gates.md",
        "tables/gates.csv",
        *(f"tables/{page}{ending}" for page in pages for ending in (".tex", ".html")),
        *(f"{figures.FOLDER}/{drawing.stem}.pdf" for drawing in drawings),
    ]
