"""Report folder: ``data`` written after a run; tables and front page made from ``data`` alone."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING

from taylor_verify.publish.entry import Page
from taylor_verify.publish.page import MADE_BY
from taylor_verify.records import store
from taylor_verify.records.record import Record
from taylor_verify.records.replacement import first_line, replace_files
from taylor_verify.records.verdict import Verdict
from taylor_verify.studies.accuracy import page, quoted
from taylor_verify.studies.accuracy.front import front
from taylor_verify.studies.registry import STUDIES, others

if TYPE_CHECKING:
    from taylor_verify.batch.judgements import Judgements

TABLES = "tables"
FRONT = "README.md"
_PAGES_OF_NO_STUDY = (
    Page("tables/traps.md", "a plain heyoka call against the driver of this suite"),
    Page("upstream/README.md", "what to report to heyoka's authors, each in a few lines that run"),
    Page(
        "upstream/engines/README.md",
        "what to report to the authors of engines, each in a script that runs",
    ),
)


def write(folder: Path | str, verdicts: Iterable[Verdict], records: Iterable[Record]) -> list[Path]:
    """Write verdicts and records to ``folder``/data, in place of earlier ones.

    Raises OSError for a folder that cannot be written; its content then stays as it was.
    """
    return list(store.write(Path(folder), verdicts, records))


def load(folder: Path | str) -> tuple[Verdict, ...]:
    """Return the verdicts of ``folder``/data, in reading order. Raises OSError and ValueError."""
    return store.load(Path(folder))


def publish(folder: Path | str) -> list[Path]:
    """Make ``folder``/tables and its front page from ``folder``/data; return the files written.

    Tables that are no longer made are removed. Files that this program did not make stay, even a README.md.
    Raises OSError for files that cannot be read or written, and ValueError for files that hold something
    else.
    """
    place = Path(folder)
    verdicts = load(place)
    texts = {name: text for study in STUDIES for name, text in study.pages(place).items()}
    index = _index(place, verdicts, texts)
    written = replace_files(place, {**texts, **index}, stale=_own_tables(place / TABLES))
    return [*written, *_requote(place, verdicts)]


def publish_index(folder: Path | str) -> list[Path]:
    """Make the front page, the index of the tables and the quoted blocks of other pages again.

    Returns the files written. Raises the errors of `publish`.
    """
    place = Path(folder)
    verdicts = load(place)
    return [*replace_files(place, _index(place, verdicts)), *_requote(place, verdicts)]


def write_report(folder: str | PathLike[str], results: Judgements) -> list[Path]:
    """Write verdicts, records, tables and a front page of results, as `taylor-verify run --out DIR` does.

    Returns the files written. They replace the files of an earlier run, all of them or none. Raises OSError
    for a folder that cannot be written, and ValueError for two different records of one run.
    """
    stored = write(fspath(folder), results.verdicts, results.records)
    return [*stored, *publish(fspath(folder))]


def _index(place: Path, verdicts: Sequence[Verdict], made: Collection[str] = ()) -> dict[str, str]:
    """Return the front page and the index, which link pages that exist or are about to be ``made``."""
    besides = entries(place, made)
    texts = {f"{TABLES}/README.md": page.readme(verdicts, besides)}
    if not (place / FRONT).exists() or first_line(place / FRONT) == MADE_BY:
        texts[FRONT] = front(verdicts, besides)
    return texts


def entries(place: Path, made: Collection[str] = ()) -> list[Page]:
    """Return the pages beside the tables of runs that exist or are about to be ``made``."""

    def is_there(path: str) -> bool:
        return path in made or (place / path).exists()

    pages = (*(Page(study.path, study.title) for study in others()), *_PAGES_OF_NO_STUDY)
    return [replace(page, has_sheet=is_there(page.sheet)) for page in pages if is_there(page.path)]


def _requote(place: Path, verdicts: Sequence[Verdict]) -> tuple[Path, ...]:
    """Make the quoted blocks of the pages beside the report again."""
    return replace_files(place.resolve().parent, quoted.requoted(place, verdicts))


def _own_tables(target: Path) -> list[Path]:
    """Return the Markdown files that this program made, each with its CSV."""
    own = [file for file in target.glob("*.md") if first_line(file) == MADE_BY]
    return own + [file.with_suffix(".csv") for file in own]
