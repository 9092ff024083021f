"""Bulk of a report folder: files that are made from the stored data, and are not in the repository.

Every study names its own bulk; the sheets of all of them are one kind. The package `paper` makes the paper,
and the pictures as PDF.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatch
from pathlib import Path
from typing import Any, Final

from taylor_verify.records import store
from taylor_verify.records.replacement import replace_files
from taylor_verify.scenes.library import names
from taylor_verify.scenes.reading.reader import load
from taylor_verify_reports.studies import figures
from taylor_verify_reports.studies.paper.pack import FOLDER, PDF
from taylor_verify_reports.studies.paper.sources import lacking as unmeasured
from taylor_verify_reports.studies.registry import STUDIES
from taylor_verify_reports.studies.study import Bulk, Progress, Published

_RENDERINGS: Final = (f"{figures.FOLDER}/*.pdf", f"{FOLDER}/")
_TO_SEARCH: Final = ("tables/*.csv", "tables/gates.md")


def _tables_lacking(report: Published) -> list[tuple[str, str]]:
    """Return path and text of each table for searching that is missing or outdated."""
    pages = (page for study in STUDIES for page in study.pages(report.folder).items())
    return [
        (name, text)
        for name, text in pages
        if any(fnmatch(name, pattern) for pattern in _TO_SEARCH)
        and not _holds(report.folder / name, text)
    ]


def _holds(file: Path, text: str) -> bool:
    return file.is_file() and file.read_text(encoding="utf-8") == text


_TABLES: Final = Bulk(
    what="tables for searching",
    patterns=_TO_SEARCH,
    lacking=_tables_lacking,
    make=lambda folder, lacking, progress: replace_files(folder, dict(lacking)),
)


def _kinds() -> Iterator[Bulk]:
    yield _TABLES
    for study in STUDIES:
        yield from study.bulk


def patterns() -> tuple[str, ...]:
    """Return the patterns of .gitignore for all bulk, relative to the report folder."""
    return (*(pattern for bulk in _kinds() for pattern in bulk.patterns), *_RENDERINGS)


@dataclass(frozen=True)
class Missing:
    """Bulk that is missing in ``folder``: the data of each kind, and the files that `--paper` writes."""

    folder: Path
    lacking: tuple[tuple[Bulk, Sequence[Any]], ...]
    renderings: tuple[str, ...]

    @property
    def data(self) -> str:
        """The missing data in words; empty if nothing is missing."""
        return ", ".join(f"{len(lacking)} {bulk.what}" for bulk, lacking in self.lacking)

    def make(self, progress: Progress) -> Iterator[Path]:
        """Make the data, and yield the files written."""
        for bulk, lacking in self.lacking:
            yield from bulk.make(self.folder, lacking, progress)


def missing(folder: Path, digests: Mapping[str, str] | None = None) -> Missing:
    """Return the bulk that is missing in ``folder``, or made from older verdicts or scenes.

    ``digests`` has the SHA-256 of every scene that can be run; by default, of the shipped scenes.
    Raises OSError for a folder without verdicts, and ValueError for files that hold something else.
    """
    known = {name: load(name).digest for name in names()} if digests is None else digests
    report = Published(folder, store.load(folder), known)
    bulks = [(bulk, bulk.lacking(report)) for bulk in _kinds()]
    drawings = sorted((folder / figures.FOLDER).glob("*.svg"))
    drawn = (f"{figures.FOLDER}/{drawing.stem}.pdf" for drawing in drawings)
    # The paper can be made only when all of its studies are measured.
    renderings = () if unmeasured(folder) else (f"{FOLDER}/{PDF}", *drawn)
    return Missing(
        folder,
        tuple((bulk, lacking) for bulk, lacking in bulks if lacking),
        tuple(name for name in renderings if not (folder / name).exists()),
    )
