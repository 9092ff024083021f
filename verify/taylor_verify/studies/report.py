"""A report folder: ``data`` written after a run; tables and front page made from ``data`` alone."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from os import PathLike, fspath
from pathlib import Path

from taylor_verify.batch.judgements import Judgements
from taylor_verify.publish.page import MADE_BY
from taylor_verify.records import store
from taylor_verify.records.record import Record
from taylor_verify.records.replacement import first_line, replace_files
from taylor_verify.records.verdict import Verdict
from taylor_verify.studies import figures
from taylor_verify.studies.accuracy import attainable, quoted
from taylor_verify.studies.accuracy import page as tables
from taylor_verify.studies.accuracy import sheet as sheets
from taylor_verify.studies.accuracy.front import front
from taylor_verify.studies.contents import others
from taylor_verify.studies.controls import page as controls
from taylor_verify.studies.controls import stored as sights
from taylor_verify.studies.controls.document import ControlsStudy
from taylor_verify.studies.extremes import page as extremes
from taylor_verify.studies.growth import page as growth
from taylor_verify.studies.prices import page as prices
from taylor_verify.studies.reach import page as reach
from taylor_verify.studies.tradeoff import page as tradeoff
from taylor_verify.studies.tradeoff import stored as trades
from taylor_verify.studies.tradeoff.document import TradeNumbers, TradeTimings
from taylor_verify.studies.worst import page as worst

TABLES = "tables"
FRONT = "README.md"


def write(folder: Path | str, verdicts: Iterable[Verdict], records: Iterable[Record]) -> list[Path]:
    """Write verdicts and records to ``folder``/data, in place of earlier ones.

    Raises OSError for a folder that cannot be written; what it held then stays as it was.
    """
    return list(store.write(Path(folder), verdicts, records))


def load(folder: Path | str) -> tuple[Verdict, ...]:
    """The verdicts of ``folder``/data, in reading order."""
    return store.load(Path(folder))


def publish(folder: Path | str) -> list[Path]:
    """Make ``folder``/tables and its front page from ``folder``/data; return the files written.

    Tables of an earlier version that are no longer made are removed; other files are left alone,
    a README.md that is not ours among them. Raises OSError for files that cannot be read or
    written, ValueError for data that are none.
    """
    place = Path(folder)
    verdicts = load(place)
    measured = (
        *(_controls(place), tradeoff.pages(place), prices.pages(place)),
        *(
            growth.pages(place),
            worst.pages(place),
            reach.pages(place),
            extremes.pages(place),
        ),
    )
    texts = {name: text for pages in measured for name, text in pages.items()}
    besides = others(place, texts)
    texts |= {
        f"{TABLES}/README.md": tables.readme(verdicts, besides),
        f"{TABLES}/accuracy.md": tables.accuracy(verdicts),
        f"{TABLES}/accuracy.csv": sheets.accuracy(verdicts),
        f"{TABLES}/attainable.md": attainable.attainable(verdicts),
        f"{TABLES}/attainable.csv": sheets.attainable(verdicts),
        f"{TABLES}/conserved.md": tables.conserved(verdicts),
        f"{TABLES}/conserved.csv": sheets.conserved(verdicts),
        **_gates(verdicts),
    }
    if _is_ours_or_new(place / FRONT):
        texts[FRONT] = front(verdicts, besides)
    written = replace_files(place, texts, stale=_own_tables(place / TABLES))
    return [*written, *replace_files(place.resolve().parent, quoted.requoted(place, verdicts))]


def write_report(folder: str | PathLike[str], results: Judgements) -> list[Path]:
    """Write verdicts, records, tables and a front page of results, as `taylor-verify run --out DIR` does.

    Returns the files. What an earlier run left there is replaced, as a whole or not at all. Raises
    OSError for a folder that cannot be written, and ValueError for two unlike records of one run.
    """
    stored = write(fspath(folder), results.verdicts, results.records)
    return [*stored, *publish(fspath(folder))]


def publish_gates(folder: Path | str) -> list[Path]:
    """Make the tables of the gates alone from ``folder``/data. The errors are those of `publish`."""
    return list(replace_files(Path(folder), _gates(load(folder))))


def publish_controls(folder: Path | str, study: ControlsStudy) -> list[Path]:
    """Store a controls run in ``folder``/data and make ``folder``/tables/controls of it.

    Raises OSError for a folder that cannot be written.
    """
    place = Path(folder)
    stored = sights.write(place, study)
    return [stored, *replace_files(place, _controls(place))]


def publish_tradeoff(folder: Path | str, numbers: TradeNumbers, times: TradeTimings) -> list[Path]:
    """Store a measurement of speed and accuracy in ``folder``/data, draw it and make its page.

    Raises OSError for a folder that cannot be written, ImportError without matplotlib.
    """
    place = Path(folder)
    stored = list(trades.write(place, numbers, times))
    found = trades.load(place)
    if found is not None:
        pictures = [one for trade in found.trades for one in figures.of_trade(trade)]
        stored += figures.draw(place, [*pictures, *figures.of_rungs(found.trades)])
    return [*stored, *replace_files(place, tradeoff.pages(place))]


def _gates(verdicts: Sequence[Verdict]) -> dict[str, str]:
    return {
        f"{TABLES}/gates.md": tables.gates(verdicts),
        f"{TABLES}/gates.csv": sheets.gates(verdicts),
    }


def _controls(place: Path) -> dict[str, str]:
    """The table of what each gate sees, in Markdown and as a sheet; nothing without stored rows."""
    if not (place / sights.CONTROLS).exists():
        return {}
    study = sights.load(place)
    return {
        f"{TABLES}/controls.md": controls.page(study),
        f"{TABLES}/controls.csv": controls.sheet(study),
    }


def _is_ours_or_new(file: Path) -> bool:
    return not file.exists() or first_line(file) == MADE_BY


def _own_tables(target: Path) -> list[Path]:
    """The Markdown files that name us as their maker, each with its CSV twin."""
    own = [file for file in target.glob("*.md") if first_line(file) == MADE_BY]
    return own + [file.with_suffix(".csv") for file in own]
