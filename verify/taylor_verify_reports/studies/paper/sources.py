"""Stored documents that the paper is made from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Final

from taylor_verify.records import store
from taylor_verify.records.runs import Run, runs
from taylor_verify.records.verdict import Verdict
from taylor_verify.words.markdown import prose
from taylor_verify_reports.studies.controls.sight import CONTROLS, ControlsStudy
from taylor_verify_reports.studies.engines import document as engines
from taylor_verify_reports.studies.engines.document import Board
from taylor_verify_reports.studies.engines.entry import Entry, EntryList, entry_list
from taylor_verify_reports.studies.engines.ranking import Score, best_of_each, settings
from taylor_verify_reports.studies.hard.hard_scenes import HARD, HardStudy
from taylor_verify_reports.studies.tradeoff import trades as tradeoff
from taylor_verify_reports.studies.tradeoff.trades import Trades

# Each study with its file, which exists once the study is measured.
_FILES: Final = {
    "controls": CONTROLS.name,
    "engines": engines.ENGINES.name,
    "hard": HARD.name,
    "tradeoff": tradeoff.NUMBERS.name,
}


@dataclass(frozen=True)
class Sources:
    """Verdicts on the standard set, and four studies."""

    verdicts: tuple[Verdict, ...]
    controls: ControlsStudy
    board: Board
    hard: HardStudy
    trades: Trades

    @cached_property
    def runs(self) -> Sequence[Run]:
        """The runs of the standard set."""
        return runs(self.verdicts)

    @property
    def processors(self) -> str:
        """The processors of the runs, in words."""
        processors = {
            v.provenance["processor"] for v in self.verdicts if "processor" in v.provenance
        }
        return ", ".join(sorted(processors))

    @cached_property
    def entries(self) -> EntryList:
        """The list of engines, with their titles."""
        return entry_list()

    @cached_property
    def engine_scene(self) -> str:
        """The scene on which the engines are compared."""
        return self.entries.advised[0]

    @cached_property
    def best(self) -> list[Score]:
        """The best setting of each engine on that scene, plain solvers included."""
        return best_of_each(settings(self.board.study), self.engine_scene)

    def title_of(self, score: Score) -> str:
        """Return the title and the version of an engine in Markdown."""
        return prose(f"{self._entry_of(score).title} {score.setting.version}".strip())

    def is_plain(self, score: Score) -> bool:
        """Return True for a solver of differential equations that is no engine."""
        return self._entry_of(score).plain

    def _entry_of(self, score: Score) -> Entry:
        engine = score.setting.engine
        return next(entry for entry in self.entries.entry if entry.name == engine)


def lacking(folder: Path) -> list[str]:
    """Return the studies of the paper that are not stored in a report folder."""
    return [name for name, file in _FILES.items() if not (folder / file).exists()]


def read(folder: Path) -> Sources:
    """Return the sources below a report folder.

    Raises OSError for files that cannot be read, and ValueError for a study that is missing or a file that
    holds something else.
    """
    verdicts = store.load(folder)
    if unmeasured := lacking(folder):
        raise ValueError(
            f"expected what `publish {' '.join(unmeasured)}` writes, got a report without it @ {folder}"
        )
    board, trades = engines.find(folder), tradeoff.load(folder)
    assert board is not None
    assert trades is not None
    return Sources(verdicts, CONTROLS.load(folder), board, HARD.load(folder), trades)
