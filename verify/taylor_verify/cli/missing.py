"""`publish --missing` and `--archive`: make what a report folder lacks, and pack the whole of it."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Final

from taylor_verify.cli.answer import Answer, WrongCall, files_written
from taylor_verify.cli.progress import advancing, counting
from taylor_verify.cli.streams import say

if TYPE_CHECKING:
    from taylor_verify.records.record import Record
    from taylor_verify.records.runs import Run
    from taylor_verify.studies.bulk import Missing

_TIME: Final = "one to three minutes for all of them on two cores"
_NAME: Final = "taylor-verify-data"


def make_missing(folder: Path) -> Answer:
    """Make the records, portraits, exact trajectories and tables of gates that ``folder`` lacks."""
    from taylor_verify.records import store
    from taylor_verify.studies import report
    from taylor_verify.studies.portraits import stored as portraits
    from taylor_verify.studies.reference import page as reference_files

    lacking = _missing(folder)
    if lacking.data:
        say(f"making what is not in {folder}: {lacking.data} ({_TIME})")
    written = list(report.publish_gates(folder))
    if lacking.runs:
        written += store.add_records(folder, _records(lacking.runs))
    if lacking.portraits:
        from taylor_verify.studies.portraits.measure import portraits as made

        written += portraits.add(folder, made(lacking.portraits, counting(len(lacking.portraits))))
    if lacking.references:
        from taylor_verify.studies.reference.measure import references

        documents = references(lacking.references, counting(len(lacking.references)))
        written += reference_files.add_json(folder, documents)
    return files_written(written)


def pack(folder: Path, target: Path) -> Answer:
    """Pack everything in ``folder``; refuse a folder that lacks something."""
    from taylor_verify.records.version import __version__
    from taylor_verify.studies.archive import pack

    lacking = _missing(folder)
    if lacking.data or lacking.renderings:
        renderings = f"{len(lacking.renderings)} renderings" if lacking.renderings else ""
        raise WrongCall(
            "expected a whole report (`publish --missing`, then `publish --paper`), got one without "
            f"{', '.join(filter(None, (lacking.data, renderings)))} @ --archive"
        )
    return files_written(pack(folder, target, f"{_NAME}-{__version__}"))


def missing_from_pages(folder: Path) -> list[str]:
    """A message about the data that the pages of the site are without; none for a whole folder."""
    lacking = _missing(folder)
    if not lacking.data:
        return []
    return [
        f"pages of the site are without {lacking.data}: `taylor-verify publish --missing` makes "
        f"what {folder} lacks ({_TIME})"
    ]


def _missing(folder: Path) -> Missing:
    from taylor_verify.scenes.library import names
    from taylor_verify.scenes.reading.reader import load
    from taylor_verify.studies import bulk

    try:
        return bulk.missing(folder, {name: load(name).digest for name in names()})
    except FileNotFoundError as error:
        raise WrongCall(
            f"expected what `run --out {folder}` writes, got no such file @ {error.filename}"
        ) from error
    except ValueError as error:
        raise WrongCall(str(error)) from error


def _records(runs: Iterable[Run]) -> list[Record]:
    """Run what was published once more, for its records alone."""
    from taylor_verify.batch.job import Job
    from taylor_verify.batch.judging import judge_all

    rungs: dict[tuple[str, str], list[str]] = {}
    for run in runs:
        rungs.setdefault((run.scene, run.solver), []).append(run.rung)
    jobs = [Job(scene, solver, tuple(own)) for (scene, solver), own in rungs.items()]
    with advancing() as progress:
        results = judge_all(jobs, progress)
    return [result.record for result in results if result.record is not None]
