"""The study of accuracy: the standard set on every rung, in tables of what was judged."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Final

from taylor_verify.records import store
from taylor_verify.records.replacement import replace_files
from taylor_verify.records.runs import Run
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.studies.accuracy import page, sheet
from taylor_verify.studies.accuracy.attainable import attainable
from taylor_verify.studies.study import Bulk, Measured, Progress, Published, Study

_SOLVER: Final = "taylor"
# A run that was never judged has no record.
_UNJUDGED: Final = (Status.REFUSED, Status.UNAVAILABLE)

Verdicts = Sequence[Verdict]


def _measure(folder: Path, progress: Progress) -> Measured:
    """Run the standard set on every rung, as `run --out` does."""
    from taylor_verify.batch.judgements import Judgements
    from taylor_verify.batch.judging import judge_all
    from taylor_verify.batch.selection import select

    selection = select()
    with progress.jobs() as told:
        judgements = tuple(judge_all(selection.jobs(_SOLVER), told))
    results = Judgements(judgements, selection, _SOLVER)
    written = store.write(folder, results.verdicts, results.records)
    return Measured(written, status=results.exit_status)


def _find(folder: Path) -> Verdicts | None:
    return store.load(folder) if (folder / store.FOLDER / store.VERDICTS).exists() else None


# What the repository leaves out: every sample of every run, and every verdict with its reason.


_GATES: Final = {"tables/gates.md": page.gates, "tables/gates.csv": sheet.gates}


def _gates_lacking(report: Published) -> list[tuple[str, str]]:
    """Return path and text of each table of gates that is not the one of the verdicts."""

    def current(name: str) -> str | None:
        file = report.folder / name
        return file.read_text(encoding="utf-8") if file.exists() else None

    texts = {name: made(report.verdicts) for name, made in _GATES.items()}
    return [(name, text) for name, text in texts.items() if current(name) != text]


def _write_gates(
    folder: Path, lacking: Sequence[tuple[str, str]], progress: Progress
) -> tuple[Path, ...]:
    del progress
    return replace_files(folder, dict(lacking))


def _runs_lacking(report: Published) -> tuple[Run, ...]:
    """Return the runs without a record, all of them where the records are those of other verdicts."""
    data = report.folder / store.FOLDER
    has_records = store.has_own_records(report.folder)
    return tuple(
        run
        for run in report.runs
        if _has_a_record(run)
        and not (
            has_records and (data / store.record_name(run.scene, run.solver, run.rung)).exists()
        )
    )


def _has_a_record(run: Run) -> bool:
    is_judged = any(verdict.verdict not in _UNJUDGED for verdict in run.verdicts)
    return run.solver == _SOLVER and not run.setting and is_judged


def _add_records(folder: Path, lacking: Sequence[Run], progress: Progress) -> tuple[Path, ...]:
    """Run what was published once more, for its records alone."""
    from taylor_verify.batch.job import Job
    from taylor_verify.batch.judging import judge_all

    rungs: dict[tuple[str, str], list[str]] = {}
    for run in lacking:
        rungs.setdefault((run.scene, run.solver), []).append(run.rung)
    jobs = [Job(scene, solver, tuple(own)) for (scene, solver), own in rungs.items()]
    with progress.jobs() as told:
        results = judge_all(jobs, told)
    return store.add_records(folder, [one.record for one in results if one.record is not None])


STUDY: Final = Study(
    name="accuracy",
    title="the errors of the standard set on every rung, beside what is attainable",
    duration="two minutes, all cores",
    measure=_measure,
    find=_find,
    page=lambda verdicts, folder: page.accuracy(verdicts),
    sheet=sheet.accuracy,
    beside={
        "tables/attainable.md": attainable,
        "tables/attainable.csv": sheet.attainable,
        "tables/conserved.md": page.conserved,
        "tables/conserved.csv": sheet.conserved,
        **_GATES,
    },
    bulk=(
        Bulk("tables of gates", tuple(_GATES), _gates_lacking, _write_gates),
        Bulk("records of runs", ("data/records/",), _runs_lacking, _add_records),
    ),
)
