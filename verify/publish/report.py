"""A report folder: ``data`` written after a run, and ``tables`` made from ``data`` alone."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from verify.judge.record import Record
from verify.judge.verdict import Verdict
from verify.publish import data, sheets, tables
from verify.publish.page import MADE_BY
from verify.publish.replacement import first_line, replace_files

TABLES = "tables"


def write(folder: Path | str, verdicts: Iterable[Verdict], records: Iterable[Record]) -> list[Path]:
    """Write verdicts and records to ``folder``/data, in place of earlier ones.

    Raises OSError for a folder that cannot be written; what it held then stays as it was.
    """
    return list(data.write(Path(folder), verdicts, records))


def load(folder: Path | str) -> tuple[Verdict, ...]:
    """The verdicts of ``folder``/data, in reading order."""
    return data.load(Path(folder))


def publish(folder: Path | str) -> list[Path]:
    """Make ``folder``/tables from ``folder``/data and return the files written.

    Tables of an earlier version that are no longer made are removed; other files are left alone.
    Raises OSError for files that cannot be read or written, ValueError for data that are none.
    """
    verdicts = load(folder)
    texts = {
        "README.md": tables.readme(verdicts),
        "accuracy.md": tables.accuracy(verdicts),
        "accuracy.csv": sheets.accuracy(verdicts),
        "conserved.md": tables.conserved(verdicts),
        "conserved.csv": sheets.conserved(verdicts),
        "gates.md": tables.gates(verdicts),
        "gates.csv": sheets.gates(verdicts),
    }
    target = Path(folder) / TABLES
    return list(replace_files(target, texts, stale=_own_tables(target)))


def _own_tables(target: Path) -> list[Path]:
    """The Markdown files that name us as their maker, each with its CSV twin."""
    own = [file for file in target.glob("*.md") if first_line(file) == MADE_BY]
    return own + [file.with_suffix(".csv") for file in own]
