"""Report folder of a run: ``data``, then tables and an index made from ``data`` alone."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Final

from taylor_verify.records import store
from taylor_verify.records.replacement import first_line, replace_files
from taylor_verify.records.verdict import Verdict
from taylor_verify.report import csv_tables, published_tables
from taylor_verify.report.index_page import Page, readme
from taylor_verify.words.page_parts import MADE_BY

if TYPE_CHECKING:
    from taylor_verify.batch.judgements import Judgements

FRONT: Final = "README.md"
GATES: Final[Mapping[str, Callable[[Sequence[Verdict]], str]]] = {
    "tables/gates.md": published_tables.gates,
    "tables/gates.csv": csv_tables.gates,
}
"""Makers of the tables with the reason of every verdict, by their paths."""
TABLES: Final[Mapping[str, Callable[[Sequence[Verdict]], str]]] = {
    "tables/accuracy.md": published_tables.accuracy,
    "tables/conserved.md": published_tables.conserved,
    **GATES,
}
"""Makers of all tables of verdicts, by their paths."""


def write_report(folder: str | PathLike[str], results: Judgements) -> list[Path]:
    """Write verdicts, records, tables and an index of results, as `taylor-verify run --out DIR` does.

    Returns the files written. They replace the files of an earlier run, all of them or none. Raises OSError
    for a folder that cannot be written, and ValueError for two different records of one run.
    """
    place = Path(fspath(folder))
    stored = store.write(place, results.verdicts, results.records)
    verdicts = store.load(place)
    with store.expecting("what `run --out` writes", place / store.FOLDER):
        texts = {path: make(verdicts) for path, make in TABLES.items()}
    return [*stored, *replace_files(place, {**texts, **index(place, verdicts)})]


def index(place: Path, verdicts: Sequence[Verdict], besides: Iterable[Page] = ()) -> dict[str, str]:
    """Return the index of a report, which links the pages ``besides`` too.

    There is none in place of a README.md that this program did not make.
    """
    if (place / FRONT).exists() and first_line(place / FRONT) != MADE_BY:
        return {}
    return {FRONT: readme(verdicts, besides)}
