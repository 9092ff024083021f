"""Data of a report that the site and the gallery read: verdicts, records, portraits and measurements.

    portrait   data/portraits/NAME.json: one scene in text, equations, exact values and a dense course;
               without it the page of a scene has fewer sections
record     data/records/NAME.taylor.RUNG.json: every sample's error of one run
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Final

from taylor_verify.records import store
from taylor_verify.records.precisions import place_of_rung
from taylor_verify.records.runs import Run, runs
from taylor_verify_reports.studies.controls.sight import CONTROLS, Sight
from taylor_verify_reports.studies.portraits.stored_portraits import PORTRAITS

Document = Mapping[str, Any]

_SOLVER: Final = "taylor"


@dataclass(frozen=True)
class Report:
    """The report in ``folder``; each part is read on its first use.

    Every part raises OSError for files that cannot be read and ValueError for files that hold something
    else. A measurement that is not stored is None.
    """

    folder: Path

    @cached_property
    def runs(self) -> tuple[Run, ...]:
        """The runs in reading order."""
        return runs(store.load(self.folder))

    @cached_property
    def versions(self) -> dict[str, str]:
        """The packages of all runs, with their versions."""
        return store.versions(verdict for run in self.runs for verdict in run.verdicts)

    @cached_property
    def machines(self) -> list[Document]:
        """Processor, Python and command of the runs, each machine once."""
        return list((self._stored(store.TIMINGS) or {}).get("machines", ()))

    @cached_property
    def scenes(self) -> tuple[str, ...]:
        """The scenes in reading order, each once."""
        return tuple(dict.fromkeys(run.scene for run in self.runs))

    @cached_property
    def rungs(self) -> tuple[str, ...]:
        """The rungs in rising order."""
        return tuple(sorted({run.rung for run in self.runs}, key=place_of_rung))

    def runs_of(self, scene: str) -> list[Run]:
        """Return the runs of one scene."""
        return [run for run in self.runs if run.scene == scene]

    def main_runs_of(self, scene: str) -> list[Run]:
        """Return the runs of one scene by our own solver, or else by the first that it was given to."""
        all_runs = self.runs_of(scene)
        first = min(all_runs, key=lambda run: run.solver != _SOLVER)
        solver = (first.solver, first.setting)
        return [run for run in all_runs if (run.solver, run.setting) == solver]

    def portrait(self, scene: str) -> Document | None:
        """Return the portrait of a scene; None if it is not stored."""
        return PORTRAITS.find(self.folder, scene)

    def records(self, scene: str) -> dict[str, Document]:
        """Return the stored records of a scene by rung."""
        stored = {r: self._stored(store.record_name(scene, _SOLVER, r)) for r in self.rungs}
        return {rung: record for rung, record in stored.items() if record is not None}

    @cached_property
    def sights(self) -> tuple[Sight, ...]:
        """The deliberately broken solvers with the verdicts on them; empty if none are stored."""
        study = CONTROLS.find(self.folder)
        return study.sights if study else ()

    def has(self, place: str) -> bool:
        """Return True if a published file has this path."""
        return (self.folder / place).is_file()

    def read(self, place: str) -> str:
        """Return the text of a published file; empty if there is none."""
        return (self.folder / place).read_text(encoding="utf-8") if self.has(place) else ""

    def _stored(self, name: str) -> Document | None:
        file = self.folder / store.FOLDER / name
        return store.read_document(file) if file.exists() else None
